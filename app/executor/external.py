"""External worker: joins a scheduler, and comes back whenever the scheduler does."""

import asyncio
import logging
import tempfile

import dask
from distributed import Nanny

from app.executor.backoff import Backoff
from app.executor.engine import EMBEDDED
from app.settings import Settings

log = logging.getLogger(__name__)

FIRST_PAUSE_SECONDS, LONGEST_PAUSE_SECONDS = 1.0, 10.0


async def work_for(settings: Settings, stopping: asyncio.Event) -> None:
    """Run a worker process for whatever service uses the scheduler of the settings, until told to stop.

    Dask's own command ends when its scheduler does. This one joins the next scheduler at the same address.

    Parameters
    ----------
    settings : Settings
        ``scheduler`` and ``worker_memory``; all else a worker is told by the service.
    stopping : asyncio.Event
        Ends it within seconds.
    """
    dask.config.set(EMBEDDED)
    pauses = Backoff(FIRST_PAUSE_SECONDS, LONGEST_PAUSE_SECONDS)
    stop = asyncio.ensure_future(stopping.wait())
    with tempfile.TemporaryDirectory(prefix="microtexture-worker-") as directory:
        while not stopping.is_set():
            joining = asyncio.ensure_future(_join(settings, directory, pauses))
            await asyncio.wait({joining, stop}, return_when=asyncio.FIRST_COMPLETED)
            joining.cancel()
            await asyncio.wait({joining})
            if stopping.is_set():
                return
            pause = pauses.fail()
            error = None if joining.cancelled() else joining.exception()
            log.warning("the scheduler %s is away%s; next attempt in %g seconds", settings.scheduler, _of(error), pause)
            await asyncio.wait({stop}, timeout=pause)


async def _join(settings: Settings, directory: str, pauses: Backoff) -> None:
    nanny = Nanny(
        settings.scheduler, nthreads=1, memory_limit=settings.worker_memory, local_directory=directory, dashboard=False
    )
    async with nanny:
        log.warning("joined the scheduler %s as %s", settings.scheduler, nanny.worker_address)
        pauses.succeed()
        await nanny.finished()


def _of(error: BaseException | None) -> str:
    return "" if error is None else f" ({type(error).__name__})"

"""Engine: one connection to a Dask cluster, an embedded one of our own processes or a scheduler's address."""

import asyncio
import logging
import multiprocessing
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any
from uuid import uuid4

import dask
from distributed import Client, Future, LocalCluster, Security
from distributed.core import Status
from distributed.utils import get_mp_context

from app.executor import tasks
from app.executor.memory import MALLOC
from app.experiments.model import Lease
from app.experiments.ports import Run
from app.settings import Settings

log = logging.getLogger(__name__)

CONNECT_SECONDS = 3.0  # a stop waits for it
CLOSE_SECONDS = 5.0
LOOPBACK = "127.0.0.1"

EMBEDDED = {
    "distributed.scheduler.allowed-failures": 0,  # a killed task comes back to us, who know where nothing else runs
    "distributed.scheduler.work-stealing": False,  # a worker is never given a second task
    "distributed.nanny.pre-spawn-environ": {  # for Dask's own dict, which it replaces
        **MALLOC,
        **dict.fromkeys(("MKL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), 1),
    },
    "distributed.worker.multiprocessing-method": "forkserver",
    "distributed.worker.profile.enabled": False,
    "distributed.scheduler.http.routes": [],
    "distributed.worker.http.routes": [],
    "distributed.worker.memory.target": False,  # results are None: there is nothing to spill
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.pause": False,  # memory that the allocator keeps must not idle a worker
    "distributed.worker.memory.terminate": 0.95,
}


class Engine:
    """A cluster and its client, once open. An engine that was lost is not mended: another one is opened.

    Parameters
    ----------
    settings : Settings
    run : callable
        What the workers do with a job.
    on_workers : callable
        Called from the client's event loop when workers come or go.
    """

    def __init__(self, settings: Settings, run: Run, *, on_workers: Callable[[], None]) -> None:
        self._run = run
        self._settings = settings.model_copy(update={"operator_token": None})  # of no use to a worker
        #: Under which it holds leases.
        self.name = f"engine-{uuid4().hex}"
        self._cluster: Any = None if settings.scheduler else _local_cluster(settings, run)
        try:
            address = settings.scheduler or self._cluster
            self._client: Any = Client(address, set_as_default=False, timeout=CONNECT_SECONDS, name="microtexture")
        except BaseException:
            self._close_cluster()
            raise
        self._client.subscribe_topic("all", lambda event: on_workers() if _is_of_workers(event[1]) else None)

    @property
    def alive(self) -> bool:
        """Whether the scheduler is there."""
        cluster_alive = self._cluster is None or (
            self._cluster.status == Status.running and self._cluster.scheduler.status == Status.running
        )
        return bool(cluster_alive and self._client.status == "running")

    def workers(self) -> dict[str, int]:
        """Threads of every worker, by its address."""
        found = self._client.scheduler_info()["workers"]
        return {address: worker["nthreads"] for address, worker in found.items()}

    def ask(self, address: str, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function on a worker, which may be busy, and raise what it raises; `TimeoutError` after a while."""
        call = self._client._run(function, *arguments, workers=[address])
        answers = asyncio.run_coroutine_threadsafe(
            asyncio.wait_for(call, CONNECT_SECONDS), self._client.loop.asyncio_loop
        ).result()
        return answers[address]

    def busy(self) -> dict[str, int]:
        """Tasks of every worker, whoever gave them, by its address."""
        return {address: len(keys) for address, keys in self._client.processing().items()}

    def submit(self, lease: Lease, address: str) -> "Future[None]":
        """Start a job on this worker, and on no other: whose worker is gone is ours to know."""
        future: Future[None] = self._client.submit(
            tasks.work,
            self._run,
            self._settings,
            lease,
            key=("experiment", lease.job, lease.fence),
            pure=False,
            workers=[address],
            allow_other_workers=False,
        )
        return future

    def forget(self, future: "Future[None]") -> None:
        """Let the scheduler drop a task, whatever became of it."""
        self._client.cancel([future], force=True)

    def kill(self, address: str) -> None:
        """Kill a worker process; its nanny starts another one. Returns at once."""
        self._later(self._kill(address))

    def close(self) -> None:
        """Stop the embedded processes and the connection within seconds."""
        with suppress(Exception):  # it may be broken: that is why it is closed
            self._client.unsubscribe_topic("all")
        with suppress(Exception):
            self._client.close(timeout=CLOSE_SECONDS)
        self._close_cluster()

    def _close_cluster(self) -> None:
        if self._cluster is None:
            return
        for nanny in list(self._cluster.workers.values()):
            nanny.close_gracefully()  # it must not start another worker
            with suppress(Exception):
                nanny.process.process.kill()
        try:
            self._cluster.close(timeout=CLOSE_SECONDS)
        except Exception:
            log.warning("the engine did not close in order", exc_info=True)

    async def _kill(self, address: str) -> None:
        try:
            await self._client._run(tasks.kill_worker, workers=[address], nanny=True)
        except Exception:
            log.warning("the nanny of %s did not answer; its worker is asked to leave", address)
            await self._client._run(tasks.leave, workers=[address], on_error="ignore")

    def _later(self, coroutine: Any) -> None:
        asyncio.run_coroutine_threadsafe(coroutine, self._client.loop.asyncio_loop)


def _is_of_workers(event: Mapping[str, Any]) -> bool:
    return event.get("action") in {"add-worker", "remove-worker"}


def _local_cluster(settings: Settings, run: Run) -> LocalCluster:
    dask.config.set(EMBEDDED)  # for good: it is looked at again whenever a worker is replaced
    get_mp_context()  # sets the fork server's list of modules, which ours then replaces
    preload = ["distributed", "distributed.nanny", "scipy.fft", run.__module__]
    multiprocessing.get_context("forkserver").set_forkserver_preload(preload)
    return LocalCluster(
        n_workers=settings.workers,
        threads_per_worker=1,
        processes=True,
        memory_limit=settings.worker_memory,
        host=LOOPBACK,
        protocol="tls://",  # with a certificate of its own: others on this machine cannot run code in the workers
        security=Security.temporary(),
        dashboard_address=None,
        scheduler_kwargs={"dashboard": False, "dashboard_address": f"{LOOPBACK}:0"},
        silence_logs=logging.ERROR,
        local_directory=str(settings.data_dir / "engine"),
    )

"""Dispatched jobs: what was given to Dask, and the verdict on its end."""

import logging
from dataclasses import dataclass

from distributed import Future
from distributed.scheduler import KilledWorker

from app.executor.messages import LOST, out_of_time
from app.experiments.failures import BROKEN

log = logging.getLogger(__name__)

ATTEMPTS = 2  # runs of a job whose worker is killed


@dataclass(eq=False)
class Dispatched:
    """A job on a worker."""

    job: str
    address: str
    sent: float
    future: "Future[None] | None" = None
    started: float | None = None
    stage: str | None = None
    fraction: float = 0.0
    failure: str | None = None
    cancelled: float | None = None
    stop_sent: bool = False
    out_of_time: bool = False
    forced: bool = False


def verdict(
    run: Dispatched, status: str | None, error: BaseException | None, *, deaths: int, time_limit: float
) -> tuple[bool, str | None]:
    """Whether a job whose task ended runs again, and otherwise what failed, if anything.

    Parameters
    ----------
    run : Dispatched
    status : str
        Of the task's future: finished, error, cancelled or lost.
    error : BaseException, optional
        What the task raised, or that its worker was killed.
    deaths : int
        Workers that were killed while they ran this job.
    time_limit : float
        Seconds a run may take.
    """
    if run.out_of_time:
        return False, out_of_time(time_limit)
    if run.cancelled is not None:
        return False, None
    if status == "finished":
        return False, run.failure
    if isinstance(error, KilledWorker):
        return deaths < ATTEMPTS, LOST
    if error is not None:
        log.error("job %s failed outside the method", run.job, exc_info=error)
        return False, BROKEN
    return True, None  # the scheduler forgot it

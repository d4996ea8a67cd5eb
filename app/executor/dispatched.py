"""Dispatched jobs: what was given to Dask, and the verdict on its end."""

import logging
from dataclasses import dataclass
from enum import Enum, auto

from distributed import Future
from distributed.scheduler import KilledWorker

from app.errors import UnavailableError
from app.experiments.model import Lease

log = logging.getLogger(__name__)

DIED = "Its worker process died."


@dataclass(eq=False)
class Dispatched:
    """A job on a worker; moments are of the monotonic clock."""

    lease: Lease
    address: str
    sent: float
    future: "Future[None] | None" = None
    #: When its heartbeat was first seen to move.
    begun: float | None = None
    #: When its lease was first seen to be gone: it was recorded, cancelled or taken away.
    gone: float | None = None
    #: Whether its worker left the engine.
    orphaned: bool = False
    #: Whether it never began in time, and is to run elsewhere.
    withdrawn: bool = False
    out_of_time: bool = False
    forced: bool = False


class Verdict(Enum):
    """What is to be done about a job that has left Dask."""

    RECORDED = auto()  # its worker says that it has recorded the end, or it lost its lease: look at the row
    OUT_OF_TIME = auto()  # fail it
    DIED = auto()  # charge an attempt, or fail it after the last one
    UNAVAILABLE = auto()  # release it; wait until what is away is there again
    RETURNED = auto()  # release it, for nothing that it did
    LEFT_RUNNING = auto()  # another scheduler's worker may go on with it: its lease tells


def verdict(run: Dispatched, status: str | None, error: BaseException | None, *, embedded: bool) -> Verdict:
    """Say what is to be done about a job whose task has ended.

    Parameters
    ----------
    run : Dispatched
    status : str
        Of the task's future: finished, error, cancelled or lost.
    error : BaseException, optional
        What the task raised, or that its worker was killed.
    embedded : bool
        Whether the workers are processes of ours, which end with their engine.
    """
    if run.out_of_time:
        return Verdict.OUT_OF_TIME
    if run.withdrawn:
        return Verdict.RETURNED
    if run.orphaned or isinstance(error, KilledWorker):
        return Verdict.RETURNED if run.begun is None and not isinstance(error, KilledWorker) else Verdict.DIED
    if run.gone is not None or status == "finished":
        return Verdict.RECORDED
    if isinstance(error, UnavailableError):
        log.warning("job %s cannot run now: %s", run.lease.job, error)
        return Verdict.UNAVAILABLE
    if error is not None:
        log.error("job %s failed outside the method", run.lease.job, exc_info=error)
        return Verdict.RECORDED
    return Verdict.RETURNED if embedded else Verdict.LEFT_RUNNING  # the scheduler forgot it

"""Ends of jobs: puts into the database what a verdict asks for."""

import logging
import time
from collections import Counter

from app.errors import UnavailableError
from app.executor.dispatched import DIED, Dispatched, Verdict
from app.executor.messages import LOST, UNRECORDED, UNUSABLE
from app.experiments.failures import out_of_time
from app.experiments.ports import JobQueue, Records

log = logging.getLogger(__name__)

UNRECORDED_RUNS = 2  # runs of a job that leave without a record before it is given up
UNUSABLE_SECONDS = 600.0  # how long runs of a job may find things away that answer in between


class Endings:
    """Records the ends of jobs that their workers did not record.

    Parameters
    ----------
    queue : JobQueue
    records : Records
    time_limit : float
        Seconds a run may take.
    """

    def __init__(self, queue: JobQueue, records: Records, time_limit: float) -> None:
        self._queue = queue
        self._records = records
        self._time_limit = time_limit
        self._unrecorded: Counter[str] = Counter()
        self._unusable: dict[str, float] = {}

    def conclude(self, run: Dispatched, verdict: Verdict) -> None:
        """Do what the verdict asks for; where the lease is not held any more, nothing happens.

        Parameters
        ----------
        run : Dispatched
        verdict : Verdict

        Raises
        ------
        UnavailableError
            If the database is away; nothing was done then.
        """
        job = run.lease.job
        match verdict:
            case Verdict.OUT_OF_TIME:
                self._records.fail(run.lease, out_of_time(self._time_limit))
            case Verdict.DIED if run.lease.last:
                log.error("job %s: its worker died again, alone this time; it is given up", job)
                self._records.fail(run.lease, LOST, DIED)
            case Verdict.DIED:
                log.warning("job %s: its worker died; it will run again", job)
                self._queue.release(run.lease, DIED)
            case Verdict.UNAVAILABLE:
                first = self._unusable.setdefault(job, time.monotonic())
                if time.monotonic() - first < UNUSABLE_SECONDS:
                    self._queue.release(run.lease)
                    return
                self._records.fail(run.lease, UNUSABLE)
            case Verdict.RETURNED:
                self._queue.release(run.lease)
            case Verdict.RECORDED if self._queue.holds(run.lease):
                self._unrecorded[job] += 1
                log.error("job %s left its worker without a record", job)
                if self._unrecorded[job] < UNRECORDED_RUNS:
                    self._queue.release(run.lease)
                    return
                self._records.fail(run.lease, UNRECORDED)
        del self._unrecorded[job]
        self._unusable.pop(job, None)

    def release(self, run: Dispatched) -> None:
        """Put back what is stopped from here, if that can be said now; otherwise its lease lapses."""
        try:
            self._queue.release(run.lease)
        except UnavailableError as error:
            log.warning("the lease of job %s could not be released, and will lapse: %s", run.lease.job, error)

"""Jobs of a worker process: runs one to its record in the store, and keeps three kinds of failure apart.

The method's own ends the experiment. What is away for now, the database or the files, is raised: the job waits. Whoever
was stopped from outside records nothing: its lease is gone, or lapses.
"""

from collections.abc import Callable

from app.errors import CancelledError, UnavailableError
from app.experiments.computation import add_deep, compute
from app.experiments.failures import explain_failure, unavailability
from app.experiments.heartbeat import Heartbeat, patiently
from app.experiments.model import DEEP, Lease
from app.experiments.ports import BlobStore, ExperimentStore, JobQueue


def run_job(
    store: ExperimentStore, queue: JobQueue, blobs: BlobStore, lease: Lease, *, threads: int, time_limit: float
) -> None:
    """Run one job to its record in the store.

    Parameters
    ----------
    store, queue, blobs
        Those of this process.
    lease : Lease
        Of the job; nothing is recorded once it is not held any more.
    threads : int
        Threads that the method computes with.
    time_limit : float
        Seconds that the run may take.

    Raises
    ------
    UnavailableError
        If the database or the files cannot be reached for now: whatever goes wrong with the job itself is recorded.
    """
    run = _run_deep if DEEP in lease.job else _run_experiment
    with Heartbeat(queue, lease, time_limit) as progress:
        if not progress.held:
            return
        try:
            run(store, queue, blobs, lease, progress, threads)
        except CancelledError:
            return
        except OSError as error:
            raise unavailability(error) from error


def _run_experiment(
    store: ExperimentStore, queue: JobQueue, blobs: BlobStore, lease: Lease, progress: Heartbeat, threads: int
) -> None:
    experiment = store.start(lease)
    if experiment is not None:
        _record_failure(
            lease,
            lambda: compute(store, blobs, lease, experiment, progress, threads),
            lambda words: store.fail(lease, words),
        )


def _run_deep(
    store: ExperimentStore, queue: JobQueue, blobs: BlobStore, lease: Lease, progress: Heartbeat, threads: int
) -> None:
    def compute_output() -> None:
        add_deep(store, blobs, lease, progress, threads)
        patiently(lambda: queue.finish(lease))

    _record_failure(lease, compute_output, lambda words: queue.finish(lease, words))


def _record_failure(lease: Lease, run: Callable[[], None], fail: Callable[[str], bool]) -> None:
    """Run; record what fails in it by itself, and nothing else."""
    try:
        run()
    except (CancelledError, UnavailableError, OSError):
        raise
    except Exception as error:
        words = explain_failure(lease.job, error)
        patiently(lambda: fail(words))

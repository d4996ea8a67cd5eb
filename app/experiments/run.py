"""Jobs of a worker process: runs one to its record in the store, whatever goes wrong in it."""

from app.errors import AppError, CancelledError
from app.experiments.computation import add_deep, compute
from app.experiments.failures import explain_failure
from app.experiments.model import DEEP
from app.experiments.ports import BlobStore, ExperimentStore
from app.methods.context import Progress

MAX_ATTEMPTS = 6  # more often than any row of restarts would start one: it is the experiment that ends the service


def run_job(store: ExperimentStore, blobs: BlobStore, job: str, progress: Progress, *, threads: int) -> None:
    """Run one job to its record in the store. Running it twice, even at the same time, is harmless.

    Parameters
    ----------
    store, blobs
        Those of this process.
    job : str
        An experiment's id, or what `deep_job` makes of it.
    progress : Progress
        Reports; raises when the job is cancelled or out of time.
    threads : int
        Threads that the method computes with.

    Raises
    ------
    AppError
        From a `deep_job` only: whatever goes wrong with an experiment itself is recorded as its failure.
    """
    experiment_id, deep, output = job.partition(DEEP)
    if deep:
        try:
            add_deep(store, blobs, experiment_id, output, progress, threads)
        except CancelledError:
            raise
        except Exception as error:
            raise AppError(explain_failure(job, error)) from error
        return
    experiment = store.start(experiment_id)
    if experiment is None:
        return
    try:
        if len(experiment.attempts) > MAX_ATTEMPTS:
            raise AppError("Try a smaller width and height: running this experiment ended its worker again and again.")
        compute(store, blobs, experiment, progress, threads)
    except CancelledError:
        return  # recorded before the worker was told
    except Exception as error:
        store.fail(experiment_id, explain_failure(job, error))

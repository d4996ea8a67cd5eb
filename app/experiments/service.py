"""Service: the use cases, in parts. Pages, API and command line talk to these parts and to nothing below them."""

import threading
from datetime import timedelta
from functools import partial

from app.errors import DeletedError, NotFoundError
from app.experiments.availability import Availability
from app.experiments.exhibition import Exhibition
from app.experiments.experiments import Experiments
from app.experiments.files.cache import FileCache
from app.experiments.files.outputs import Outputs
from app.experiments.files.renditions import Renditions
from app.experiments.housekeeping import Housekeeping
from app.experiments.meter import Meter
from app.experiments.model import DEEP, Lease, Status
from app.experiments.ports import BlobStore, Executor, ExperimentStore, JobQueue
from app.experiments.retention import Retention
from app.experiments.samples import Samples
from app.experiments.shares import Shares
from app.experiments.submission import Submission
from app.experiments.transient import Transient
from app.experiments.watching import Watching
from app.settings import Settings

CACHE_BYTES = 1 << 30


class Service:
    """Everything that can be done with samples and experiments, each part of it an attribute.

    Blocking calls are safe from any thread; the coroutines never block the event loop.

    Parameters
    ----------
    store, queue, blobs, executor
        The backends; closed with the service.
    settings : Settings
    """

    def __init__(
        self, store: ExperimentStore, queue: JobQueue, blobs: BlobStore, executor: Executor, settings: Settings
    ) -> None:
        self._store = store
        self._queue = queue
        self._executor = executor
        self._settings = settings
        cache = FileCache(settings.data_dir / "cache", CACHE_BYTES)
        keep, longest = timedelta(hours=settings.sample_keep_hours), timedelta(hours=1, seconds=settings.time_limit)
        #: Takes in uploads and bundled samples, and finds them.
        self.samples = Samples(store, blobs, settings)
        #: Samples as pictures and videos that browsers show.
        self.renditions = Renditions(blobs, cache)
        #: The structure index of crops.
        self.meter = Meter(blobs)
        #: Which part is away.
        self.availability = Availability(store, blobs, executor)
        #: Accepts or rejects experiments.
        self.submission = Submission(store, queue, executor, self.availability, self.samples, settings)
        #: Progress of experiments.
        self.watching = Watching(store, queue.states)
        #: Files of experiments, in every format and depth.
        self.outputs = Outputs(
            store,
            queue,
            blobs,
            executor,
            self.renditions,
            self.watching,
            queue_limit=settings.queue_limit,
            shares=Shares(queue, settings),
        )
        #: When experiments go by themselves.
        self.retention = Retention.by(settings)
        #: Deletes what is no longer used.
        self.housekeeping = Housekeeping(
            store, blobs, cache, sample_keep=keep, longest_run=longest, retention=self.retention
        )
        #: Experiments by their ids.
        self.experiments = Experiments(store, executor, self.housekeeping, self.watching, settings.operator_token)
        #: Outputs straight from files.
        self.transient = Transient(
            self.samples, self.submission, self.experiments, self.outputs, self.watching, self.housekeeping
        )
        #: The figures of the pages.
        self.exhibition = Exhibition(store, queue, executor, self.samples, settings)
        self._closing = threading.Event()
        self._background: list[threading.Thread] = []

    def start(self) -> None:
        """Return once experiments can run; bundled samples come in by and by."""
        self._executor.subscribe(self.watching.notify)
        self.samples.open()
        self._executor.start(self)
        if self._closing.is_set():
            return
        for work in (self.exhibition.keep, self.housekeeping.keep):
            thread = threading.Thread(target=partial(work, self._closing), daemon=True)
            thread.start()
            self._background.append(thread)

    def close(self) -> None:
        """Stop within seconds; what is unfinished waits in the database for whoever takes it."""
        self._closing.set()
        self._executor.close()
        for thread in self._background:
            thread.join(timeout=self._settings.decode_seconds)
        self.samples.close()
        self._store.close()

    @property
    def ready(self) -> bool:
        """Whether experiments can run now."""
        return self.availability.missing() is None

    @property
    def waiting(self) -> int:
        """How many jobs wait."""
        return self._queue.waiting()

    # what the executor asks of the records

    def fail(self, lease: Lease, error: str, cause: str | None = None) -> None:
        """Record the failure of a job that no worker can record."""
        if DEEP in lease.job:
            self._queue.finish(lease, error)
        else:
            self._store.fail(lease, error, cause)

    def stopped(self, job: str) -> bool:
        """Whether nobody wants this job any more."""
        if DEEP in job:
            return not self._queue.states([job])
        try:
            return self._store.get(job).status is Status.CANCELLED
        except (NotFoundError, DeletedError):
            return True

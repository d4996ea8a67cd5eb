"""The use cases. Pages, API and command line talk to this and to nothing below it."""

import threading
from collections.abc import AsyncGenerator, Mapping, Sequence
from datetime import timedelta
from functools import partial
from pathlib import Path
from typing import Any, Literal

from app.errors import ForbiddenError
from app.experiments.exhibition import Catalogue
from app.experiments.files.cache import FileCache
from app.experiments.files.outputs import AnyFormat, Outputs
from app.experiments.files.renditions import FilmFormat, Pictures
from app.experiments.housekeeping import Housekeeping, Pruned
from app.experiments.meter import Index, Meter
from app.experiments.model import DEEP, Experiment, Output, Page, Sample, Snapshot, deep_job
from app.experiments.ports import BlobStore, Executor, ExperimentStore
from app.experiments.preparation import NewExperiment
from app.experiments.samples import SampleIntake
from app.experiments.submission import Acceptance, Plan
from app.experiments.tokens import same, token_digest
from app.experiments.transient import Direct
from app.experiments.watching import Following
from app.images.crop import Frames, Rectangle
from app.settings import Settings
from app.synthesis.structure import SIGMA

CACHE_BYTES = 1 << 30


class Service:
    """Everything that can be done with samples and experiments.

    Blocking calls are safe from any thread; the coroutines never block the event loop.

    Parameters
    ----------
    store, blobs, executor
        The backends; closed with the service.
    settings : Settings
    """

    def __init__(self, store: ExperimentStore, blobs: BlobStore, executor: Executor, settings: Settings) -> None:
        self._store = store
        self._blobs = blobs
        self._executor = executor
        self._settings = settings
        cache = FileCache(settings.data_dir / "cache", CACHE_BYTES)
        self._pictures = Pictures(blobs, cache)
        self._meter = Meter(blobs)
        self._following = Following(store, executor)
        self._outputs = Outputs(
            store, blobs, executor, self._pictures, self._following, queue_limit=settings.queue_limit
        )
        self._intake = SampleIntake(store, blobs, settings)
        self._acceptance = Acceptance(store, executor, self._intake, settings)
        self.catalogue = Catalogue(store, executor, self._intake, settings)
        keep, longest = timedelta(hours=settings.sample_keep_hours), timedelta(hours=1, seconds=settings.time_limit)
        self._housekeeping = Housekeeping(store, blobs, cache, sample_keep=keep, longest_run=longest)
        submit = self._acceptance.submit_transient
        self._direct = Direct(self._intake, self._housekeeping, self._outputs, self._following, submit, self._forget)
        self._closing = threading.Event()
        self._background: list[threading.Thread] = []

    # life

    def start(self) -> None:
        """Return once experiments can run; what was unfinished is queued, bundled photographs come in by and by."""
        self._executor.subscribe(self._following.notify)
        for experiment_id in self._store.unfinished():
            self._executor.submit(experiment_id)
        self._intake.open()
        self._executor.start(self._ended)
        for work in (partial(self.catalogue.keep, self._closing), partial(self._housekeeping.keep, self._closing)):
            thread = threading.Thread(target=work, daemon=True)
            thread.start()
            self._background.append(thread)

    def close(self) -> None:
        """Stop within seconds; what is unfinished is finished after the next start."""
        self._closing.set()
        self._executor.close()
        for thread in self._background:
            thread.join(timeout=self._settings.decode_seconds)
        self._intake.close()
        self._store.close()

    @property
    def ready(self) -> bool:
        """Whether experiments can run now."""
        return self._executor.ready

    @property
    def waiting(self) -> int:
        """How many jobs wait."""
        return self._executor.waiting

    def counts(self) -> Mapping[str, int]:
        """Experiments by status."""
        return self._store.counts()

    # samples

    def add_sample(self, upload: Path, owner: str | None) -> Sample:
        """Keep an uploaded file; ``upload`` is gone afterwards, whatever comes of it. ``owner`` is a token.

        Raises
        ------
        UnsupportedFormatError, BrokenFileError, TooLargeError, BusyError
        """
        try:
            return self._intake.add(upload, None if owner is None else token_digest(owner))
        finally:
            upload.unlink(missing_ok=True)

    def sample(self, sample_id: str) -> Sample:
        """Raises `NotFoundError`."""
        return self._store.sample(sample_id)

    def bundled_samples(self) -> list[Sample]:
        """Those that have come in so far, in the order of the catalogue."""
        return self._store.bundled_samples()

    def rendition(self, sample_id: str, size: int | None, frame: int = 0) -> tuple[Path, str]:
        """A file that browsers show, and its media type; ``size`` bounds the longer side, None is the full size."""
        return self._pictures.rendition(self._store.sample(sample_id), size, frame)

    def film(self, sample_id: str, file_format: FilmFormat = "mp4") -> tuple[Path, str]:
        """A video sample as a file that plays, and its media type. Raises `NotFoundError`, also for a still picture."""
        return self._pictures.film(self._store.sample(sample_id), file_format)

    def structure(self, sample_id: str, crop: Rectangle | None = None, sigma: float = SIGMA, frame: int = 0) -> Index:
        """How structured a crop is, see `Meter.structure`. Raises `NotFoundError` or `InvalidInputError`."""
        return self._meter.structure(self._store.sample(sample_id), crop, sigma, frame)

    # experiments

    def submit(self, request: NewExperiment, owner_token: str, press: str | None = None) -> Experiment:
        """Accept an experiment: it is on disk and queued when this returns.

        Parameters
        ----------
        request : NewExperiment
        owner_token : str
        press : str, optional
            A secret of one press of a button: what the same owner asks for with the same press is the same experiment.

        Raises
        ------
        InvalidInputError
            With the dotted field at fault.
        NotFoundError
            If its method or sample is not there.
        TooLargeError
            If the texture would be too large.
        BusyError
            If too many experiments wait already.
        """
        return self._acceptance.submit(request, owner_token, press=press)

    def check(self, request: NewExperiment) -> Plan:
        """What this experiment would make and take; nothing is kept. Raises as `submit` does, but for `BusyError`."""
        return self._acceptance.check(request)

    def get(self, experiment_id: str) -> Experiment:
        """Raises `NotFoundError` or `DeletedError`."""
        return self._store.get(experiment_id)

    def page(self, *, limit: int = 24, cursor: str | None = None, method: str | None = None) -> Page:
        """Listed experiments that succeeded, newest first."""
        return self._store.page(limit=limit, cursor=cursor, method=method)

    def owns(self, experiment: Experiment, token: str | None) -> bool:
        """Whether this is the token of the owner or of the operator."""
        if not token:
            return False
        operator = self._settings.operator_token
        is_operator = operator is not None and same(token, operator.get_secret_value())
        return is_operator or same(token_digest(token), experiment.owner)

    def cancel_or_delete(self, experiment_id: str, token: str | None) -> None:
        """Stop an unfinished experiment; remove a finished one with all that only it refers to.

        Raises
        ------
        ForbiddenError
            If the token is neither the owner's nor the operator's.
        """
        experiment = self._owned(experiment_id, token)
        if experiment.status.finished:
            self._delete(experiment)
        elif self._store.cancel(experiment_id):
            self._executor.cancel(experiment_id)
            self._following.notify(experiment_id)

    def set_listed(self, experiment_id: str, listed: bool, token: str | None) -> None:
        """Show an experiment in the archive, or only to who has its link. Raises `ForbiddenError`."""
        self._owned(experiment_id, token)
        self._store.set_listed(experiment_id, listed)

    def snapshot(self, experiment_id: str) -> Snapshot:
        """Status, place in the queue and progress of this moment."""
        return self._following.snapshot(experiment_id)

    async def wait(self, experiment_id: str, seconds: float) -> Experiment:
        """The experiment once it has finished, or as it is after this many seconds."""
        return await self._following.wait(experiment_id, seconds)

    def watch(self, experiment_id: str) -> AsyncGenerator[Snapshot, None]:
        """Every change, several at once if they come fast; ends after the finished state."""
        return self._following.watch(experiment_id)

    # outputs

    def output(self, experiment_id: str, name: str) -> tuple[Output, Path]:
        """An output's record and its file. Raises `NotFoundError`, also while it is not there yet."""
        return self._outputs.output(experiment_id, name)

    async def converted(
        self, experiment_id: str, name: str, file_format: AnyFormat | None, depth: Literal[8, 16] | None = None
    ) -> tuple[Path, str]:
        """An output in another format, and its media type. At 16 bits it is computed when first asked for.

        Raises
        ------
        InvalidInputError
            If the format or the output does not come at this depth.
        BusyError
            If the engine did not get to it soon enough; trying again later helps.
        """
        return await self._outputs.converted(experiment_id, name, file_format, depth)

    async def synthesize(
        self,
        uploads: Sequence[Path],
        *,
        method: str,
        crops: Sequence[Rectangle | None],
        parameters: Mapping[str, Any],
        frames: Sequence[Frames | None] = (),
        output: str = "texture",
        file_format: AnyFormat | None = None,
        depth: Literal[8, 16] | None = None,
    ) -> tuple[bytes, str]:
        """An output straight from files: the picture and its media type. Nothing of it is kept, the files included.

        Parameters
        ----------
        uploads : sequence of Path
            One file for each input.
        method : str
        crops, frames : sequence of Rectangle or None, and of Frames or None
            Of the files, in their order; for those at the end that are left out, and for None, as in `NewInput`.
        parameters : mapping
        output, file_format, depth
            The name of the output that is the answer, and what it is written as.

        Raises
        ------
        AppError
            Any of those of `add_sample`, `submit` and `converted`; `ConflictError` if the run failed.
        """
        return await self._direct.synthesize(
            uploads,
            method=method,
            crops=crops,
            frames=frames,
            parameters=parameters,
            output=output,
            file_format=file_format,
            depth=depth,
        )

    def prune(self, older_than: timedelta | None) -> Pruned:
        """Remove what nothing refers to and, where ``older_than`` is given, experiments that finished longer ago."""
        return self._housekeeping.prune(older_than)

    # inside

    def _owned(self, experiment_id: str, token: str | None) -> Experiment:
        experiment = self._store.get(experiment_id)
        if not self.owns(experiment, token):
            raise ForbiddenError(
                "Only the owner of this experiment may do this: use the browser or the token it was made with."
            )
        return experiment

    def _delete(self, experiment: Experiment) -> None:
        self._housekeeping.delete(experiment)
        for output in experiment.outputs:  # afterwards: who waits for one then learns why it does not come
            self._executor.cancel(deep_job(experiment.id, output.name))

    def _forget(self, experiment: Experiment) -> None:
        self._store.cancel(experiment.id)
        self._executor.cancel(experiment.id)
        self._delete(self._store.get(experiment.id))

    def _ended(self, job: str, failure: str | None) -> None:
        """Record a failure of the worker itself; what a worker computed it has recorded."""
        if failure is not None:
            if DEEP in job:
                self._outputs.failed(job, failure)
            else:
                self._housekeeping.record_failure(job, failure)

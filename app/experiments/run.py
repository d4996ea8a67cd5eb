"""Jobs of a worker process: reads the crops, runs the method, keeps and records the outputs."""

import logging
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from app.errors import AppError, CancelledError, DeletedError, NotFoundError
from app.experiments.diagnostics import diagnose
from app.experiments.environment import environment
from app.experiments.model import DEEP, Experiment, Output, Status, deep_name
from app.experiments.ports import BlobStore, ExperimentStore
from app.images.read import read_crop
from app.images.stored_video import locate_crop, read_frames
from app.methods.context import Context, Progress
from app.methods.model import Clip, Picture, Source
from app.methods.registry import method as method_named
from app.methods.stages import Plan, Stages

log = logging.getLogger(__name__)

MAX_ATTEMPTS = 6  # more often than any row of restarts would start one: it is the experiment that ends the service
STAGES: Plan = (("reading the crop", 1), ("method", 91), ("structure", 6), ("writing", 2))


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
            _add_deep(store, blobs, experiment_id, output, progress, threads)
        except CancelledError:
            raise
        except Exception as error:
            raise AppError(_in_words(job, error)) from error
        return
    experiment = store.start(experiment_id)
    if experiment is None:
        return
    try:
        if experiment.attempts > MAX_ATTEMPTS:
            raise AppError("Running this experiment ended its worker again and again: try a smaller width and height.")
        _compute(store, blobs, experiment, progress, threads)
    except CancelledError:
        return  # recorded before the worker was told
    except Exception as error:
        store.fail(experiment_id, _in_words(job, error))


def pick(pictures: Iterable[Picture], wanted: str) -> Iterator[Picture]:
    """Run a method until it yields the picture of this name, and no further; what came before is dropped."""
    for picture in pictures:
        if picture.name == wanted:
            yield picture
            return
        _drop(picture)


def _drop(picture: Picture) -> None:
    if isinstance(picture.data, Path):
        picture.data.unlink(missing_ok=True)


def _in_words(job: str, error: Exception) -> str:
    """Say what went wrong, for people; what they cannot do anything about is in the log."""
    if isinstance(error, AppError):
        return error.message
    if isinstance(error, MemoryError):
        return "There was not enough memory for this experiment: try a smaller width and height."
    log.error("job %s failed", job, exc_info=error)
    if isinstance(error, OSError):
        return "The service could not read or write its files. Its operator finds the reason in the log."
    return "Something went wrong inside the method. This is a fault of the service, not yours."


def _compute(
    store: ExperimentStore, blobs: BlobStore, experiment: Experiment, progress: Progress, threads: int
) -> None:
    timer = StageTimer(progress)
    stages = Stages(STAGES, timer)
    sources = _read(store, blobs, experiment, stages)
    method = stages.within("method")
    pictures = _pictures(experiment, sources, experiment.depth, threads, method, blobs.temporary_directory)
    if experiment.transient:
        pictures = pick(pictures, experiment.wanted)
    with _staged(blobs, pictures) as staged:
        diagnostics = {} if experiment.transient else diagnose(sources, staged, stages)
        stages.finish()
        with blobs.lease():
            outputs = [_kept(blobs, picture, path) for picture, path in staged]
            store.succeed(experiment.id, outputs, timer.seconds(), diagnostics, environment())


def _add_deep(
    store: ExperimentStore, blobs: BlobStore, experiment_id: str, output: str, progress: Progress, threads: int
) -> None:
    try:
        experiment = store.get(experiment_id)
    except (NotFoundError, DeletedError):
        return
    if experiment.status is not Status.SUCCEEDED or experiment.output(deep_name(output)) is not None:
        return
    stages = Stages(STAGES, progress)
    sources = _read(store, blobs, experiment, stages)
    pictures = _pictures(experiment, sources, 16, threads, stages.within("method"), blobs.temporary_directory)
    with _staged(blobs, _deep(pictures, output)) as staged, blobs.lease():
        for picture, path in staged:
            store.add_output(experiment_id, replace(_kept(blobs, picture, path), name=deep_name(picture.name)))


def _deep(pictures: Iterable[Picture], output: str) -> Iterator[Picture]:
    """The wanted picture, and the still textures that are made before it: they will be asked for next."""
    for picture in pictures:
        if picture.name == output or (picture.kind == "texture" and picture.frames == 1):
            yield picture
        else:
            _drop(picture)
        if picture.name == output:
            return


def _read(store: ExperimentStore, blobs: BlobStore, experiment: Experiment, progress: Progress) -> list[Source]:
    progress("reading the crop", 0.0)
    sources = []
    method = method_named(experiment.method)
    for index, item in enumerate(experiment.inputs):
        sample = store.sample(item.sample)
        path, peak = blobs.path(sample.digest), 65535 if sample.depth == 16 else 255
        if method.slot(index).moving:
            film = Clip(read_frames(path, item.crop, item.frames, sample.height), sample.rate)
            sources.append(Source(film.frames[0].astype(np.float32), peak, film))
        else:
            pixels = read_crop(path, locate_crop(item.crop, item.frames.first, sample.height))
            sources.append(Source(pixels, peak))
    return sources


def _pictures(
    experiment: Experiment,
    sources: list[Source],
    depth: Literal[8, 16],
    threads: int,
    progress: Progress,
    scratch: Path,
) -> Iterator[Picture]:
    method = method_named(experiment.method)
    params = method.params.model_validate(experiment.parameters)
    return method.pictures(sources, params, Context(depth, threads, progress, scratch))


@contextmanager
def _staged(blobs: BlobStore, pictures: Iterable[Picture]) -> Iterator[list[tuple[Picture, Path]]]:
    """Pictures as files beside the store: what is large does not stay in memory until all are made."""
    staged: list[tuple[Picture, Path]] = []
    try:
        for picture in pictures:
            data = picture.data
            staged.append((replace(picture, data=b""), data if isinstance(data, Path) else blobs.temporary(data)))
        yield staged
    finally:
        for _, path in staged:
            path.unlink(missing_ok=True)


def _kept(blobs: BlobStore, picture: Picture, path: Path) -> Output:
    size = path.stat().st_size
    digest = blobs.put_file(path)
    return Output(**picture.properties(), bytes=size, digest=digest)


class StageTimer:
    """Passes progress on and keeps the seconds of every stage."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._seconds: dict[str, float] = {}
        self._stage: str | None = None
        self._since = time.perf_counter()

    def __call__(self, stage: str, fraction: float) -> None:
        self._progress(stage, fraction)
        if stage != self._stage:
            self.seconds()
            self._stage = stage

    def seconds(self) -> dict[str, float]:
        """Seconds by stage up to now."""
        now = time.perf_counter()
        if self._stage is not None:
            self._seconds[self._stage] = self._seconds.get(self._stage, 0.0) + now - self._since
        self._since = now
        return dict(self._seconds)

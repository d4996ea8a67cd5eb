"""Computation of an experiment: reads the crops, runs the method, keeps and records the outputs."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Literal

import numpy as np

from app.errors import STORAGE, DeletedError, NotFoundError, UnavailableError
from app.experiments.diagnostics import diagnose
from app.experiments.environment import environment
from app.experiments.files.staging import drop, keep, pick, stage
from app.experiments.heartbeat import patiently
from app.experiments.model import DEEP, Experiment, Lease, Status, deep_name
from app.experiments.ports import BlobStore, ExperimentStore
from app.experiments.stage_timer import StageTimer
from app.images.read import read_crop
from app.images.stored_video import locate_crop, read_frames
from app.methods.context import Context, Progress
from app.methods.model import Clip, Picture, Source
from app.methods.registry import method as method_named
from app.methods.stages import Plan, Stages

STAGES: Plan = (("reading the crop", 1), ("method", 91), ("structure", 6), ("writing", 2))


def compute(
    store: ExperimentStore,
    blobs: BlobStore,
    lease: Lease,
    experiment: Experiment,
    progress: Progress,
    threads: int,
) -> None:
    """Compute a started experiment, and record its success with what it made, if its lease is held still."""
    timer = StageTimer(progress)
    stages = Stages(STAGES, timer)
    sources = _read_sources(store, blobs, experiment, stages)
    method = stages.within("method")
    pictures = _make_pictures(experiment, sources, experiment.depth, threads, method, blobs.temporary_directory)
    if experiment.transient:
        pictures = pick(pictures, experiment.wanted)
    with stage(blobs, pictures) as staged:
        diagnostics = {} if experiment.transient else diagnose(sources, staged, stages)
        stages.finish()
        with blobs.lease():
            outputs = [keep(blobs, picture, path) for picture, path in staged]
            patiently(lambda: store.succeed(lease, outputs, timer.seconds(), diagnostics, environment()))


def add_deep(store: ExperimentStore, blobs: BlobStore, lease: Lease, progress: Progress, threads: int) -> None:
    """Compute an output of an experiment at 16 bits, and add it; nothing if that is not there or has it already."""
    experiment_id, _, output = lease.job.partition(DEEP)
    try:
        experiment = store.get(experiment_id)
    except (NotFoundError, DeletedError):
        return
    if experiment.status is not Status.SUCCEEDED or experiment.output(deep_name(output)) is not None:
        return
    stages = Stages(STAGES, progress)
    sources = _read_sources(store, blobs, experiment, stages)
    pictures = _make_pictures(experiment, sources, 16, threads, stages.within("method"), blobs.temporary_directory)
    with stage(blobs, _pick_deep(pictures, output)) as staged, blobs.lease():
        for picture, path in staged:
            kept = replace(keep(blobs, picture, path), name=deep_name(picture.name))
            patiently(partial(store.add_output, lease, kept))


def _pick_deep(pictures: Iterable[Picture], output: str) -> Iterator[Picture]:
    """The wanted picture, and the still textures that are made before it: they will be asked for next."""
    for picture in pictures:
        if picture.name == output or (picture.kind == "texture" and picture.frames == 1):
            yield picture
        else:
            drop(picture)
        if picture.name == output:
            return


def _read_sources(store: ExperimentStore, blobs: BlobStore, experiment: Experiment, progress: Progress) -> list[Source]:
    progress("reading the crop", 0.0)
    sources = []
    method = method_named(experiment.method)
    for index, item in enumerate(experiment.inputs):
        sample = store.sample(item.sample)
        path, peak = _find(blobs, sample.digest), 65535 if sample.depth == 16 else 255
        if method.slot(index).moving:
            clip = Clip(read_frames(path, item.crop, item.frames, sample.height), sample.rate)
            sources.append(Source(clip.frames[0].astype(np.float32), peak, clip))
        else:
            pixels = read_crop(path, locate_crop(item.crop, item.frames.first, sample.height))
            sources.append(Source(pixels, peak))
    return sources


def _find(blobs: BlobStore, digest: str) -> Path:
    """The file of a sample, which the database has: where there is none, this worker sees other files."""
    try:
        return blobs.path(digest)
    except NotFoundError as error:
        raise UnavailableError(STORAGE, "A worker does not find the photograph among its files.") from error


def _make_pictures(
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

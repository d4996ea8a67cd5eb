"""The service's words as frozen records: sample, experiment, output."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any, Literal

from app.errors import InvalidInputError
from app.images.crop import Frames, Rectangle

DEEP = "@16:"  # in the name of a job, between a finished experiment and the output to compute at 16 bits


class Status(StrEnum):
    """Where an experiment stands."""

    QUEUED = "queued"  # accepted and on disk; waits for a worker
    RUNNING = "running"  # a worker has it; after a crash it is run again
    SUCCEEDED = "succeeded"  # every output is on disk
    FAILED = "failed"  # `error` says why and what to try
    CANCELLED = "cancelled"  # stopped by a person

    @property
    def finished(self) -> bool:
        """Whether nothing will change any more."""
        return self in {Status.SUCCEEDED, Status.FAILED, Status.CANCELLED}


@dataclass(frozen=True)
class Sample:
    """An uploaded or bundled picture or video, stored once, upright, in sRGB, without metadata.

    ``digest`` is the SHA-256 (hex) of its stored PNG file, the name under which the blob store keeps it. ``depth`` is
    8 or 16 bits per channel; ``channels`` counts colour channels (1 or 3); ``transparent`` says that the stored PNG has
    an alpha channel with pixels that are not opaque. ``title`` is set for bundled samples, whose ids are file stems.

    A video has more than one of ``frames``, ``rate`` of them a second, and ``media_type`` is what it was uploaded as;
    its file is a frame stack (`app.images.stored_video`): one PNG of all frames, one below the other, each of
    ``width`` × ``height``.
    """

    id: str
    digest: str
    width: int
    height: int
    channels: int
    depth: int
    transparent: bool
    created_at: datetime
    frames: int = 1
    media_type: str = "image/png"
    title: str | None = None
    bundled: bool = False
    rate: float = 0.0

    @property
    def moving(self) -> bool:
        """Whether it is a video."""
        return self.frames > 1


@dataclass(frozen=True)
class ExperimentInput:
    """A crop of a sample, of one of its frames or of several.

    Both are always explicit: where none was asked for, all of the picture, and of a video all frames where the method
    takes a video, else the first.
    """

    sample: str
    crop: Rectangle
    frames: Frames = field(default_factory=Frames)


@dataclass(frozen=True)
class Output:
    """A named file of an experiment. Names that start with ``.`` are the service's own and are not listed.

    ``kind``, ``frames`` and ``rate`` are as in `app.methods.model.Picture`.
    """

    name: str
    title: str
    media_type: str
    width: int
    height: int
    bytes: int
    digest: str
    kind: Literal["texture", "view"] = "view"
    frames: int = 1
    rate: float = 0.0

    @property
    def listed(self) -> bool:
        return not self.name.startswith(".")

    @property
    def film(self) -> bool:
        """Whether it is a video, not a picture (though that may be animated)."""
        return self.media_type.startswith("video/")


@dataclass(frozen=True)
class Experiment:
    """One run: method, inputs and parameters (complete: defaults and sizes filled in), and what came of it.

    ``owner`` is the SHA-256 (hex) of the owner's token. ``timings`` are seconds by stage, in order. ``diagnostics``
    is what was measured of it (see `app.experiments.diagnostics`), ``environment`` where it was computed (see
    `app.experiments.environment`; empty in what earlier versions made). ``depth`` is the bits per channel of its
    pictures: that of its deepest sample. A ``transient`` one is made for a single answer: only the output that is
    ``wanted`` is kept, and it goes with the answer.
    """

    id: str
    method: str
    inputs: tuple[ExperimentInput, ...]
    parameters: Mapping[str, Any]
    listed: bool
    owner: str
    created_at: datetime
    status: Status = Status.QUEUED
    attempts: int = 0
    outputs: tuple[Output, ...] = ()
    timings: Mapping[str, float] = field(default_factory=dict)
    diagnostics: Mapping[str, Any] = field(default_factory=dict)
    environment: Mapping[str, str] = field(default_factory=dict)
    error: str | None = None
    started_at: datetime | None = None
    finished_at: datetime | None = None
    transient: bool = False
    depth: Literal[8, 16] = 8
    wanted: str = "texture"

    def output(self, name: str) -> Output | None:
        """The output of this name, or None."""
        return next((output for output in self.outputs if output.name == name), None)


@dataclass(frozen=True)
class Page:
    """A page of the archive; ``cursor`` names the next one, None on the last."""

    experiments: tuple[Experiment, ...]
    cursor: str | None


@dataclass(frozen=True)
class Snapshot:
    """An experiment's state of this moment, as the progress bar shows it.

    ``position`` is its place in the queue (1 is next) while it waits; ``fraction`` is 0–1; ``stage`` names what is
    being done; ``elapsed`` are the seconds since it was started.
    """

    status: Status
    position: int | None = None
    fraction: float = 0.0
    stage: str | None = None
    elapsed: float = 0.0


def deep_job(experiment_id: str, output: str) -> str:
    """Name the job that computes an output of a finished experiment at 16 bits, and keeps it as `deep_name`."""
    return f"{experiment_id}{DEEP}{output}"


def deep_name(output: str) -> str:
    """Name an output at 16 bits beside the one of 8; it is not listed.

    Examples
    --------
    >>> deep_name("texture")
    '.texture-16'
    """
    return f".{output}-16"


def check_frame(sample: Sample, frame: int) -> None:
    """Raise `InvalidInputError` if a sample has no frame of this number."""
    if not 0 <= frame < sample.frames:
        count = f"{sample.frames} frames" if sample.moving else "one frame"
        raise InvalidInputError(f"The sample has {count}; the first is number 0.", "frame")

"""Records of the domain: sample, experiment, output, and their states."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any, Literal

from app.errors import InvalidInputError
from app.images.crop import Frames, Rectangle
from app.images.media import Media
from app.methods.model import PictureInfo

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


ATTEMPTS = 5  # deaths of its worker after which a job is at fault


@dataclass(frozen=True)
class Attempt:
    """A run that ended because its worker died while service and engine lived; only those are charged to a job."""

    #: When it ended.
    at: datetime
    #: What became of the worker, in words.
    cause: str


@dataclass(frozen=True)
class Lease:
    """The right to run a job and to record what comes of it, until somebody else has it.

    Each lease of a job has a higher fencing number than the one before: who carries an older one changes nothing.
    """

    #: Its name: an experiment's id, or what `deep_job` makes of it.
    job: str
    #: The fencing number.
    fence: int
    #: What was charged to the job before.
    attempts: tuple[Attempt, ...] = ()

    @property
    def last(self) -> bool:
        """Whether the job fails if its worker dies once more."""
        return len(self.attempts) >= ATTEMPTS - 1


@dataclass(frozen=True)
class Beat:
    """The heartbeat of a lease: as long as its worker lives, the number grows."""

    job: str
    fence: int
    #: Counts the renewals.
    beat: int


@dataclass(frozen=True, kw_only=True)
class Sample(Media):
    """An uploaded or bundled picture or video, stored once, upright, in sRGB, without metadata."""

    #: Of addresses; of a bundled sample the stem of its file's name.
    id: str
    #: SHA-256 (hex) of the stored PNG file, its name in the blob store; of a video that of its frame stack.
    digest: str
    #: When it was added.
    created_at: datetime
    #: Of a bundled sample; None of an upload.
    title: str | None = None
    #: Whether it comes with the service.
    bundled: bool = False


@dataclass(frozen=True)
class ExperimentInput:
    """A crop of a sample, of one of its frames or of several; both are always explicit."""

    #: Id of the sample.
    sample: str
    #: All of the picture where none was chosen.
    crop: Rectangle
    #: Where none were chosen all frames of a video if the method takes one, else the first.
    frames: Frames = field(default_factory=Frames)


@dataclass(frozen=True, kw_only=True)
class Output(PictureInfo):
    """A named file of an experiment. Names that start with ``.`` are the service's own and are not listed."""

    #: Size of the file.
    bytes: int
    #: SHA-256 (hex) of the file, its name in the blob store.
    digest: str

    @property
    def listed(self) -> bool:
        """Whether people see it among the outputs."""
        return not self.name.startswith(".")

    @property
    def video(self) -> bool:
        """Whether its file is a video, not a picture (though that may be animated)."""
        return self.media_type.startswith("video/")


@dataclass(frozen=True)
class Experiment:
    """One run: method, inputs and parameters, and what came of it."""

    #: Of addresses, and of the job that computes it.
    id: str
    #: Name of the method.
    method: str
    #: In the order of the method's slots.
    inputs: tuple[ExperimentInput, ...]
    #: Complete: defaults and sizes are filled in.
    parameters: Mapping[str, Any]
    #: Whether the archive shows it.
    listed: bool
    #: SHA-256 (hex) of the owner's token.
    owner: str
    #: When it was submitted.
    created_at: datetime
    #: Where it stands.
    status: Status = Status.QUEUED
    #: Runs in which its worker died.
    attempts: tuple[Attempt, ...] = ()
    #: Its files, in the order in which the method yields them.
    outputs: tuple[Output, ...] = ()
    #: Seconds by stage, in order.
    timings: Mapping[str, float] = field(default_factory=dict)
    #: Measurements of its crops and textures, see `app.experiments.diagnostics`.
    diagnostics: Mapping[str, Any] = field(default_factory=dict)
    #: Versions and processor that computed it, see `app.experiments.environment`; empty where they were not recorded.
    environment: Mapping[str, str] = field(default_factory=dict)
    #: Why it failed and what to try.
    error: str | None = None
    #: When a worker began it last.
    started_at: datetime | None = None
    #: When it succeeded, failed or was cancelled.
    finished_at: datetime | None = None
    #: Whether it is made for a single answer, and deleted with it.
    transient: bool = False
    #: Bits per channel of its pictures: those of its deepest sample.
    depth: Literal[8, 16] = 8
    #: Of a transient one the only output that is kept.
    wanted: str = "texture"

    def output(self, name: str) -> Output | None:
        """Find the output of this name, or None."""
        return next((output for output in self.outputs if output.name == name), None)


@dataclass(frozen=True)
class Page:
    """A page of the archive; ``cursor`` names the next one, None on the last."""

    experiments: tuple[Experiment, ...]
    cursor: str | None


@dataclass(frozen=True)
class Snapshot:
    """State of an experiment at a moment, as the progress bar shows it."""

    #: Where it stands.
    status: Status
    #: Place in the queue while it waits; 1 is next.
    position: int | None = None
    #: The part of the run that is done, 0–1.
    fraction: float = 0.0
    #: Name of the stage that is being computed.
    stage: str | None = None
    #: Seconds since a worker began it; once it has finished, seconds that it took.
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

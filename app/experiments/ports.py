"""What the use cases need from outside: protocols that `app.store` and `app.executor` implement."""

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import AbstractContextManager
from datetime import datetime
from pathlib import Path
from typing import Any, Protocol

from app.experiments.model import Experiment, Output, Page, Sample, Snapshot
from app.methods.model import Progress
from app.settings import Settings


class ExperimentStore(Protocol):
    """Samples and experiments, durable. Every call is one transaction; every method may be called from any thread."""

    def add_sample(self, sample: Sample, owner: str | None = None) -> None: ...

    def sample(self, sample_id: str) -> Sample:
        """Raises `NotFoundError`."""
        ...

    def bundled_samples(self) -> list[Sample]: ...

    def add(self, experiment: Experiment) -> None: ...

    def replace(self, experiment: Experiment) -> None:
        """Add it in the place of one of the same identifier, whatever became of that, or of its tombstone."""
        ...

    def get(self, experiment_id: str) -> Experiment:
        """Raises `NotFoundError`, or `DeletedError` for one that was deleted."""
        ...

    def page(self, *, limit: int, cursor: str | None = None, method: str | None = None) -> Page:
        """Succeeded, listed experiments, newest first. A malformed cursor raises `InvalidInputError`."""
        ...

    def unfinished(self) -> list[str]:
        """Ids of queued and running experiments that are not transient, oldest first."""
        ...

    def start(self, experiment_id: str) -> Experiment | None:
        """Mark it running and count the attempt; None if it is already finished, cancelled or deleted."""
        ...

    def succeed(
        self,
        experiment_id: str,
        outputs: Sequence[Output],
        timings: Mapping[str, float],
        diagnostics: Mapping[str, Any],
        environment: Mapping[str, str],
    ) -> bool:
        """Record outputs and success in one transaction; nothing and False if it is no longer running."""
        ...

    def fail(self, experiment_id: str, error: str) -> bool:
        """Queued or running → failed; False if it was finished already."""
        ...

    def cancel(self, experiment_id: str) -> bool:
        """Queued or running → cancelled; False if it was finished already."""
        ...

    def add_output(self, experiment_id: str, output: Output) -> None:
        """Add or replace one output of a succeeded experiment."""
        ...

    def set_listed(self, experiment_id: str, listed: bool) -> None: ...

    def delete(self, experiment_id: str) -> None:
        """Leave a tombstone (later `get` raises `DeletedError`) and forget everything else about it."""
        ...

    def remove_unused_samples(self, created_before: datetime, among: Collection[str] | None = None) -> list[Sample]:
        """Remove uploads older than this (of those named, or of all) to which no experiment refers; returns them."""
        ...

    def finished_before(self, moment: datetime) -> list[str]:
        """Ids of the experiments that finished before this moment."""
        ...

    def transient_before(self, moment: datetime) -> list[str]:
        """Ids of the transient experiments made before this moment."""
        ...

    def used(self, digests: Collection[str]) -> set[str]:
        """Those of the digests that a sample or an output refers to."""
        ...

    def counts(self) -> Mapping[str, int]:
        """Experiments by status."""
        ...

    def close(self) -> None: ...


class BlobStore(Protocol):
    """Files by the SHA-256 (hex) of their content; written to a temporary name, fsynced, renamed."""

    @property
    def temporary_directory(self) -> Path:
        """Where files are made that `put_file` will move in."""
        ...

    def temporary(self, data: bytes) -> Path:
        """Write a file that `put_file` can move in, already on disk."""
        ...

    def put(self, data: bytes) -> str: ...

    def put_file(self, path: Path) -> str:
        """Move a finished file in; the path is gone afterwards."""
        ...

    def lease(self) -> AbstractContextManager[None]:
        """While this is held, nothing is removed: put files and record them within it."""
        ...

    def path(self, digest: str) -> Path:
        """Raises `NotFoundError`."""
        ...

    def digests(self) -> list[str]:
        """Every digest that has a file."""
        ...

    def remove_unused(self, candidates: Collection[str], used: Callable[[Collection[str]], set[str]]) -> set[str]:
        """Remove the candidates that ``used``, asked while nobody can put a file, does not name; returns them."""
        ...

    def remove_temporary(self, older_than: datetime) -> int:
        """Remove what killed processes left half-written before this moment; how many."""
        ...


Ended = Callable[[str, str | None], None]
"""``ended(job, failure)``"""

Run = Callable[[Settings, str, Progress], None]
"""What a worker calls: ``run(settings, job, progress)``"""


class Executor(Protocol):
    """The engine that runs jobs: experiments, by their ids, and outputs at 16 bits (`app.experiments.model.deep_job`).

    It calls ``ended(job, failure)`` from a thread of its own once a job has left it: ``failure`` is None if the
    worker's function returned or the job was cancelled, otherwise a sentence for people. What a worker computes it
    records itself.
    """

    def start(self, ended: Ended) -> None:
        """Return when jobs can run. Jobs submitted before are kept."""
        ...

    def close(self) -> None: ...

    @property
    def ready(self) -> bool: ...

    def submit(self, job: str) -> None:
        """Queue a job; one that is queued or runs already stays as it is. Returns at once, from any thread."""
        ...

    def cancel(self, job: str) -> None:
        """Drop a queued job, stop a running one: first politely, then by killing its worker. Returns at once."""
        ...

    def snapshot(self, job: str) -> Snapshot | None:
        """What is known of a job that waits or runs here; None for others and for one that is being cancelled."""
        ...

    @property
    def waiting(self) -> int:
        """How many jobs wait."""
        ...

    def subscribe(self, listener: Callable[[str], None]) -> Callable[[], None]:
        """Call ``listener(job)``, from any thread, whenever a snapshot changed or a job left; returns how to end it."""
        ...

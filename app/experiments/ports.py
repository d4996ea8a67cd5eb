"""Protocols of the backends, which `app.store` and `app.executor` implement."""

from collections.abc import Callable, Collection
from contextlib import AbstractContextManager
from datetime import datetime
from pathlib import Path
from typing import Protocol

from app.experiments.model import Snapshot
from app.experiments.queue_port import JobQueue
from app.experiments.store_port import ExperimentStore
from app.methods.context import Progress
from app.settings import Settings

__all__ = ["BlobStore", "Ended", "Executor", "ExperimentStore", "JobQueue", "Run"]


class BlobStore(Protocol):
    """Files by the SHA-256 (hex) of their content; written to a temporary name, fsynced, renamed."""

    @property
    def temporary_directory(self) -> Path:
        """Directory for files that `put_file` will move in."""

    def temporary(self, data: bytes) -> Path:
        """Write a file that `put_file` can move in, already on disk."""

    def put(self, data: bytes) -> str:
        """Keep these bytes; their digest."""

    def put_file(self, path: Path) -> str:
        """Move a finished file in; its digest. The path is gone afterwards."""

    def lease(self) -> AbstractContextManager[None]:
        """Prevent removals while this is held: put files and record them within it."""

    def path(self, digest: str) -> Path:
        """Find the file of this digest.

        Raises
        ------
        NotFoundError
            If there is none.
        """

    def digests(self) -> list[str]:
        """List every digest that has a file."""

    def remove_unused(self, candidates: Collection[str], used: Callable[[Collection[str]], set[str]]) -> set[str]:
        """Remove files that nothing refers to.

        Parameters
        ----------
        candidates : collection of str
            Digests to look at.
        used : callable
            Names those of them to keep; called while nobody can put a file.

        Returns
        -------
        set of str
            Digests whose files were removed.
        """

    def remove_temporary(self, older_than: datetime) -> int:
        """Remove what killed processes left half-written before this moment; how many files."""


Ended = Callable[[str, str | None], None]
"""``ended(job, failure)``"""

Run = Callable[[Settings, str, Progress], None]
"""``run(settings, job, progress)``: what a worker calls"""


class Executor(Protocol):
    """The engine that runs jobs: experiments, by their ids, and outputs at 16 bits (`app.experiments.model.deep_job`).

    It calls ``ended(job, failure)`` from a thread of its own once a job has left it: ``failure`` is None if the
    worker's function returned or the job was cancelled, otherwise a sentence for people. What a worker computes it
    records itself.
    """

    def start(self, ended: Ended) -> None:
        """Return when jobs can run; jobs submitted before are kept."""

    def close(self) -> None:
        """Stop within seconds; jobs that wait or run are forgotten."""

    @property
    def ready(self) -> bool:
        """Whether jobs can run now."""

    def submit(self, job: str) -> None:
        """Queue a job; one that is queued or runs already stays as it is. Returns at once, from any thread."""

    def cancel(self, job: str) -> None:
        """Drop a queued job, stop a running one: first politely, then by killing its worker. Returns at once."""

    def snapshot(self, job: str) -> Snapshot | None:
        """Describe a job that waits or runs here; None for others and for one that is being cancelled."""

    @property
    def waiting(self) -> int:
        """Number of jobs that wait."""

    def subscribe(self, listener: Callable[[str], None]) -> Callable[[], None]:
        """Call a listener whenever a snapshot changed or a job left.

        Parameters
        ----------
        listener : callable ``(job)``
            Called from any thread.

        Returns
        -------
        callable
            Ends the subscription.
        """

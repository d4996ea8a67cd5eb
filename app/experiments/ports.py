"""Protocols of the backends, which `app.store` and `app.executor` implement."""

from collections.abc import Callable, Collection
from contextlib import AbstractContextManager
from datetime import datetime
from pathlib import Path
from typing import Protocol

from app.experiments.model import Lease
from app.experiments.queue_port import JobQueue
from app.experiments.store_port import ExperimentStore
from app.settings import Settings

__all__ = ["BlobStore", "Executor", "ExperimentStore", "JobQueue", "Records", "Run"]


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

    def probe(self) -> None:
        """Raise `UnavailableError` unless files can be written and read now, with room to spare."""

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


Run = Callable[[Settings, Lease], None]
"""``run(settings, lease)``: what a worker calls; it records what comes of the job, or raises `UnavailableError`"""


class Records(Protocol):
    """What an executor asks of the records of its jobs; any call may raise `UnavailableError`."""

    def fail(self, lease: Lease, error: str, cause: str | None = None) -> None:
        """Record the failure of a job that no worker can record; ``cause`` charges a last attempt."""

    def stopped(self, job: str) -> bool:
        """Whether nobody wants this job any more: it was cancelled or deleted."""


class Executor(Protocol):
    """The engine that runs what waits in the `JobQueue`: it leases a job whenever one of its workers is idle.

    It knows of no record. Progress, ends and cancellations are in the database, where every other process finds them
    too; a job whose lease is gone is stopped, first politely, then by killing its worker.
    """

    def start(self, records: Records) -> None:
        """Return when jobs can run, when it was closed, or after half a minute; it goes on trying."""

    def close(self) -> None:
        """Stop within seconds; the leases of what runs are released, and nothing is charged."""

    @property
    def ready(self) -> bool:
        """Whether there are workers."""

    def wake(self) -> None:
        """Look at the queue soon: a job was queued or cancelled here. Returns at once, from any thread."""

    def subscribe(self, listener: Callable[[str], None]) -> Callable[[], None]:
        """Call a listener whenever a job was sent to a worker of this engine, began there, or left it.

        Parameters
        ----------
        listener : callable ``(job)``
            Called from any thread.

        Returns
        -------
        callable
            Ends the subscription.
        """

"""Blob store: files by the SHA-256 of their content, under one directory."""

import fcntl
import hashlib
import os
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from datetime import datetime
from pathlib import Path
from uuid import uuid4

from app.errors import DISK_SPACE, STORAGE, NotFoundError, UnavailableError
from app.experiments.failures import part_of

PROBE = b"can be written and read"


class FileBlobs:
    """Content-addressed files: ``directory/ab/abcdef…``.

    A file that is put under a lease is not removed before the lease ends, even if nothing refers to it yet: a lease is
    a shared lock of the directory, removing takes an exclusive one. What is put must be recorded before its lease ends.

    Parameters
    ----------
    directory : Path
        Made if it is not there.
    min_free_bytes : int
        Room that must be left on its disk for it to take more.
    """

    def __init__(self, directory: Path, min_free_bytes: int = 0) -> None:
        self.directory = directory
        self._min_free_bytes = min_free_bytes
        self.temporary_directory = directory / "tmp"
        self.temporary_directory.mkdir(parents=True, exist_ok=True)
        self._lock = directory / ".lock"

    def temporary(self, data: bytes) -> Path:
        """Write a file that `put_file` can move in, already on disk."""
        path = self.temporary_directory / uuid4().hex
        with path.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        return path

    def put(self, data: bytes) -> str:
        """Keep these bytes; their digest."""
        return self.put_file(self.temporary(data))

    def put_file(self, path: Path) -> str:
        """Move a finished file of the same file system in; its digest."""
        with path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
            os.fsync(file.fileno())
        target = self._path(digest)
        if not target.parent.exists():
            target.parent.mkdir(exist_ok=True)
            _sync_directory(self.directory)
        path.replace(target)  # also one that is there: it may be damaged
        _sync_directory(target.parent)
        return digest

    @contextmanager
    def lease(self) -> Iterator[None]:
        """Prevent removals while this is held: put files and record them within it."""
        with self._locked(fcntl.LOCK_SH):
            yield

    def path(self, digest: str) -> Path:
        """Find the file of this digest.

        Raises
        ------
        NotFoundError
            If there is none.
        """
        path = self._path(digest)
        if not path.is_file():
            raise NotFoundError("This file is not here any more. It may have been deleted a moment ago.")
        return path

    def remove_unused(self, candidates: Collection[str], used: Callable[[Collection[str]], set[str]]) -> set[str]:
        """Remove the candidates that ``used``, asked while nobody can put a file, does not name; returns them."""
        removed = set()
        with self._locked(fcntl.LOCK_EX):
            for digest in set(candidates) - used(candidates):
                path = self._path(digest)
                if path.is_file():
                    path.unlink()
                    removed.add(digest)
        return removed

    def probe(self) -> None:
        """Raise `UnavailableError` unless files can be written and read now, with room to spare."""
        try:
            path = self.temporary(PROBE)
            try:
                same = path.read_bytes() == PROBE
            finally:
                path.unlink(missing_ok=True)
            room = os.statvfs(self.directory)
        except OSError as error:
            raise UnavailableError(part_of(error), f"The files cannot be written for now: {error.strerror}.") from error
        if not same:
            raise UnavailableError(STORAGE, "A file that was just written cannot be read back.")
        if room.f_bavail * room.f_frsize < self._min_free_bytes:
            raise UnavailableError(DISK_SPACE, "There is too little room left on the disk: try again later.")

    def digests(self) -> list[str]:
        """List every digest that has a file."""
        return [path.name for path in self.directory.glob("[0-9a-f][0-9a-f]/*")]

    def remove_temporary(self, older_than: datetime) -> int:
        """Remove what killed processes left half-written before this moment; how many."""
        removed = 0
        for path in self.temporary_directory.iterdir():
            with suppress(FileNotFoundError):  # its writer has just moved it in
                if path.stat().st_mtime < older_than.timestamp():
                    path.unlink()
                    removed += 1
        return removed

    def _path(self, digest: str) -> Path:
        return self.directory / digest[:2] / digest

    @contextmanager
    def _locked(self, mode: int) -> Iterator[None]:
        descriptor = os.open(self._lock, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            fcntl.flock(descriptor, mode)
            yield
        finally:
            os.close(descriptor)


def _sync_directory(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)

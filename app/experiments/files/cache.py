"""File cache: files that can be made again, bounded in size and safe to delete at any time."""

import os
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Lock
from uuid import uuid4
from weakref import WeakValueDictionary

UNFINISHED = "."  # begins the names of files that are being written
ABANDONED_SECONDS = 3600.0  # without a byte more, after which nobody writes a file any longer


class FileCache:
    """Files by name in one directory; the ones unused for longest go when they take too much room.

    Parameters
    ----------
    directory : Path
        Made if it is not there.
    max_bytes : int
        Room they may take.
    """

    def __init__(self, directory: Path, max_bytes: int) -> None:
        self._directory = directory
        self._max_bytes = max_bytes
        self._lock = Lock()
        self._making: WeakValueDictionary[str, Lock] = WeakValueDictionary()
        self._written = max_bytes  # as if full: the first file that is added looks at what is there

    def get(self, name: str, make: Callable[[], bytes]) -> Path:
        """Find the file of this name; make it if it is not there, perhaps in several threads at once."""
        path = self._directory / name
        if not _touch(path):
            self._add(path, lambda temporary: temporary.write_bytes(make()))
        return path

    def find(self, name: str) -> Path | None:
        """Find the file of this name; None if it is not there."""
        path = self._directory / name
        return path if _touch(path) else None

    def file(self, name: str, write: Callable[[Path], None]) -> Path:
        """Find the file of this name, or have one thread write it while others wait: for what takes long."""
        path = self._directory / name
        if not _touch(path):
            with self._lock:
                making = self._making.setdefault(name, Lock())
            with making:
                if not _touch(path):
                    self._add(path, write)
        return path

    def _add(self, path: Path, write: Callable[[Path], object]) -> None:
        try:
            size = self._write(path, write)
        except FileNotFoundError:  # the directory was removed meanwhile, which one may do at any time
            size = self._write(path, write)
        _touch(path)  # it began long ago where it took long to write
        self._make_room(size)

    def _write(self, path: Path, write: Callable[[Path], object]) -> int:
        self._directory.mkdir(parents=True, exist_ok=True)
        temporary = self._directory / f"{UNFINISHED}{uuid4().hex}"
        try:
            write(temporary)
            size = temporary.stat().st_size
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
        return size

    def forget(self, prefix: str) -> None:
        """Remove the files whose names start so: those that were made of one original."""
        for path in self._directory.glob(f"{prefix}*"):
            path.unlink(missing_ok=True)

    def _make_room(self, added: int) -> None:
        """Look at the whole directory once in a while only: after a tenth of the room was written."""
        with self._lock:
            self._written += added
            if self._written < self._max_bytes // 10:
                return
            self._written = 0
            found = self._list()
            total = sum(size for _, size, _ in found)
            for _, size, path in sorted(found):
                if total <= self._max_bytes * 9 // 10:
                    break
                path.unlink(missing_ok=True)
                total -= size

    def _list(self) -> list[tuple[float, int, Path]]:
        """List the files, with the time of last use and the size; without those that are being written."""
        found = []
        with suppress(FileNotFoundError):  # the directory itself was removed
            for path in self._directory.iterdir():
                with suppress(FileNotFoundError):  # somebody else removed it
                    state = path.stat()
                    if not path.name.startswith(UNFINISHED) or time.time() - state.st_mtime > ABANDONED_SECONDS:
                        found.append((state.st_atime, state.st_size, path))
        return found


class NotKeptError(Exception):
    """The cache has no such file."""


class KeptFiles:
    """The files that a cache has: nothing is made, and what is not there raises `NotKeptError`."""

    def __init__(self, cache: FileCache) -> None:
        self._cache = cache

    def get(self, name: str, make: object) -> Path:
        """Find the file of this name."""
        path = self._cache.find(name)
        if path is None:
            raise NotKeptError(name)
        return path

    file = get


def _touch(path: Path) -> bool:
    """Note that a file is used, as its time of access; whether it is there."""
    try:
        os.utime(path, ns=(time.time_ns(), path.stat().st_mtime_ns))
    except FileNotFoundError:
        return False
    return True

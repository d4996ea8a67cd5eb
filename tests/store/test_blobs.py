"""Content-addressed files."""

import hashlib
import threading
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from app.errors import NotFoundError
from app.store.blobs import FileBlobs


@pytest.fixture
def blobs(tmp_path: Path) -> FileBlobs:
    return FileBlobs(tmp_path / "files")


def test_a_file_is_named_by_its_content(blobs: FileBlobs) -> None:
    digest = blobs.put(b"texture")
    assert digest == hashlib.sha256(b"texture").hexdigest()
    assert blobs.path(digest).read_bytes() == b"texture"
    assert blobs.put(b"texture") == digest
    assert blobs.digests() == [digest]


def test_a_file_that_is_put_leaves_nothing_else(blobs: FileBlobs) -> None:
    for _ in range(2):
        path = blobs.temporary(b"texture")
        blobs.put_file(path)
        assert not path.exists()
    assert list(blobs.temporary_directory.iterdir()) == []


@pytest.mark.parametrize("digest", ["0" * 64, ""])
def test_a_file_that_is_not_there_is_not_found(blobs: FileBlobs, digest: str) -> None:
    with pytest.raises(NotFoundError):
        blobs.path(digest)


def test_what_is_used_stays(blobs: FileBlobs) -> None:
    used, unused = blobs.put(b"used"), blobs.put(b"unused")
    assert blobs.remove_unused([used, unused, "0" * 64], lambda _: {used}) == {unused}
    assert blobs.digests() == [used]


def test_nothing_is_removed_while_somebody_holds_a_lease(tmp_path: Path) -> None:
    """What is put and recorded under a lease is seen as used by whoever removes, or is put after the removal."""
    mine, theirs = FileBlobs(tmp_path), FileBlobs(tmp_path)
    recorded: set[str] = set()
    removed: list[set[str]] = []
    digest = mine.put(b"texture")
    remover = threading.Thread(target=lambda: removed.append(theirs.remove_unused([digest], lambda _: recorded)))
    with mine.lease():
        remover.start()
        assert mine.put(b"texture") == digest
        recorded.add(digest)
        assert removed == []
    remover.join()
    assert removed == [set()]
    assert mine.path(digest).exists()


def test_leases_are_shared(blobs: FileBlobs) -> None:
    with blobs.lease(), blobs.lease():
        blobs.put(b"texture")


def test_only_stale_temporary_files_are_removed(blobs: FileBlobs) -> None:
    blobs.temporary(b"half")
    now = datetime.now(UTC)
    assert blobs.remove_temporary(now - timedelta(minutes=1)) == 0
    assert blobs.remove_temporary(now + timedelta(minutes=1)) == 1

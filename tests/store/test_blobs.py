"""Content-addressed files."""

import hashlib
import os
import threading
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from app.errors import DISK_SPACE, STORAGE, NotFoundError, UnavailableError
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
    with pytest.raises(NotFoundError, match="This file is not here any more"):
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


@pytest.mark.parametrize(("age", "goes"), [(-1, False), (0, False), (1, True)], ids=["younger", "as old", "older"])
def test_a_temporary_file_is_removed_if_it_is_older(blobs: FileBlobs, age: int, goes: bool) -> None:
    moment = datetime(2026, 3, 1, tzinfo=UTC)
    path = blobs.temporary(b"half")
    os.utime(path, (moment.timestamp() - age,) * 2)
    assert blobs.remove_temporary(moment) == goes
    assert path.exists() is not goes


def test_temporary_files_that_somebody_else_removes_meanwhile_keep_no_other_from_going(
    blobs: FileBlobs, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before it is looked at and before it is removed."""
    paths = [blobs.temporary(b"half") for _ in range(6)]
    unlink, stat = Path.unlink, Path.stat

    def raced_unlink(path: Path, missing_ok: bool = False) -> None:
        if path == paths[0]:
            unlink(path)
        unlink(path, missing_ok=missing_ok)

    def raced_stat(path: Path, **options: bool) -> os.stat_result:
        if path == paths[1]:
            unlink(path, missing_ok=True)
        return stat(path, **options)

    monkeypatch.setattr(Path, "unlink", raced_unlink)
    monkeypatch.setattr(Path, "stat", raced_stat)
    assert blobs.remove_temporary(datetime.now(UTC) + timedelta(minutes=1)) == 4
    assert list(blobs.temporary_directory.iterdir()) == []


def test_what_is_put_is_on_the_disk_before_it_has_its_name(blobs: FileBlobs, monkeypatch: pytest.MonkeyPatch) -> None:
    """First the content, then the name: a power cut leaves no name without its content."""
    events: list[str] = []
    sync, replace = os.fsync, Path.replace

    def note_sync(descriptor: int) -> None:
        events.append("sync")
        sync(descriptor)

    def note_name(path: Path, target: Path) -> Path:
        events.append("name")
        return replace(path, target)

    monkeypatch.setattr(os, "fsync", note_sync)
    monkeypatch.setattr(Path, "replace", note_name)
    digest = blobs.put(b"texture")
    # As it is written, as it is moved in, the directory's own name if it is new, and what is in it.
    assert events == ["sync", "sync", "sync", "name", "sync"]
    events.clear()
    assert blobs.put(b"texture") == digest
    assert events == ["sync", "sync", "name", "sync"]


def test_what_is_put_again_mends_a_damaged_file(blobs: FileBlobs) -> None:
    digest = blobs.put(b"texture")
    blobs.path(digest).write_bytes(b"")
    assert blobs.put(b"texture") == digest
    assert blobs.path(digest).read_bytes() == b"texture"


@pytest.mark.parametrize("missing", [0, 1 << 60])
def test_a_probe_says_whether_files_can_be_written_with_room_to_spare(tmp_path: Path, missing: int) -> None:
    blobs = FileBlobs(tmp_path / "files", min_free_bytes=missing)
    if not missing:
        blobs.probe()
    else:
        with pytest.raises(UnavailableError, match="too little room") as raised:
            blobs.probe()
        assert raised.value.part == DISK_SPACE
    assert list(blobs.temporary_directory.iterdir()) == []


def test_a_directory_that_is_gone_is_unavailable_and_comes_back(tmp_path: Path) -> None:
    blobs = FileBlobs(tmp_path / "files")
    blobs.directory.rename(tmp_path / "away")
    with pytest.raises(UnavailableError, match="cannot be written") as raised:
        blobs.probe()
    assert raised.value.part == STORAGE
    (tmp_path / "away").rename(blobs.directory)
    blobs.probe()


def test_a_lock_is_let_go_even_if_what_holds_it_fails(blobs: FileBlobs) -> None:
    with pytest.raises(ZeroDivisionError), blobs.lease():
        raise ZeroDivisionError
    with pytest.raises(ZeroDivisionError):
        blobs.remove_unused(["0" * 64], lambda candidates: 1 / 0)  # type: ignore[arg-type,return-value]
    digest = blobs.put(b"texture")
    assert blobs.remove_unused([digest], lambda candidates: set()) == {digest}


def test_a_file_that_is_gone_already_is_not_counted(blobs: FileBlobs) -> None:
    digest = blobs.put(b"texture")
    assert blobs.remove_unused([digest, "0" * 64], lambda candidates: set()) == {digest}
    assert blobs.remove_unused([digest], lambda candidates: set()) == set()


def test_only_files_under_their_digest_count_as_kept(blobs: FileBlobs) -> None:
    digest = blobs.put(b"texture")
    blobs.temporary(b"half")
    assert blobs.digests() == [digest]

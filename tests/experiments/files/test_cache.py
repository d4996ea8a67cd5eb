"""Files that can be made again."""

import os
import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier, Event

import pytest

from app.experiments.files.cache import FileCache

PATIENCE = 20.0


def test_what_takes_long_is_written_once_while_others_wait(tmp_path: Path) -> None:
    cache, written = FileCache(tmp_path / "cache", 1 << 20), []
    wanted, waiting = Event(), Barrier(4)

    def write(path: Path) -> None:
        wanted.wait(PATIENCE)
        written.append(path)
        path.write_bytes(b"film")

    def ask() -> bytes:
        waiting.wait(PATIENCE)
        return cache.file("film.mp4", write).read_bytes()

    with ThreadPoolExecutor(4) as pool:
        answers = [pool.submit(ask) for _ in range(4)]
        wanted.set()
        assert {answer.result(PATIENCE) for answer in answers} == {b"film"}
    assert len(written) == 1


def test_other_files_are_written_meanwhile(tmp_path: Path) -> None:
    cache, go_on = FileCache(tmp_path, 1 << 20), Event()

    def slow(path: Path) -> None:
        go_on.wait(PATIENCE)
        path.write_bytes(b"slow")

    def quick(path: Path) -> None:
        path.write_bytes(b"quick")

    with ThreadPoolExecutor(1) as pool:
        first = pool.submit(cache.file, "slow.mp4", slow)
        assert cache.file("quick.mp4", quick).read_bytes() == b"quick"
        assert not first.done()
        go_on.set()
        assert first.result(PATIENCE).read_bytes() == b"slow"


def test_what_fails_leaves_nothing_and_can_be_tried_again(tmp_path: Path) -> None:
    cache = FileCache(tmp_path, 1 << 20)

    def fail(path: Path) -> None:
        path.write_bytes(b"half")
        raise OSError("the disk is full")

    with pytest.raises(OSError, match="full"):
        cache.file("film.mp4", fail)
    assert list(tmp_path.iterdir()) == []
    assert cache.get("film.mp4", lambda: b"whole").read_bytes() == b"whole"


def filled(cache: FileCache, directory: Path, *sizes: int) -> list[Path]:
    """Files of these sizes, each used a minute after the one before it, long ago."""
    paths = []
    for number, size in enumerate(sizes):
        path = cache.get(f"{number}", lambda size=size: b"x" * size)  # a default binds the size
        os.utime(path, (1000 + 60 * number,) * 2)
        paths.append(path)
    assert all(path.parent == directory for path in paths)
    return paths


@pytest.mark.parametrize(("last", "gone"), [(100, 0), (101, 1), (200, 1), (201, 2), (901, 9)])
def test_files_unused_for_longest_go_until_a_tenth_of_the_room_is_free(tmp_path: Path, last: int, gone: int) -> None:
    """Of 1,000 bytes 900 are left; not one file more than needed goes."""
    cache = FileCache(tmp_path, 1000)
    paths = filled(cache, tmp_path, *[100] * 8)
    paths.append(cache.get("last", lambda: b"x" * last))
    cache.get("more", lambda: b"")
    cache._make_room(1000)
    assert [path.exists() for path in paths] == [number >= gone for number in range(9)]


def test_what_is_asked_for_again_counts_as_used(tmp_path: Path) -> None:
    cache = FileCache(tmp_path, 1000)
    paths = filled(cache, tmp_path, *[100] * 8)
    assert cache.get("0", lambda: pytest.fail("it is there")) == paths[0]
    assert cache.file("1", lambda path: pytest.fail("it is there")) == paths[1]
    cache.get("last", lambda: b"x" * 250)
    cache._make_room(1000)
    assert [path.exists() for path in paths] == [number not in (2, 3) for number in range(8)]


@pytest.mark.parametrize(("added", "looks"), [(99, False), (100, True)])
def test_the_directory_is_looked_at_after_a_tenth_of_the_room_was_written(
    tmp_path: Path, added: int, looks: bool
) -> None:
    cache = FileCache(tmp_path, 1000)
    cache._make_room(0)  # the first one looks at what is there
    (tmp_path / "large").write_bytes(b"x" * 2000)
    cache.get("small", lambda: b"x" * added)
    assert (tmp_path / "large").exists() is not looks


def test_a_file_that_somebody_else_removes_meanwhile_is_no_fault(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = FileCache(tmp_path, 1000)
    paths = filled(cache, tmp_path, 500, 500)
    listed = [*tmp_path.iterdir(), tmp_path / "gone"]
    monkeypatch.setattr(Path, "iterdir", lambda path: iter(listed))
    cache._make_room(1000)
    assert [path.exists() for path in paths] == [False, True]


def test_what_was_made_of_an_original_is_forgotten_and_nothing_else(tmp_path: Path) -> None:
    cache = FileCache(tmp_path, 1000)
    for name in ("abc-256.jpeg", "abc.png", "abd-256.jpeg"):
        cache.get(name, lambda: b"x")
    cache.forget("abc")
    assert [path.name for path in tmp_path.iterdir()] == ["abd-256.jpeg"]


def test_a_file_that_is_asked_for_again_keeps_its_date_and_is_used_by_then(tmp_path: Path) -> None:
    """Its date goes out as `Last-Modified`; what was used long ago goes first."""
    cache = FileCache(tmp_path, 100)
    path = cache.get("old", lambda: b"0" * 40)
    other = cache.get("other", lambda: b"1" * 40)
    for file in (path, other):
        os.utime(file, (1_000_000, 1_000_000))
    for read in (cache.get("old", lambda: b""), cache.file("old", lambda target: None)):
        assert read.stat().st_mtime == 1_000_000
    cache.get("new", lambda: b"2" * 40)
    assert path.exists()
    assert not other.exists()


def test_making_room_leaves_what_is_being_written(tmp_path: Path) -> None:
    """However long ago its last byte came: whoever writes it moves it to its name afterwards."""
    cache, begun, go_on = FileCache(tmp_path, 100), Event(), Event()

    def slow(path: Path) -> None:
        path.write_bytes(b"0" * 60)
        os.utime(path, (1_000_000, path.stat().st_mtime))
        begun.set()
        go_on.wait(PATIENCE)

    with ThreadPoolExecutor(1) as pool:
        film = pool.submit(cache.file, "film.mp4", slow)
        assert begun.wait(PATIENCE)
        for number in range(4):
            cache.get(f"{number}", lambda: b"1" * 40)
        go_on.set()
        assert film.result(PATIENCE).stat().st_size == 60


def test_what_a_killed_process_left_half_written_goes_when_room_is_made(tmp_path: Path) -> None:
    left = tmp_path / ".left"
    left.write_bytes(b"0" * 200)
    os.utime(left, (1_000_000, 1_000_000))
    FileCache(tmp_path, 100).get("new", lambda: b"1" * 40)
    assert not left.exists()


def test_a_directory_that_is_removed_meanwhile_is_made_again(tmp_path: Path) -> None:
    """Which one may do at any time, says the documentation."""
    cache, times = FileCache(tmp_path / "cache", 100), []

    def write(path: Path) -> None:
        path.write_bytes(b"film")
        if not times:
            shutil.rmtree(path.parent)
        times.append(path)

    assert cache.file("film.mp4", write).read_bytes() == b"film"
    shutil.rmtree(tmp_path / "cache")
    cache._make_room(100)


def test_many_that_write_remove_and_make_room_at_once_hinder_nobody(tmp_path: Path) -> None:
    cache = FileCache(tmp_path, 2000)

    def work(thread: int) -> None:
        for number in range(200):
            cache.get(f"{thread}-{number % 20}", lambda: b"0" * 150)
            if number % 5 == 0:
                cache.forget(f"{(thread + 1) % 4}-")

    with ThreadPoolExecutor(4) as pool:
        for done in [pool.submit(work, thread) for thread in range(4)]:
            done.result(PATIENCE)

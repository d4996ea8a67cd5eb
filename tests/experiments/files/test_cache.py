"""Files that can be made again."""

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

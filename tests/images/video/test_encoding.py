"""Several encoders at work at once: all get every frame, and none outlives its video."""

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.images.video.encoding import WAITING, Encoding
from app.images.video.reader import read_video
from app.images.video.writers import VideoWriter
from tests.images.video.natural import natural_video


class FakeWriter:
    """Takes a frame when it is told to."""

    def __init__(self, path: Path, error: Exception | None = None) -> None:
        self.path, self.error = path, error
        self.open = threading.Event()
        self.taken = 0
        self.closed = False

    def write(self, frame: np.ndarray) -> None:
        assert self.open.wait(60)
        if self.error is not None:
            raise self.error
        self.taken += 1

    def finish(self) -> None:
        assert self.open.wait(60)

    def close(self) -> None:
        self.closed = True


FRAME = np.zeros((4, 4, 3), np.uint8)


def encode(writers: list[Any], frames: int, progress: Callable[[float], None] = lambda part: None) -> None:
    with Encoding(writers) as encoding:
        for _ in range(frames):
            encoding.write(FRAME)
        encoding.finish(progress)


def encoders() -> list[str]:
    return [thread.name for thread in threading.enumerate() if thread.name.startswith("encode")]


def test_every_writer_gets_every_frame(tmp_path):
    film = natural_video(9, 32, 48)
    writers = [
        VideoWriter(tmp_path / name, "webm", width=48, height=32, channels=3, count=9, rate=24.0) for name in "ab"
    ]
    parts = []
    with Encoding(writers) as encoding:
        for frame in film:
            encoding.write(frame)
        encoding.finish(parts.append)
    assert all((np.stack(list(read_video(tmp_path / name))) == film).all() for name in "ab")
    assert parts == sorted(parts)
    assert parts[-1] == 1
    assert encoders() == []


def test_few_frames_wait_for_an_encoder(tmp_path):
    """So memory is bounded: whoever makes frames faster than they are encoded waits."""
    slow: Any = FakeWriter(tmp_path / "slow")
    with Encoding([slow]) as encoding:
        for _ in range(WAITING + 1):
            encoding.write(FRAME)
        maker = threading.Thread(target=encoding.write, args=(FRAME,))
        maker.start()
        maker.join(0.05)
        assert maker.is_alive()
        slow.open.set()
        maker.join(60)
        assert not maker.is_alive()
        encoding.finish(lambda part: None)
    assert slow.taken == WAITING + 2


def test_progress_is_asked_for_while_encoders_finish_and_may_stop_them(tmp_path):
    slow = FakeWriter(tmp_path / "slow")
    calls = []

    def progress(part: float) -> None:
        calls.append(part)
        if len(calls) == 3:
            slow.open.set()
            raise InterruptedError

    with pytest.raises(InterruptedError):
        encode([slow], 1, progress)
    assert calls == [0, 0, 0]
    assert slow.closed
    assert encoders() == []


def test_the_error_of_an_encoder_is_raised_where_frames_are_made(tmp_path):
    full, other = FakeWriter(tmp_path / "full", OSError("No space left on device")), FakeWriter(tmp_path / "other")
    full.open.set()
    other.open.set()
    with pytest.raises(OSError, match="No space left"):
        encode([other, full], WAITING + 2)
    assert full.closed
    assert other.closed
    assert encoders() == []

"""Stored uploads: a PNG of the pixels alone, in strips small enough for a crop; a video's frames in their order."""

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import imagecodecs
import numpy as np
import pytest
from numpy.typing import NDArray

from app.images.decode import Decoded, Limits
from app.images.formats.clip import ClipStream, TimedFrame
from app.images.intake import store as module
from app.images.intake.store import STRIP_PIXELS, STRIP_ROWS, encode_picture, store
from app.images.media import Media
from app.images.png_writer import STRIP_ENTRY, STRIP_TABLE

Noise = Callable[..., NDArray[Any]]


def strip_rows(png: bytes) -> list[int]:
    """Rows of each strip, by the file's own list."""
    at = png.index(STRIP_TABLE) + 4
    length = int.from_bytes(png[at - 8 : at - 4], "big")
    return [rows for rows, _, _ in STRIP_ENTRY.iter_unpack(png[at : at + length])]


@pytest.mark.parametrize("alpha", [False, True])
@pytest.mark.parametrize(("channels", "dtype"), [(1, np.uint8), (3, np.uint8), (1, np.uint16), (3, np.uint16)])
def test_a_picture_is_stored_as_it_is(noise: Noise, channels: int, dtype: type, alpha: bool) -> None:
    pixels = noise(150, 70, channels, dtype=dtype)
    opacity = noise(150, 70, dtype=dtype, seed=1) if alpha else None
    stored = imagecodecs.png_decode(encode_picture(Decoded.still(pixels, opacity))).reshape(150, 70, -1)
    assert stored.dtype == dtype
    np.testing.assert_array_equal(stored[..., :channels], pixels)
    assert stored.shape[2] == channels + alpha
    if opacity is not None:
        np.testing.assert_array_equal(stored[..., -1], opacity)


@pytest.mark.parametrize(
    ("width", "rows"), [(1, STRIP_PIXELS), (16, STRIP_PIXELS // 16), (1024, STRIP_ROWS), (3000, STRIP_ROWS)]
)
def test_strips_are_small_but_not_lower_than_a_crop_is_worth(width: int, rows: int) -> None:
    height = rows + rows // 2
    png = encode_picture(Decoded.still(np.zeros((height, width, 1), np.uint8), None))
    assert strip_rows(png) == [rows, rows // 2]


def clip_of(frames: NDArray[np.uint8], times: list[float], media_type: str = "video/mp4") -> ClipStream:
    def yielding() -> Iterator[TimedFrame]:
        yield from map(TimedFrame, frames, times)

    return ClipStream(frames.shape[2], frames.shape[1], frames.shape[3], media_type, yielding())


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
@pytest.mark.parametrize("count", [1, 2, 11])
def test_the_frames_of_a_clip_are_stored_one_below_the_other(
    tmp_path: Path, noise: Noise, monkeypatch: pytest.MonkeyPatch, channels: int, count: int
) -> None:
    """However many may wait for a thread: more frames than that come in their order, too."""
    frames = noise(count, 70, 1100, channels)  # two strips each
    monkeypatch.setattr(module, "read", lambda path, limits: clip_of(frames, [index / 8 for index in range(count)]))
    found = store(tmp_path / "upload", tmp_path / "stack.png", Limits())
    assert found == Media(
        1100,
        70,
        1 if channels < 3 else 3,
        8,
        channels % 2 == 0,
        count,
        8.0 if count > 1 else 0.0,
        "video/mp4" if count > 1 else "image/png",
    )
    data = (tmp_path / "stack.png").read_bytes()
    np.testing.assert_array_equal(
        imagecodecs.png_decode(data).reshape(-1, 1100, channels), frames.reshape(-1, 1100, channels)
    )
    assert strip_rows(data) == [64, 6] * count


class Crowded(ThreadPoolExecutor):
    """A pool on a machine without memory for the stack of a thread."""

    def submit(self, *args: Any, **kwargs: Any) -> Future[Any]:
        raise RuntimeError("can't start new thread")


def test_no_memory_for_a_thread_is_no_memory(tmp_path: Path, noise: Noise, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is told as such, and not as damage of the file."""
    monkeypatch.setattr(module, "read", lambda path, limits: clip_of(noise(3, 8, 8, 3), [0.0, 0.1, 0.2]))
    monkeypatch.setattr(module, "ThreadPoolExecutor", Crowded)
    with pytest.raises(MemoryError):
        store(tmp_path / "upload", tmp_path / "stack.png", Limits())
    assert not (tmp_path / "stack.png").exists()


def test_what_goes_wrong_in_a_thread_ends_the_storing(
    tmp_path: Path, noise: Noise, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*args: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(module, "read", lambda path, limits: clip_of(noise(2, 8, 8, 3), [0.0, 0.1]))
    monkeypatch.setattr(module, "_write", refuse)
    with pytest.raises(ZeroDivisionError):
        store(tmp_path / "upload", tmp_path / "stack.png", Limits())
    assert not (tmp_path / "stack.png").exists()


def test_only_a_few_frames_are_in_memory_at_a_time(
    tmp_path: Path, noise: Noise, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A frame is decoded only once the writing of an earlier one was waited for."""
    frames, taken, written = noise(40, 8, 8, 3), [], []

    class Lazy(Future[None]):
        """What is submitted is done when somebody waits for it, and not before."""

        def __init__(self, work: Callable[[], None]) -> None:
            super().__init__()
            self._work = work

        def result(self, timeout: float | None = None) -> None:
            self._work()
            written.append(1)

    class Pool(ThreadPoolExecutor):
        def submit(self, function: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
            return Lazy(lambda: function(*args, **kwargs))

    def yielding() -> Iterator[TimedFrame]:
        for index, frame in enumerate(frames):
            taken.append(index)
            assert len(taken) - len(written) <= module.WAITING + 1
            yield TimedFrame(frame, index / 8)

    monkeypatch.setattr(module, "ThreadPoolExecutor", Pool)
    monkeypatch.setattr(module, "read", lambda path, limits: ClipStream(8, 8, 3, "video/mp4", yielding()))
    assert store(tmp_path / "upload", tmp_path / "stack.png", Limits()).frames == len(written) == 40

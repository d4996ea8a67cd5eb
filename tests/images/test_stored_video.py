"""Stored videos: any rectangle of any frame comes out of the stack as it went in."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from app.errors import InvalidInputError
from app.images.crop import Frames, Rectangle
from app.images.png_writer import encode_png
from app.images.stored_video import frames_have_transparency, locate_crop, read_frame, read_frames

Noise = Callable[..., NDArray[Any]]
FRAMES, HEIGHT, WIDTH = 7, 30, 41


@pytest.fixture(params=[1, 2, 3, 4])
def video(request: pytest.FixtureRequest, noise: Noise) -> NDArray[np.uint8]:
    """Noise, (T, H, W, C), which is opaque but for one pixel of frame 4."""
    frames: NDArray[np.uint8] = noise(FRAMES, HEIGHT, WIDTH, request.param)
    if request.param % 2 == 0:
        frames[..., -1] = 255
        frames[4, 20, 10, -1] = 77
    return frames


@pytest.fixture
def path(tmp_path: Path, video: NDArray[np.uint8]) -> Path:
    (tmp_path / "stack.png").write_bytes(encode_png(video.reshape(-1, WIDTH, video.shape[3])))
    return tmp_path / "stack.png"


def colours(video: NDArray[np.uint8]) -> NDArray[np.uint8]:
    return video[..., : 1 if video.shape[3] < 3 else 3]


@pytest.mark.parametrize("frames", ["0,7", "0,1", "6,1", "2,2", "5,2"])
@pytest.mark.parametrize("crop", ["0,0,41,30", "40,29,1,1", "5,6,20,10"])
def test_a_crop_of_some_frames_is_what_was_stored(path: Path, video: NDArray[np.uint8], crop: str, frames: str) -> None:
    area, span = Rectangle.parse(crop), Frames.parse(frames)
    holds = span.first <= 4 < span.first + span.count and crop == "0,0,41,30"
    if holds and video.shape[3] % 2 == 0:
        with pytest.raises(InvalidInputError, match="transparent pixels"):
            read_frames(path, area, span, HEIGHT)
        return
    found = read_frames(path, area, span, HEIGHT)
    expected = colours(video)[span.first : span.first + span.count]
    assert found.dtype == np.uint8
    np.testing.assert_array_equal(found, expected[:, area.y : area.y + area.height, area.x : area.x + area.width])


@pytest.mark.parametrize("frame", [0, 4, 6])
def test_a_whole_frame_keeps_its_alpha(path: Path, video: NDArray[np.uint8], frame: int) -> None:
    np.testing.assert_array_equal(read_frame(path, frame, WIDTH, HEIGHT), video[frame])


@pytest.mark.parametrize(
    ("crop", "frames", "holds"),
    [
        ("0,0,41,30", "0,7", True),
        ("10,20,1,1", "4,1", True),
        ("10,20,1,1", "3,2", True),
        ("10,20,1,1", "4,3", True),
        ("10,20,1,1", "0,4", False),  # before it
        ("10,20,1,1", "5,2", False),  # after it
        ("11,20,5,5", "0,7", False),
        ("0,21,41,9", "0,7", False),
        ("0,0,41,20", "0,7", False),
    ],
)
def test_transparency_counts_in_the_frames_and_the_crop_alone(
    path: Path, video: NDArray[np.uint8], crop: str, frames: str, holds: bool
) -> None:
    found = frames_have_transparency(path, Rectangle.parse(crop), Frames.parse(frames), HEIGHT)
    assert found == (holds and video.shape[3] % 2 == 0)


def test_frames_that_were_never_stored_are_refused(path: Path) -> None:
    with pytest.raises(InvalidInputError, match="reaches outside"):
        read_frames(path, Rectangle(0, 0, 5, 5), Frames(5, 3), HEIGHT)
    with pytest.raises(InvalidInputError, match="reaches outside"):
        read_frame(path, FRAMES, WIDTH, HEIGHT)


def test_a_frame_begins_where_the_one_before_ends() -> None:
    assert [locate_crop(Rectangle(3, 4, 5, 6), frame, 100).y for frame in range(3)] == [4, 104, 204]
    assert locate_crop(Rectangle(3, 4, 5, 6), 2, 100) == Rectangle(3, 204, 5, 6)

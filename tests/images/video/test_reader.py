"""Reader of video files: every frame in its order and its size, grey as one channel."""

from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from app.images.video.reader import read_first_frame, read_video
from app.images.video.writers import Kind, write_video
from tests.images.video.natural import natural_video


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize(("height", "width"), [(40, 60), (41, 61), (1, 7), (7, 1)])
def test_a_webm_gives_back_its_frames(tmp_path: Path, height: int, width: int, channels: int) -> None:
    video = np.random.default_rng(2).integers(0, 256, (5, height, width, channels), dtype=np.uint8)
    write_video(iter(video), tmp_path / "video", "webm", count=5, rate=10.0)
    found = list(read_video(tmp_path / "video"))
    assert all(frame.dtype == np.uint8 for frame in found)
    np.testing.assert_array_equal(np.stack(found), video)
    np.testing.assert_array_equal(read_first_frame(tmp_path / "video"), video[0])


@pytest.mark.parametrize("kind", ["mp4", "webm"])
def test_a_lossy_file_has_three_channels_within_a_few_levels(tmp_path: Path, kind: Kind) -> None:
    """Not a level darker or lighter on the average: chroma is interpolated between its places."""
    video = natural_video(6, 48, 64)
    write_video(iter(video), tmp_path / "video", kind, count=6, rate=10.0)
    found = np.stack(list(read_video(tmp_path / "video"))).astype(int)
    assert found.shape == video.shape
    assert abs(found.mean((0, 1, 2)) - video.mean((0, 1, 2))).max() < 0.6
    assert abs(found - video).mean() < 6


def test_frames_are_read_one_by_one_and_may_be_kept(tmp_path: Path) -> None:
    """A frame that was read is not overwritten by the next."""
    video = np.random.default_rng(3).integers(0, 256, (4, 20, 30, 1), dtype=np.uint8)
    write_video(iter(video), tmp_path / "video", "webm", count=4, rate=10.0)
    frames = read_video(tmp_path / "video")
    kept = list(islice(frames, 2))
    np.testing.assert_array_equal(np.stack([*kept, *frames]), video)

"""Videos on the command line: a clip in, one file out, exact where it can be."""

from pathlib import Path

import numpy as np
import pytest

from app.images.video.reader import read_video
from app.images.video.writers import write_video
from tests.command_line import CHINA, synthesize


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    path = tmp_path / "clip.webm"
    film = np.random.default_rng(5).integers(0, 256, (10, 40, 48, 3), dtype=np.uint8)
    write_video(film, path, "webm", count=len(film), rate=10.0)
    return path


@pytest.mark.parametrize("suffix", [".webm", ".mp4"])
def test_a_crop_of_some_frames_becomes_a_video_of_the_asked_size_and_length(clip: Path, suffix: str) -> None:
    out = clip.with_name(f"texture{suffix}")
    options = ("--crop", "4,4,32,24", "--time", "2,6", "--size", "x2", "--frames", "9")
    done = synthesize(clip, out, "--method", "video-rpn", *options)
    assert done.exit_code == 0, done.output
    assert "64 × 48 pixels, 9 frames, video-rpn, seed 0" in done.stdout
    frames = list(read_video(out))
    assert (len(frames), frames[0].shape) == (9, (48, 64, 3))


def test_a_still_method_takes_one_frame_of_a_clip(clip: Path) -> None:
    outs = [clip.with_name(f"texture-{frame}.png") for frame in (0, 3)]
    for frame, out in zip((0, 3), outs, strict=True):
        assert synthesize(clip, out, "--time", f"{frame},1").exit_code == 0
    assert outs[0].read_bytes() != outs[1].read_bytes()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            ("texture.png", "--method", "video-rpn"),
            "makes a video: the name of the file to write ends with one of .webm",
        ),
        (("texture.webm", "--method", "rpn"), "makes a picture"),
        (("texture.webm", "--method", "video-rpn", "--depth", "16"), "16 bits per channel"),
        (("texture.webm", "--method", "video-rpn", "--time", "9,3"), "reaches outside"),
        (("texture.webm", "--method", "video-rpn", "--time", "all"), "two whole numbers"),
        (
            ("texture.webm", "--method", "video-rpn", "--time", "0,2", "--time", "0,2"),
            "more time ranges (2) than files (1)",
        ),
    ],
)
def test_what_is_wrong_is_one_line_and_leaves_nothing(clip: Path, arguments: tuple[str, ...], words: str) -> None:
    out, *options = arguments
    done = synthesize(clip, clip.with_name(out), *options)
    assert done.exit_code == 2
    assert words in done.stderr
    assert done.stderr.count("\n") == 1
    assert [path.name for path in clip.parent.iterdir()] == [clip.name]


def test_a_photograph_is_no_clip(tmp_path: Path) -> None:
    done = synthesize(CHINA, tmp_path / "texture.webm", "--method", "video-rpn")
    assert (done.exit_code, list(tmp_path.iterdir())) == (2, [])
    assert "is a video, and this sample is a still picture" in done.stderr

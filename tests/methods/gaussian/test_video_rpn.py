"""Random phase noise of a video as the registry declares it: its files, its views, its memory."""

import tracemalloc

import numpy as np
import pytest
from imagecodecs import png_decode

from app.images.video.reader import read_video
from app.methods.context import Context
from app.methods.gaussian.video_rpn import VIDEO_RPN
from app.methods.model import Clip, Size, Source
from app.methods.output.videos import encoding_bytes
from app.synthesis.gaussian.video_rpn import VideoNoiseField, video_rpn
from app.synthesis.parallel import Team


def clip(frames=6, height=40, width=48, channels=3, still=False):
    rng = np.random.default_rng(1)
    grain = rng.integers(60, 160, (1 if still else frames, height, width, channels), np.uint8)
    return Source(grain[0].astype(np.float32), 255, Clip(np.repeat(grain, frames // len(grain), axis=0), 12.0))


def run(source, scratch, threads=2, **parameters):
    context = Context(8, threads, lambda stage, fraction: None, scratch)
    return {made.name: made for made in VIDEO_RPN.pictures([source], VIDEO_RPN.params(**parameters), context)}


def test_it_gives_the_videos_files_its_views_and_the_crop(tmp_path):
    made = run(clip(), tmp_path, frames=8, width=60, seed=3)
    assert list(made) == [
        "texture", "texture-mp4", "preview", "cube", "average", "spectrum", "spectrum-in-time",
        "crop", "crop-mp4", "crop-cube",
    ]  # fmt: skip
    assert [name for name, picture in made.items() if picture.kind == "texture"] == ["texture"]
    texture = made["texture"]
    assert (texture.width, texture.height, texture.frames, texture.rate) == (60, 40, 8, 12.0)
    assert (made["crop"].width, made["crop"].height, made["crop"].frames) == (48, 40, 6)
    assert png_decode(made["spectrum"].data).shape == (40, 60)
    assert png_decode(made["spectrum-in-time"].data).shape == (8, 60)
    assert set(tmp_path.iterdir()) == {picture.data for picture in made.values() if picture.frames > 1}


@pytest.mark.parametrize("channels", [1, 3])
def test_the_decoded_texture_is_the_noise_rounded(tmp_path, channels):
    source = clip(channels=channels)
    texture = run(source, tmp_path, seed=3)["texture"]
    decoded = np.stack(list(read_video(texture.data)))
    expected = np.clip(np.rint(video_rpn(source.clip.frames, seed=3)), 0, 255)
    assert (decoded == expected).all()


def test_the_average_is_the_crops_and_says_what_stands_still(tmp_path):
    """Of a clip that stands still, all; of an independent noise for every one of 6 frames, a sixth.

    A sixth is the mean over 40 × 48 / 2 frequencies of like energy: within a few hundredths of itself.
    """
    for still, expected in ((True, 100), (False, 100 / 6)):
        source = clip(still=still)
        average = run(source, tmp_path)["average"]
        shown = np.rint(source.clip.frames.mean(axis=0))
        assert np.abs(png_decode(average.data) - shown).max() <= 1
        assert average.facts[0].value == pytest.approx(expected, rel=0.1)


def test_a_clip_that_stands_still_gives_a_video_that_does(tmp_path):
    """A value half way between two levels may be rounded to either."""
    decoded = np.stack(list(read_video(run(clip(still=True), tmp_path, frames=9)["texture"].data))).astype(int)
    assert decoded[0].std() > 10
    assert np.abs(decoded - decoded[0]).max() <= 1


@pytest.mark.parametrize(
    ("film", "texture"),
    [
        ((24, 128, 128, 3), (24, 128, 128)),
        ((20, 80, 96, 3), (40, 120, 160)),
        ((30, 128, 160, 1), (30, 128, 160)),
        ((30, 160, 128, 3), (20, 80, 96)),
        ((200, 16, 300, 3), (200, 16, 300)),
    ],
)
def test_the_memory_that_it_declares_is_what_it_takes_at_most_and_not_far_above(film, texture):
    """What the encoders need beside arrays is declared by `encoding_bytes` and not seen here."""
    frames = np.random.default_rng(0).integers(0, 256, film, np.uint8)
    tracemalloc.start()
    try:
        with Team(2) as team:
            options = {"seed": 1, "alpha": 0.1, "profile": "bump", "progress": lambda stage, part: None}
            for _ in VideoNoiseField(frames, texture, team=team, **options).frames():
                pass
        peak = tracemalloc.get_traced_memory()[1] + frames.nbytes
    finally:
        tracemalloc.stop()
    params = VIDEO_RPN.params(frames=texture[0], height=texture[1], width=texture[2])
    width, height = max(film[2], texture[2]), max(film[1], texture[1])
    declared = VIDEO_RPN.memory_of([Size(film[2], film[1], film[3], film[0])], params)
    assert 0.4 < peak / (declared - encoding_bytes(width, height, film[3])) < 1


def test_the_memory_of_the_clips_own_size_is_that_of_no_size_asked_for():
    size = Size(64, 48, 3, 10)
    asked = VIDEO_RPN.params(width=64, height=48, frames=10)
    assert VIDEO_RPN.memory_of([size], VIDEO_RPN.params()) == VIDEO_RPN.memory_of([size], asked)
    assert VIDEO_RPN.memory_of([size], VIDEO_RPN.params(frames=20)) > VIDEO_RPN.memory_of([size], asked)


def test_there_is_no_switch_for_what_it_does_by_nature():
    assert list(VIDEO_RPN.params.model_fields) == ["width", "height", "seed", "frames", "alpha", "window"]
    assert VIDEO_RPN.moving
    assert VIDEO_RPN.toroidal(VIDEO_RPN.params())

"""The video patchwork as the registry declares it: refusals, views, memory."""

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.errors import InvalidInputError
from app.images.video.reader import read_video
from app.methods.model import Clip, Size
from app.methods.output.videos import encoding_bytes
from app.methods.patchwork.video_patchwork import VIDEO_PATCHWORK
from tests.methods.runs import a_clip, run_small

ARRANGED = pytest.mark.parametrize("arrangement", ["fixed", "mosaic"])


def a_still_clip():
    """A clip whose frames are all the first."""
    source = a_clip()
    assert source.clip is not None
    return replace(source, clip=Clip(np.repeat(source.clip.frames[:1], 12, 0), 12.0))


def texture(source, scratch, **parameters):
    made = next(run_small(VIDEO_PATCHWORK, [source], scratch=scratch, **parameters))
    assert isinstance(made.data, Path)
    return np.stack(list(read_video(made.data)))


def test_only_the_fixed_arrangement_leaves_a_still_clip_still(tmp_path):
    fixed = texture(a_still_clip(), tmp_path)
    assert (fixed == fixed[0]).all()
    mosaic = texture(a_still_clip(), tmp_path, arrangement="mosaic", interval=3)
    assert np.abs(np.diff(mosaic.astype(int), axis=0)).mean() > 1


@ARRANGED
def test_its_views_are_the_cells_over_time_and_the_average_image(arrangement, tmp_path):
    interval = {"fixed": 4, "mosaic": 3}[arrangement]
    made = run_small(VIDEO_PATCHWORK, [a_clip()], scratch=tmp_path, arrangement=arrangement, interval=interval)
    pictures = {picture.name: picture for picture in made}
    assert list(pictures)[3:] == ["cube", "cells", "average", "crop", "crop-mp4", "crop-cube"]
    assert (pictures["cells"].width, pictures["cells"].height) == (pictures["cube"].width, pictures["cube"].height)
    assert (pictures["average"].width, pictures["average"].height) == (64, 48)


@ARRANGED
def test_a_crop_that_is_too_small_is_refused_with_the_largest_grid_that_fits(arrangement):
    sizes, asked = [Size(100, 90, 3, 72)], {"width": 300, "height": 200, "frames": 72, "arrangement": arrangement}
    with pytest.raises(InvalidInputError, match="a grid of at most") as refusal:
        VIDEO_PATCHWORK.resolve(sizes, VIDEO_PATCHWORK.params(**asked))
    assert refusal.value.field == "parameters.grid"
    largest = int(refusal.value.message.split("at most ")[1].split(",")[0])
    VIDEO_PATCHWORK.resolve(sizes, VIDEO_PATCHWORK.params(grid=largest, **asked))
    with pytest.raises(InvalidInputError, match=f"^Patches of grid {largest + 1} need"):
        VIDEO_PATCHWORK.resolve(sizes, VIDEO_PATCHWORK.params(grid=largest + 1, **asked))


@ARRANGED
@pytest.mark.parametrize("loop", [True, False])
def test_a_clip_that_is_too_short_is_refused_with_the_longest_interval_that_fits(arrangement, loop):
    sizes, asked = [Size(400, 400, 3, 24)], {"frames": 100, "arrangement": arrangement, "loop": loop}
    with pytest.raises(InvalidInputError, match="an interval of at most") as refusal:
        VIDEO_PATCHWORK.resolve(sizes, VIDEO_PATCHWORK.params(**asked))
    assert refusal.value.field == "parameters.interval"
    longest = int(refusal.value.message.split("at most ")[1].split(",")[0])
    VIDEO_PATCHWORK.resolve(sizes, VIDEO_PATCHWORK.params(interval=longest, **asked))
    with pytest.raises(InvalidInputError, match=f"an interval of at most {longest}, or"):
        VIDEO_PATCHWORK.resolve(sizes, VIDEO_PATCHWORK.params(interval=longest + 1, **asked))


@pytest.mark.slow
@ARRANGED
def test_its_defaults_suit_a_clip_of_three_seconds(arrangement):
    VIDEO_PATCHWORK.resolve([Size(256, 256, 3, 72)], VIDEO_PATCHWORK.params(arrangement=arrangement))


@pytest.mark.slow
@ARRANGED
@pytest.mark.parametrize("sharpness", [1, 3, 6])
def test_the_memory_it_asks_for_covers_what_it_takes(arrangement, sharpness, tmp_path, monkeypatch):
    """Without the encoders, whose need is said by `encoding_bytes`. The clip is there before, and is asked for too."""
    monkeypatch.setattr(
        "app.methods.patchwork.pictures.encode_texture", lambda frames, **shape: iter([list(frames)][1:])
    )
    source = a_clip(height=150, width=160, frames=24)
    params = {"width": 200, "height": 220, "frames": 4, "grid": 20, "interval": 6, "arrangement": arrangement}
    params["sharpness"] = sharpness
    asked = VIDEO_PATCHWORK.memory_of([source.size], VIDEO_PATCHWORK.params(**params)) - encoding_bytes(200, 220, 3)
    tracemalloc.start()
    try:
        assert next(run_small(VIDEO_PATCHWORK, [source], scratch=tmp_path, **params)).name == "cells"
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    film = 24 * 150 * 160 * 3
    assert asked / 6 < peak + film < asked

"""The video transfer as the registry declares it: the pattern's size and colours, refusals, pictures."""

from pathlib import Path

import numpy as np
import pytest
from imagecodecs import png_decode

from app.errors import InvalidInputError
from app.images.video.reader import read_video
from app.methods.model import Clip, Size, Source
from app.methods.patchwork.transfer import TRANSFER
from app.methods.patchwork.video_transfer import VIDEO_TRANSFER
from tests.methods.runs import a_clip, a_crop, run_small


def texture(sources, scratch, **parameters):
    made = next(run_small(VIDEO_TRANSFER, sources, scratch=scratch, **parameters))
    assert isinstance(made.data, Path)
    return np.stack(list(read_video(made.data)))


def halves():
    """A clip that is dark on its left and bright on its right, with grain that is new in every frame."""
    rng = np.random.default_rng(1)
    levels = np.where(np.arange(96) < 48, 80, 160)[None, None, :, None]
    film = (levels + rng.integers(-30, 31, (12, 60, 96, 3))).astype(np.uint8)
    return Source(film[0].astype(np.float32), 255, Clip(film, 12.0))


def test_light_and_dark_are_where_the_pattern_has_them_in_every_frame(tmp_path):
    """Means of 14 rows of 32 pixels of grain of deviation 18 are known to 1; the halves of the clip differ by 80."""
    pattern = np.repeat(np.where(np.arange(40) < 20, 255, 0)[:, None, None], 32, 1).astype(np.float32)
    film = texture([halves(), Source(pattern, 255)], tmp_path, candidates=0).astype(float)
    assert film.shape == (12, 40, 32, 3)
    for frame in film:
        assert frame[:14].mean() - frame[26:].mean() > 60
    assert np.sqrt(film.var(0).mean()) > 12


def test_what_the_picture_shows_besides(tmp_path):
    pictures = {made.name: made for made in run_small(VIDEO_TRANSFER, [a_clip(), a_crop(50, 40)], scratch=tmp_path)}
    views = ["cube", "cells", "average", "pattern", "crop", "crop-mp4", "crop-cube", "crop-2"]
    assert list(pictures) == ["texture", "texture-mp4", "preview", *views]
    assert (png_decode(pictures["crop-2"].data) == a_crop(50, 40).pixels).all()


def test_the_patterns_colours_are_rescaled_unless_that_is_switched_off(tmp_path):
    """Grain of deviation 18 at levels of 80 and 160 has nothing as dark as a pattern of 0 and 40: unscaled, all of it
    is taken from the dark half; rescaled, half of it from the bright one.
    """
    dark = np.repeat(np.where(np.arange(40) < 20, 40, 0)[:, None, None], 32, 1).astype(np.float32)
    pattern = Source(np.repeat(dark, 3, axis=2), 255)
    means = {}
    for rescale in (True, False):
        made = {
            picture.name: picture
            for picture in run_small(
                VIDEO_TRANSFER, [halves(), pattern], scratch=tmp_path, candidates=0, rescale=rescale
            )
        }
        film = np.stack(list(read_video(made["texture"].data))).astype(float)
        means[rescale] = film[:, :14].mean(), film[:, 26:].mean()
        compared = png_decode(made["pattern"].data)
        if rescale:
            assert compared.mean() == pytest.approx(png_decode(made["average"].data).mean(), abs=1)
        else:
            assert (compared == pattern.pixels).all()
    assert means[True][0] - means[True][1] > 60
    assert max(means[False]) < 100


def test_a_pattern_of_sixteen_bits_is_the_same_pattern(tmp_path):
    eight = a_crop(40, 40)
    deep = Source(eight.pixels * 257, 65535)
    one, other = (texture([a_clip(), pattern], tmp_path, rescale=False) for pattern in (eight, deep))
    assert (one == other).all()


def test_the_switch_is_that_of_the_transfer_of_pictures():
    declared = [each.params.model_fields["rescale"] for each in (TRANSFER, VIDEO_TRANSFER)]
    assert len({(field.title, field.description, field.default) for field in declared}) == 1


@pytest.mark.parametrize(("clip", "pattern"), [(1, 3), (3, 1)], ids=["grey clip", "grey pattern"])
def test_a_clip_in_grey_makes_grey_and_one_in_colour_takes_a_grey_pattern(clip, pattern, tmp_path):
    film = texture([a_clip(channels=clip), a_crop(40, 40, channels=pattern)], tmp_path)
    assert (film == film[..., :1]).all() == (clip == 1)


def test_another_size_than_the_patterns_is_refused():
    with pytest.raises(InvalidInputError, match=r"pattern's size \(100 × 80\); remove the height 90") as refusal:
        VIDEO_TRANSFER.resolve([Size(320, 320, 3, 72), Size(100, 80, 3)], VIDEO_TRANSFER.params(width=100, height=90))
    assert refusal.value.field == "parameters.height"


def test_a_clip_that_is_too_small_or_too_short_is_refused():
    for size, field in ((Size(40, 300, 3, 72), "grid"), (Size(300, 300, 3, 20), "interval")):
        with pytest.raises(InvalidInputError, match="at most") as refusal:
            VIDEO_TRANSFER.resolve([size, Size(100, 80, 3)], VIDEO_TRANSFER.params(frames=72))
        assert refusal.value.field == f"parameters.{field}"


def test_it_can_loop_and_does_not_claim_to_tile():
    assert "loop" in VIDEO_TRANSFER.params.model_fields
    assert "tileable" not in VIDEO_TRANSFER.params.model_fields
    assert not VIDEO_TRANSFER.toroidal(VIDEO_TRANSFER.params())

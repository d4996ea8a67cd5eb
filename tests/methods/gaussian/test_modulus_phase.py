"""The swap of modulus and phase as the registry declares it: sizes, refusals and pictures."""

import numpy as np
import pytest
from imagecodecs import png_decode

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.gaussian.modulus_phase import MODULUS_PHASE
from app.methods.model import Size, Source
from app.synthesis.gaussian.modulus_phase import swap


def crop(height=40, width=50, channels=3, peak=255, seed=0):
    """Values in the middle of the range, so that hardly any is cut off."""
    values = np.random.default_rng(seed).uniform(0.4, 0.6, (height, width, channels))
    return Source(np.round(values * peak).astype(np.float32), peak)


def run(sources, depth=8, **parameters):
    context = Context(depth, 2, lambda stage, fraction: None)
    return {made.name: made for made in MODULUS_PHASE.pictures(sources, MODULUS_PHASE.params(**parameters), context)}


def pixels(picture):
    return png_decode(picture.data).astype(int)


def test_it_gives_both_swapped_pictures_the_crops_and_modulus_and_phase_of_each():
    made = run([crop(), crop(seed=1)])
    assert list(made) == ["texture", "other", "crop", "crop-2", "modulus", "phase", "modulus-2", "phase-2"]
    assert [name for name in made if made[name].kind == "texture"] == ["texture", "other"]
    for name in ("modulus", "phase", "modulus-2", "phase-2"):
        assert pixels(made[name]).shape == (40, 50)


def test_the_pictures_are_the_rounded_swaps():
    sources = crop(), crop(seed=1)
    made = run(sources)
    for name, expected in zip(("texture", "other"), swap(*(source.pixels for source in sources)), strict=True):
        assert np.abs(pixels(made[name]) - expected.clip(0, 255)).max() <= 0.51


def test_running_it_on_its_own_pictures_gives_the_crops_back_up_to_rounding():
    """16 bits round to 1/257 of a grey level, which spreads over weak frequencies: a level at most is far above it."""
    sources = crop(), crop(seed=1)
    made = run(sources, depth=16)
    again = run([Source(pixels(made[name]).astype(np.float32), 65535) for name in ("texture", "other")])
    for name, source in zip(("texture", "other"), sources, strict=True):
        assert np.abs(pixels(again[name]) - source.pixels).max() <= 1


def test_the_common_size_is_the_smaller_of_each_side_and_the_centre_is_taken():
    sources = crop(41, 50), crop(40, 61, seed=1)
    assert MODULUS_PHASE.size([Size(50, 41, 3), Size(61, 40, 3)]) == (50, 40)
    expected = swap(sources[0].pixels[0:40], sources[1].pixels[:, 5:55])[0]
    assert np.abs(pixels(run(sources)["texture"]) - expected.clip(0, 255)).max() <= 0.51
    assert pixels(run(sources, width=20, height=31)["other"]).shape == (31, 20, 3)


@pytest.mark.parametrize(
    ("asked", "field", "words"),
    [
        ({"width": 51}, "width", "^Choose a width of at most 50 pixels instead of 51, or larger crops"),
        ({"height": 41, "width": 50}, "height", "^Choose a height of at most 40 pixels instead of 41, or larger crops"),
    ],
)
def test_a_size_beyond_either_crop_is_refused_with_words_that_help(asked, field, words):
    with pytest.raises(InvalidInputError, match=words) as refusal:
        MODULUS_PHASE.resolve([Size(50, 90, 3), Size(70, 40, 3)], MODULUS_PHASE.params(**asked))
    assert refusal.value.field == f"parameters.{field}"


def test_a_grey_crop_counts_as_three_equal_channels():
    grey, colour = crop(channels=1), crop(seed=1)
    equal = Source(np.repeat(grey.pixels, 3, axis=2), 255)
    assert run([grey, colour])["texture"] == run([equal, colour])["texture"]
    assert run([colour, grey])["other"] == run([colour, equal])["other"]


def test_crops_of_8_and_of_16_bits_are_brought_to_one_range():
    coarse, other = crop(), crop(seed=1)
    deep = Source(other.pixels * 257, 65535)
    for sources in ([coarse, deep], [deep, coarse]):
        expected = run([coarse, other] if sources[0] is coarse else [other, coarse])
        made = run(sources)
        assert np.abs(pixels(made["texture"]) - pixels(expected["texture"])).max() <= 1


def test_the_seed_changes_nothing():
    sources = crop(), crop(seed=1)
    assert run(sources, seed=1) == run(sources, seed=2)


def test_it_does_not_promise_to_tile():
    assert not MODULUS_PHASE.toroidal(MODULUS_PHASE.params())

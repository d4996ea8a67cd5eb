"""`efros-leung` as the registry declares it: refusals with words that help, and pictures that say what was copied."""

import re

import numpy as np
import pytest
from imagecodecs import png_decode
from pydantic import ValidationError

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.model import Size, Source
from app.methods.sampling.efros_leung import EFROS_LEUNG, EfrosLeungParams
from app.synthesis.sampling.efros_leung import border_share, efros_leung, verbatim_share


def crop(height=24, width=30, channels=3, peak=255):
    rng = np.random.default_rng(0)
    coarse = np.kron(rng.integers(40, 200, (-(-height // 4), -(-width // 4), channels)), np.ones((4, 4, 1)))
    grain = rng.integers(0, 40, (height, width, channels))
    return Source((coarse[:height, :width] + grain).astype(np.float32) * (peak // 255), peak)


def pictures(source, *, depth=8, **parameters):
    run = EFROS_LEUNG.pictures(
        [source], EfrosLeungParams(**parameters), Context(depth, 2, lambda stage, fraction: None)
    )
    return {picture.name: picture for picture in run}


def refusal(size, **parameters):
    with pytest.raises(InvalidInputError) as refused:  # noqa: PT011 -- who calls this compares the words
        EFROS_LEUNG.resolve([size], EfrosLeungParams(**parameters))
    return refused.value


def test_the_defaults_are_those_of_the_articles():
    params = EfrosLeungParams()
    assert (params.half_patch, params.tolerance) == (4, 0.1)
    assert not EFROS_LEUNG.toroidal(params)


@pytest.mark.parametrize("wrong", [{"half_patch": 0}, {"half_patch": 12}, {"tolerance": -0.1}, {"tolerance": 1.1}])
def test_values_outside_what_is_declared_are_refused(wrong):
    with pytest.raises(ValidationError, match="1 validation error for EfrosLeungParams"):
        EfrosLeungParams(**wrong)


def test_a_crop_smaller_than_the_window_is_refused():
    EFROS_LEUNG.resolve([Size(9, 30, 3)], EfrosLeungParams())
    refused = refusal(Size(8, 30, 3))
    assert "9 × 9" in refused.message
    assert "8 × 30" in refused.message
    assert refused.field == "parameters.half_patch"


@pytest.mark.parametrize("size", [Size(96, 96, 3), Size(320, 320, 3), Size(400, 300, 1)])
@pytest.mark.parametrize("half_patch", [1, 4])
def test_the_sizes_that_a_refusal_names_are_accepted(size, half_patch):
    refused = refusal(size, width=4000, height=4000, half_patch=half_patch)
    assert refused.field == "parameters.width"
    texture = int(re.search(r"at most about (\d+) ×", refused.message)[1])
    EFROS_LEUNG.resolve([size], EfrosLeungParams(width=texture, height=texture, half_patch=half_patch))
    wider = {"width": 2 * texture, "height": 2 * texture, "half_patch": half_patch}
    smaller = int(re.search(r"crop at most about (\d+) ×", refusal(size, **wider).message)[1])
    assert smaller < max(size.width, size.height)
    EFROS_LEUNG.resolve([Size(smaller, smaller, size.channels)], EfrosLeungParams(**wider))


def test_a_crop_that_the_search_cannot_hold_is_refused_with_one_that_it_can():
    refused = refusal(Size(1024, 1024, 3), width=8, height=8)
    assert refused.field == "inputs.0.crop"
    most = int(re.search(r"it can be about (\d+) ×", refused.message)[1])
    EFROS_LEUNG.resolve([Size(most, most, 3)], EfrosLeungParams(width=8, height=8))


@pytest.mark.parametrize("side", [9, 96, 128, 256, 320])
@pytest.mark.parametrize("channels", [1, 3])
def test_the_size_by_default_is_the_crops_or_one_that_does_not_take_long(side, channels):
    size = Size(side, side, channels)
    width, height = EFROS_LEUNG.size([size])
    EFROS_LEUNG.resolve([size], EfrosLeungParams(width=width, height=height))
    assert (width, height) == (side, side) if side <= 128 else 64 <= width == height <= side
    wide = EFROS_LEUNG.size([Size(300, 200, 3)])
    assert wide[0] / wide[1] == pytest.approx(1.5, rel=0.02)


@pytest.mark.parametrize("channels", [1, 3])
def test_it_gives_the_texture_the_crop_the_maps_and_the_order(channels):
    source = crop(channels=channels)
    made = pictures(source, width=40, height=33, seed=2)
    assert list(made) == ["texture", "crop", "copy-map", "copy-map-key", "order"]
    assert [picture.kind for picture in made.values()] == ["texture", *["view"] * 4]
    grown = efros_leung(source.pixels, 33, 40, seed=2)
    pixels = {name: png_decode(picture.data) for name, picture in made.items()}
    assert (pixels["texture"] == grown.texture.reshape(pixels["texture"].shape)).all()
    assert (pixels["copy-map"] == pixels["copy-map-key"][grown.copied[:, :, 0], grown.copied[:, :, 1]]).all()
    assert pixels["copy-map-key"].shape == (24, 30, 3)
    assert len(np.unique(pixels["copy-map-key"].reshape(-1, 3), axis=0)) == 24 * 30
    by_time = pixels["order"].ravel()[np.argsort(grown.order.ravel())].astype(int)
    assert (np.diff(by_time) >= 0).all()
    assert (by_time[0], by_time[-1]) == (0, 255)


def test_how_much_is_verbatim_and_how_much_is_from_the_border_are_facts_of_the_texture():
    source = crop()
    facts = {fact.name: fact for fact in pictures(source, seed=1, half_patch=3)["texture"].facts}
    grown = efros_leung(source.pixels, half_patch=3, seed=1)
    assert {name: (fact.value, fact.unit) for name, fact in facts.items()} == {
        "verbatim": (verbatim_share(grown.copied), "%"),
        "border": (border_share(grown, 24, 30, 3), "%"),
    }
    assert 0 < facts["border"].value < 100


def test_every_colour_of_a_16_bit_texture_is_one_of_the_crop():
    source = crop(peak=65535)
    source.pixels[:, ::2] += 3  # values that 8 bits would not tell apart
    texture = png_decode(pictures(source, depth=16, width=37, height=37)["texture"].data)
    assert texture.dtype == np.uint16
    assert {*map(tuple, texture.reshape(-1, 3))} <= {*map(tuple, source.pixels.reshape(-1, 3).astype(int))}


def test_the_progress_goes_through_all_stages_without_going_back():
    seen = []
    context = Context(8, 1, lambda stage, fraction: seen.append((fraction, stage)))
    next(EFROS_LEUNG.pictures([crop()], EfrosLeungParams(width=90, height=60, half_patch=1), context))
    fractions = [fraction for fraction, _ in seen]
    assert fractions == sorted(fractions)
    assert {"order", "patches", "growth"} == {stage for _, stage in seen}
    assert sum(stage == "order" for _, stage in seen) > 1

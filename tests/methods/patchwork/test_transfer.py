"""Texture transfer as the registry declares it: pictures, facts and refusals."""

import numpy as np
import pytest
from imagecodecs import png_decode

from app.errors import InvalidInputError
from app.methods.model import Size, Source
from app.methods.patchwork.transfer import TRANSFER, TransferParams
from tests.methods.runs import a_crop, run_small


def made_of(texture, pattern, **parameters):
    given = {"grid": 8, "candidates": 20} | parameters
    return {made.name: made for made in run_small(TRANSFER, [texture, pattern], **given)}


def facts_of(*sources, **parameters):
    return {fact.name: fact.value for fact in made_of(*sources, **parameters)["texture"].facts}


def test_it_gives_the_texture_and_how_it_came_about_in_the_patterns_size():
    made = made_of(a_crop(), a_crop(50, 70, seed=1))
    assert list(made) == ["texture", "cells", "average", "pattern", "crop", "crop-2"]
    assert [name for name, picture in made.items() if picture.kind == "texture"] == ["texture"]
    for name in ("texture", "cells", "average", "pattern", "crop-2"):
        assert png_decode(made[name].data).shape == (50, 70, 3)
    assert png_decode(made["crop"].data).shape == (48, 64, 3)


def test_it_tells_how_well_the_patches_match_and_how_many_places_they_come_from():
    few, more = (facts_of(a_crop(), a_crop(seed=1), candidates=count) for count in (1, 100))
    assert few["cells"] == more["cells"] >= 48
    assert 0 < more["error"] < few["error"]
    assert 1 <= more["sources"] <= more["cells"]
    deep = [Source(source.pixels * 257, 65535) for source in (a_crop(), a_crop(seed=1))]
    assert facts_of(*deep, candidates=1)["error"] == pytest.approx(few["error"], rel=1e-6)


def test_a_pattern_cut_from_the_texture_comes_back_without_error_when_all_places_are_compared():
    texture = a_crop(80, 90)
    pattern = Source(texture.pixels[20:60, 16:70], 255)
    facts = facts_of(texture, pattern, candidates=0, rescale=False)
    assert facts["error"] == 0
    assert facts["sources"] == facts["cells"]


def test_the_patterns_colours_are_rescaled_unless_that_is_switched_off():
    texture, pattern = a_crop(), a_crop(seed=1)
    pattern = Source(np.round(pattern.pixels / 4), 255)
    plain = png_decode(made_of(texture, pattern, rescale=False)["pattern"].data)
    assert (plain == pattern.pixels).all()
    scaled = png_decode(made_of(texture, pattern)["pattern"].data)
    assert scaled.mean((0, 1)) == pytest.approx(texture.pixels.mean((0, 1)), abs=0.5)


@pytest.mark.parametrize("channels", [(1, 3), (3, 1)])
def test_grey_and_colour_go_together(channels):
    texture, pattern = (a_crop(channels=count, seed=seed) for seed, count in enumerate(channels))
    assert png_decode(made_of(texture, pattern)["texture"].data).shape == (48, 64, 3)


def test_inputs_of_eight_and_of_sixteen_bits_go_together():
    texture, pattern = a_crop(), a_crop(seed=1)
    deep = Source(pattern.pixels * 257, 65535)
    one, other = (png_decode(made_of(texture, kind)["texture"].data).astype(int) for kind in (pattern, deep))
    assert np.abs(one - other).max() <= 1


def test_its_size_is_the_patterns():
    sizes = [Size(200, 300, 3), Size(90, 80, 1)]
    assert TRANSFER.size(sizes) == (90, 80)
    TRANSFER.resolve(sizes, TransferParams(width=90, height=80))


@pytest.mark.parametrize(
    ("sizes", "parameters", "field", "words"),
    [
        ([Size(200, 300, 3), Size(90, 80, 1)], {"width": 91}, "width", r"size \(90 × 80\); remove the width 91"),
        ([Size(200, 300, 3), Size(90, 80, 1)], {"height": 300}, "height", "remove the height 300"),
        ([Size(60, 300, 3), Size(90, 80, 1)], {}, "grid", "at most 1[0-9]"),
        ([Size(9, 9, 3), Size(90, 80, 1)], {}, "grid", "larger crop"),
        ([Size(2000, 2000, 3), Size(2000, 2000, 3)], {"candidates": 0}, "candidates", r"at most [0-9,]+ candidates"),
        ([Size(4096, 4096, 3), Size(4096, 4096, 3)], {"candidates": 50_000}, "candidates", "at most"),
    ],
)
def test_what_cannot_run_is_refused_with_words_that_help(sizes, parameters, field, words):
    with pytest.raises(InvalidInputError, match=words) as refusal:
        TRANSFER.resolve(sizes, TransferParams(**parameters))
    assert refusal.value.field == f"parameters.{field}"


def test_the_grid_that_is_named_fits():
    sizes = [Size(60, 300, 3), Size(90, 80, 1)]
    with pytest.raises(InvalidInputError, match="take a grid of at most") as refusal:
        TRANSFER.resolve(sizes, TransferParams())
    largest = int(refusal.value.message.split("at most ")[1].split(",")[0])
    TRANSFER.resolve(sizes, TransferParams(grid=largest))
    with pytest.raises(InvalidInputError, match=f"^Patches of grid {largest + 1} need"):
        TRANSFER.resolve(sizes, TransferParams(grid=largest + 1))


def test_the_largest_pictures_run_with_what_is_proposed():
    """The defaults pass the check of time at the size of four kilopixels squared."""
    TRANSFER.resolve([Size(4096, 4096, 3)] * 2, TransferParams())
    assert TRANSFER.memory_of([Size(512, 512, 3)] * 2, TransferParams()) < 1 << 28

"""Patchwork as the registry declares it: refusals, pictures, memory."""

import numpy as np
import pytest
from imagecodecs import png_decode

from app.errors import InvalidInputError
from app.methods.model import Size
from app.methods.patchwork.patchwork import PATCHWORK
from tests.methods.runs import a_crop, run_small


def made(**parameters):
    return {picture.name: picture for picture in run_small(PATCHWORK, [a_crop(96, 110)], grid=16, seed=2, **parameters)}


def test_it_gives_the_texture_its_cells_and_where_their_sources_lie():
    pictures = made(width=80, height=70)
    assert list(pictures) == ["texture", "cells", "sources", "crop"]
    assert [name for name, picture in pictures.items() if picture.kind == "texture"] == ["texture"]
    sizes = {name: png_decode(picture.data).shape for name, picture in pictures.items()}
    assert sizes["texture"] == sizes["cells"] == (70, 80, 3)
    assert sizes["sources"] == sizes["crop"] == (96, 110, 3)
    assert pictures["texture"].facts[0].value == 5 * 5
    assert 20 < pictures["sources"].facts[0].value <= 100


def test_a_cell_wears_the_colour_of_its_source():
    """Where patches are cut sharply, every colour of the cells is one of the bright ones of the key."""
    pictures = made(blend="sharp")
    cells, key = (png_decode(pictures[name].data).reshape(-1, 3) for name in ("cells", "sources"))
    assert {tuple(colour) for colour in np.unique(cells, axis=0)} <= {tuple(colour) for colour in key}


def test_cells_are_softer_for_a_smaller_sharpness():
    steps = [np.abs(np.diff(png_decode(made(sharpness=f)["cells"].data).astype(int), axis=1)).max() for f in (2, 6, 20)]
    assert steps == sorted(steps)
    assert steps[0] < steps[2]


@pytest.mark.parametrize("sharpness", [1, 6, 20])
def test_a_crop_too_small_for_the_grid_is_refused_with_the_largest_grid_that_fits(sharpness):
    size = [Size(256, 200, 3)]
    asked = {"sharpness": sharpness, "width": 512, "height": 512}
    with pytest.raises(InvalidInputError, match="grid of at most") as refusal:
        PATCHWORK.resolve(size, PATCHWORK.params(grid=100, **asked))
    assert refusal.value.field == "parameters.grid"
    largest = int(refusal.value.message.split("at most ")[1].split(",")[0])
    PATCHWORK.resolve(size, PATCHWORK.params(grid=largest, **asked))
    with pytest.raises(InvalidInputError, match=f"^Patches of grid {largest + 1} need"):
        PATCHWORK.resolve(size, PATCHWORK.params(grid=largest + 1, **asked))


def test_a_crop_too_small_for_any_grid_is_refused():
    with pytest.raises(InvalidInputError, match="take a larger crop"):
        PATCHWORK.resolve([Size(9, 300, 3)], PATCHWORK.params())


def test_the_usual_parameters_fit_a_crop_of_256():
    for side in (*range(1, 400), 4096):
        PATCHWORK.resolve([Size(256, 256, 3)], PATCHWORK.params(width=side, height=side))


def test_it_tiles_where_it_is_asked_to():
    assert PATCHWORK.toroidal(PATCHWORK.params())
    assert not PATCHWORK.toroidal(PATCHWORK.params(tileable=False))


def test_the_memory_does_not_hold_the_texture_as_floats():
    """4096² in colour from 512² would be 201 MB as floats; rows go to the file as they are made."""
    needed = PATCHWORK.memory_of([Size(512, 512, 3)], PATCHWORK.params(width=4096, height=4096))
    assert 100e6 < needed < 300e6

"""Pictures of a video patchwork's cells: each in the colour of its source, mixed by the weights."""

import numpy as np
import pytest

from app.synthesis.patchwork.cells import Window
from app.synthesis.patchwork.jittered_cells import jittered_cells
from app.synthesis.patchwork.transitions import Transitions
from app.synthesis.patchwork.video_cells import FixedCells, source_colours

SIZE, SIDES = 64, (40, 90, 80)


def painted(cells, window, frame):
    sources = cells.sources(*SIDES[1:], 3)
    transitions = Transitions(cells.count, SIDES[0], 40, 10, loop=True, rng=np.random.default_rng(4))
    return FixedCells(cells, window, sources, transitions, SIDES).paint(frame), sources, transitions


def test_colours_say_where_in_the_clip():
    """Red from left to right, green from top to bottom, blue from first to last; of one frame there is no blue."""
    places = np.array([[0, 0, 0], [39, 0, 0], [0, 89, 0], [0, 0, 79], [13, 44.5, 39.5]])
    expected = [[0, 0, 0], [0, 0, 255], [0, 255, 0], [255, 0, 0], [127.5, 127.5, 85]]
    assert source_colours(places, SIDES) == pytest.approx(np.array(expected), rel=1e-6)
    assert source_colours(np.array([[0, 0, 0]]), (1, 1, 1)).tolist() == [[0, 0, 0]]
    assert source_colours(np.array([[-3, 95, -1]]), SIDES).tolist() == [[0, 255, 0]]


@pytest.mark.parametrize("tileable", [True, False])
@pytest.mark.parametrize("frame", [0, 7, 39])
def test_every_pixel_is_the_weighted_mean_of_its_cells_colours(tileable, frame):
    cells = jittered_cells(SIZE, SIZE, grid=16, sharpness=6, tileable=tileable, seed=3)
    found, sources, transitions = painted(cells, cells.plane, frame)
    total, sums = np.zeros((SIZE, SIZE, 3)), np.zeros((SIZE, SIZE, 1))
    for part in cells.parts(cells.plane):
        cell = cells.cell[part.centre]
        t, (y, x) = transitions.sources(frame)[cell], sources[cell]
        colour = 255 * np.array([x / 79, y / 89, t / 39]).clip(0, 1)
        total[part.rows, part.columns] += part.weight[:, :, None] * colour
        sums[part.rows, part.columns] += part.weight[:, :, None]
    np.testing.assert_allclose(found, total / sums, atol=1e-3)


def test_cells_are_painted_alike_in_any_window():
    cells = jittered_cells(SIZE, SIZE, grid=16, sharpness=6, tileable=True, seed=3)
    whole, sources, _ = painted(cells, cells.plane, 7)
    right, _, _ = painted(cells, Window(0, SIZE, SIZE - 1, SIZE), 7)
    assert np.abs(whole[:, -1:] - right).max() < 1
    y, x = next((y, x) for y, x in cells.centres if 0 <= y < SIZE and 0 <= x < SIZE)
    cell = cells.cell[[tuple(centre) for centre in cells.centres].index((y, x))]
    assert whole[y, x, :2] == pytest.approx(255 * sources[cell, ::-1] / (79, 89), abs=1)

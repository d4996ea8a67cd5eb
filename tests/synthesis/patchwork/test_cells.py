"""Cells of a jittered grid: their weights are those of the report's equation (1), and their boxes hold them."""

import numpy as np
import pytest

from app.synthesis.patchwork.cells import BLEND, LEFT_OUT, Window
from tests.synthesis.patchwork.plain_cells import cells_of, inside, shares


@pytest.mark.parametrize("tileable", [True, False])
@pytest.mark.parametrize("sharpness", [1, 2, 6, 20, 40])
def test_the_parts_of_a_window_are_the_weights_as_far_as_they_count(sharpness, tileable):
    """Kept ones are right to single precision; those left out are below 1/512 of a pixel."""
    cells = cells_of(sharpness=sharpness, tileable=tileable)
    expected = shares(cells)
    found = np.zeros_like(expected)
    window = Window(7, 45, 11, 57)
    for part in cells.parts(window):
        found[part.centre, 7:45, 11:57][part.rows, part.columns] = part.weight
    assert found.max(0)[7:45, 11:57] == pytest.approx(1), "the largest weight is 1"
    found /= np.maximum(np.sqrt((found**2).sum(0)), 1e-30)
    area = np.s_[:, 7:45, 11:57]
    kept = found[area] > 0
    assert np.abs(found - expected)[area][kept].max() < 1e-3
    assert expected[area][~kept].max() < LEFT_OUT


@pytest.mark.parametrize("sharpness", [2, 6, 20])
@pytest.mark.parametrize("tileable", [True, False])
def test_boxes_hold_what_they_say(sharpness, tileable):
    """Voronoi cells lie in the cores, parts of 1/16 of a pixel in the zones, those of 1/512 in the boxes."""
    cells = cells_of(sharpness=sharpness, tileable=tileable)
    parts = shares(cells)
    second = np.sort(parts, axis=0)[-2]
    for index, (centre, cell) in enumerate(zip(cells.centres, cells.cell, strict=True)):
        assert inside(cells.cores[cell], cells, centre)[parts[index] > second].all()
        assert parts[index][~inside(cells.zones[cell], cells, centre)].max(initial=0) < BLEND
        assert parts[index][~inside(cells.boxes[index], cells)].max(initial=0) < LEFT_OUT


def test_a_smaller_sample_is_refused():
    cells = cells_of()
    with pytest.raises(ValueError, match="does not hold"):
        cells.sources(20, 300, 0)


def test_sources_are_uniform_over_where_they_may_be():
    """Each coordinate is uniform on n places: its mean over 400 seeds is within 4 n / sqrt(12 · 400)."""
    cells = cells_of()
    drawn = np.stack([cells.sources(200, 220, seed) for seed in range(400)])
    low, high = -cells.zones[:, ::2], (200, 220) - cells.zones[:, 1::2]
    assert (drawn >= low).all()
    assert (drawn <= high).all()
    assert (np.abs(drawn.mean(0) - (low + high) / 2) < 4 * (high - low + 1) / np.sqrt(12 * 400)).all()


def test_the_margin_holds_the_faint_rest():
    cells = cells_of()
    sources = cells.sources(60, 65, 1)
    margin = cells.margin(sources, 60, 65)
    for part in cells.parts(cells.plane):
        y, x = sources[cells.cell[part.centre]] + part.source
        assert -margin <= y + part.rows.start
        assert y + part.rows.stop <= 60 + margin
        assert -margin <= x + part.columns.start
        assert x + part.columns.stop <= 65 + margin

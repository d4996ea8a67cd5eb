"""Cells of a jittered grid: their weights are those of the report's equation (1), and their boxes hold them."""

import numpy as np
import pytest

from app.synthesis.patchwork.cell_shapes import REACH, log_weight
from app.synthesis.patchwork.cells import BLEND, LEFT_OUT, Window, jittered_cells, least_sample


def cells_of(height=48, width=60, grid=12, sharpness=6.0, tileable=True, seed=3):
    return jittered_cells(height, width, grid=grid, sharpness=sharpness, tileable=tileable, seed=seed)


def shares(cells):
    """Every centre's part of every pixel, w_i / sqrt(Σ w²), in double precision, shape (N, H, W)."""
    y, x = np.ogrid[: cells.height, : cells.width]
    d = np.hypot(*(at[None] - centre[:, None, None] for at, centre in zip((y, x), cells.centres.T, strict=True)))
    logs = log_weight(np.maximum(d, 1) / cells.unit, cells.sharpness)
    logs[d == 0] = 1000  # at a centre its cell is alone
    weights = np.exp(logs - logs.max(0))
    return weights / np.sqrt((weights**2).sum(0))


def inside(box, cells, centre=(0, 0)):
    """Mask of the pixels in a box, given relative to a centre."""
    top, bottom, left, right = box + np.repeat(np.asarray(centre), 2)
    y, x = np.ogrid[: cells.height, : cells.width]
    return (top <= y) & (y < bottom) & (left <= x) & (x < right)


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


def test_a_cell_has_a_centre_at_every_turn_of_the_torus():
    cells = cells_of()
    assert cells.count == 4 * 5
    assert set(cells.cell) == set(range(20))
    for cell in range(cells.count):
        turns = cells.centres[cells.cell == cell]
        assert ((turns - turns[0]) % (48, 60) == 0).all()


@pytest.mark.parametrize("tileable", [True, False])
def test_centres_are_distinct_whole_pixels_one_in_each_square(tileable):
    for grid, squares in ((4, 12 * 15), (5, 10 * 12), (24, 2 * 3), (46, 2)):
        cells = cells_of(48, 60, grid, tileable=tileable)
        plane = cells.centres[((cells.centres >= 0) & (cells.centres < (48, 60))).all(1)]
        assert len(plane) == len(np.unique(plane, axis=0)) == squares


def test_one_cell_meets_itself_around_the_torus():
    cells = cells_of(20, 30, grid=64)
    assert cells.count == 1
    assert len(cells.parts(cells.plane)) > 1


@pytest.mark.parametrize("sharpness", [1, 2, 6, 20, 40])
@pytest.mark.parametrize("size", [(200, 200), (200, 90), (37, 410)])
def test_a_sample_of_the_least_size_holds_every_zone_whatever_the_seed(sharpness, size):
    least = least_sample(*size, 16, sharpness)
    for seed in range(6):
        cells = cells_of(*size, 16, sharpness, bool(seed % 2), seed)
        sources = cells.sources(least, least, seed)
        zones = cells.zones + np.repeat(sources, 2, axis=1)
        assert zones[:, ::2].min() >= 0
        assert zones[:, 1::2].max() <= least


def test_a_crop_of_256_holds_the_usual_cells():
    """Grid 64 at f = 6, for a plane of any size."""
    assert max(least_sample(side, side, 64, 6) for side in range(1, 500)) <= 256


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


@pytest.mark.parametrize("sharpness", [2, 6])
def test_the_work_is_linear_in_pixels(sharpness):
    """Pixels in boxes, for each pixel of the plane: no more at 16 times the size, but for chance (a few per cent)."""
    small, large = (
        (boxes[:, 1] - boxes[:, 0]) @ (boxes[:, 3] - boxes[:, 2]) / side**2
        for side in (160, 640)
        for boxes in [cells_of(side, side, 16, sharpness).boxes]
    )
    assert large == pytest.approx(small, rel=0.1)
    assert large < np.pi * (REACH + 1) ** 2


def test_the_seed_decides():
    first, again, other = (cells_of(seed=seed) for seed in (1, 1, 2))
    assert (first.centres == again.centres).all()
    assert first.centres.tolist() != other.centres.tolist()

"""The jittered grid: one centre in each square, and samples that hold all cells."""

import numpy as np
import pytest

from app.synthesis.patchwork.cell_shapes import REACH
from app.synthesis.patchwork.jittered_cells import least_sample
from tests.synthesis.patchwork.plain_cells import cells_of


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

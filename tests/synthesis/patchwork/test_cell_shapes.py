"""How far cells reach at most."""

import numpy as np
import pytest

from app.synthesis.patchwork.cell_shapes import JITTER, REACH, farthest


def test_a_voronoi_cell_reaches_the_corner_of_four_squares_whose_centres_lie_farthest_away():
    assert farthest(6, 1) == pytest.approx(np.sqrt(2) * (1 + JITTER) / 2, rel=1e-4)


@pytest.mark.parametrize("sharpness", [1, 6, 40])
def test_smaller_parts_reach_farther_but_never_beyond_the_end_of_the_weights(sharpness):
    found = [farthest(sharpness, share) for share in (1, 1 / 16, 1 / 512)]
    assert found == sorted(found)
    assert found[-1] < REACH


def test_sharper_cells_reach_less_far():
    found = [farthest(sharpness, 1 / 16) for sharpness in (1, 2, 6, 20, 40)]
    assert found == sorted(found, reverse=True)

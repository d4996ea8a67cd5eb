"""The window search draws among the same patches as brute force in double precision."""

import numpy as np
import pytest

from app.synthesis.parallel import Team
from app.synthesis.sampling.window_search import WindowSearch, gaussian_window
from tests.synthesis.sampling.grain import distances, far_from_zero, of_two_worlds, sample


def test_the_window_is_a_gaussian_of_a_deviation_of_its_side_over_6_4():
    for n in (1, 4, 11):
        y, x = np.mgrid[-n : n + 1, -n : n + 1]
        g = np.exp(-(x**2 + y**2) / (2 * ((2 * n + 1) / 6.4) ** 2))
        np.testing.assert_allclose(gaussian_window(n), g / g.sum(), rtol=1e-12)


def test_a_patch_is_drawn_uniformly_among_all_positions_within_the_tolerance():
    """Equidistant chances meet every position that qualifies equally often, however often its patch occurs."""
    h = sample(12, 14, 1)
    h[:, 7:] = h[:, :7]  # most patches occur twice
    n, tolerance = 1, 1
    window, known = h[4:7, 3:6] + 0.5, np.array([[0, 1, 0], [0, 0, 0], [0, 0, 0]], bool)
    d = distances(h, window, known, gaussian_window(n))
    near = np.flatnonzero(d <= (1 + tolerance) * d.min())
    assert 4 < len(near) < h.size / 4
    chances = (np.arange(3 * len(near)) + 0.5) / (3 * len(near))
    with Team(1) as team:
        values, masks = (np.repeat(a.reshape(1, 9, -1), len(chances), 0) for a in (window, known))
        drawn = WindowSearch(h, n, team, lambda part: None).draw(values, masks[:, :, 0], tolerance, chances)
    assert (np.bincount(drawn, minlength=h.size)[near] == 3).all()


def test_equal_patches_are_searched_once():
    stripes = np.tile(np.arange(4, dtype=np.float32), (30, 5))[:, :, None]
    with Team(1) as team:
        # 4 inside; within one pixel of the border they differ: above, below and not, times left, right and not
        assert len(WindowSearch(stripes, 1, team, lambda part: None)) == 3 * (4 + 2)


@pytest.mark.parametrize("tolerance", [0, 0.1, 1])
@pytest.mark.parametrize(
    "h",
    [sample(), sample(channels=1), far_from_zero(), of_two_worlds()],
    ids=["colour", "grey", "far from zero", "of two worlds"],
)
def test_every_draw_is_near_enough_by_brute_force_and_the_same_alone_as_among_others(h, tolerance):
    n, count, rng = 2, 30, np.random.default_rng(1)
    side = 2 * n + 1
    known = rng.random((count, side, side)) < rng.uniform(0.1, 1, (count, 1, 1))
    known[:, n, n - 1] = True
    corners = rng.integers(0, np.array(h.shape[:2]) - side + 1, (count, 2))
    windows = np.stack([h[y : y + side, x : x + side] for y, x in corners])
    windows += rng.integers(-3, 4, (count, side, side, 1)).astype(np.float32)
    values, masks, chances = windows.reshape(count, side**2, -1), known.reshape(count, -1), rng.random(count)
    with Team(2) as team:
        search = WindowSearch(h, n, team, lambda part: None)
        drawn = search.draw(values, masks, tolerance, chances)
        one_by_one = [
            int(search.draw(values[i : i + 1], masks[i : i + 1], tolerance, chances[i : i + 1])[0])
            for i in range(count)
        ]
    assert drawn.tolist() == one_by_one
    for window, mask, place in zip(windows, known, drawn, strict=True):
        d = distances(h, window, mask, gaussian_window(n))
        # Double precision leaves a part in 10¹³ of a sum of a few hundred squares undecided.
        assert d.ravel()[place] <= (1 + tolerance) * d.min() * (1 + 1e-12)


def test_the_whole_range_of_chances_meets_the_whole_set():
    """The chances 0 and just below 1 take different ends of it."""
    h = sample()
    window, known = np.full((1, 9, 3), 90, np.float32), np.eye(9, dtype=bool)[:1]
    with Team(1) as team:
        search = WindowSearch(h, 1, team, lambda part: None)
        first, last = (search.draw(window, known, 5.0, np.array([chance]))[0] for chance in (0, 1 - 2**-53))
    assert first != last

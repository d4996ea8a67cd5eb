"""Efros–Leung copies pixels whose windows match, one after the other, and computes this together and exactly."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from app.synthesis.parallel import Team
from app.synthesis.sampling.efros_leung import border_share, efros_leung, growth_order, verbatim_share
from app.synthesis.sampling.window_search import WindowSearch, gaussian_window
from tests.profiles import examples


def sample(height=20, width=23, channels=3, seed=0):
    """Coarse grain of few levels, so that there are near matches and exact ones."""
    rng = np.random.default_rng(seed)
    coarse = np.kron(rng.integers(0, 4, (-(-height // 3), -(-width // 4), 1)) * 60, np.ones((3, 4, 1)))
    return (coarse[:height, :width] + rng.integers(0, 6, (height, width, channels))).astype(np.float32)


def far_from_zero():
    return sample() / 60 + 60000


def of_two_worlds():
    """Fine grain on black and on white: whatever is taken as zero, the squares of one of them are large."""
    h = sample()
    h[:, 12:] += 65535 - 300
    return h


def distances(h, window, known, weights):
    """Of one window, known in part, to that around every pixel of the sample, in double precision; else infinite."""
    n, (height, width) = len(window) // 2, h.shape[:2]
    framed = np.pad(h.astype(np.float64), ((n, n), (n, n), (0, 0)), constant_values=np.nan)
    total = np.zeros((height, width))
    for i, j in np.argwhere(known):
        difference = framed[i : i + height, j : j + width] - window[i, j]
        total += weights[i, j] * np.square(difference).sum(2)
    return np.nan_to_num(total, nan=np.inf)


@pytest.mark.parametrize("tolerance", [0, 0.1, 0.5])
@pytest.mark.parametrize(
    ("h", "n"),
    [(sample(), 2), (sample(channels=1), 4), (sample(11, 9), 4), (far_from_zero(), 3), (of_two_worlds(), 3)],
    ids=["colour", "grey", "no larger than its window", "far from zero", "of two worlds"],
)
def test_each_pixel_is_as_near_as_the_tolerance_asks_among_all_given_what_was_there_before(h, n, tolerance):
    """Recomputed by brute force, pixel after pixel: what was computed together is as if it had been in turn."""
    height, width = 21, 24
    z, copied, order = efros_leung(h, height, width, half_patch=n, tolerance=tolerance, seed=3)
    framed = np.pad(z, ((n, n), (n, n), (0, 0)))
    when = np.pad(order, n, constant_values=height * width)
    weights = gaussian_window(n)
    for y, x in itertools.product(range(height), range(width)):
        if order[y, x] < 9:
            continue
        around = slice(y, y + 2 * n + 1), slice(x, x + 2 * n + 1)
        d = distances(h, framed[around], when[around] < order[y, x], weights)
        # Double precision leaves a part in 10¹³ of a sum of a few hundred squares undecided.
        assert d[tuple(copied[y, x])] <= (1 + tolerance) * d.min() * (1 + 1e-12)


@settings(max_examples=examples(40))
@given(st.tuples(*[st.integers(1, 20)] * 2), st.integers(1, 4), st.integers(1, 4), st.integers(0, 2**53 - 1))
def test_every_pixel_is_a_sample_pixel_at_its_place_on_the_map_and_is_filled_once(size, channels, n, seed):
    h = sample(10, 12, channels)
    z, copied, order = efros_leung(h, *size, half_patch=n, seed=seed)
    assert z.dtype == np.float32
    assert (z == h[copied[:, :, 0], copied[:, :, 1]]).all()
    assert (np.sort(order.ravel()) == np.arange(size[0] * size[1])).all()


def test_the_first_pixels_are_a_patch_of_the_sample_in_the_middle_and_stay():
    _, copied, order = efros_leung(sample(), 17, 20, seed=4)
    middle = slice(7, 10), slice(8, 11)
    assert (order[middle] == np.arange(9).reshape(3, 3)).all()
    assert (copied[middle] - copied[7, 8] == np.moveaxis(np.indices((3, 3)), 0, 2)).all()


@pytest.mark.parametrize(("height", "width", "n"), [(15, 15, 2), (12, 25, 3), (30, 8, 4), (2, 9, 1)])
def test_growth_goes_layer_by_layer_and_where_most_is_known_first(height, width, n):
    sequence = growth_order(height, width, n, np.random.default_rng(0))
    assert sorted(sequence) == list(range(height * width))
    known = np.zeros((height, width), bool)
    done = min(3, height) * min(3, width)
    known.ravel()[sequence[:done]] = True
    while not known.all():
        layer = ndimage.binary_dilation(known, np.ones((3, 3))) & ~known
        now = sequence[done : done + layer.sum()]
        assert layer.ravel()[now].all()
        count = ndimage.correlate(known.astype(int), np.ones((2 * n + 1, 2 * n + 1), int), mode="constant")
        assert (np.diff(count.ravel()[now]) <= 0).all()
        known |= layer
        done += len(now)


def test_pixels_with_equally_many_known_neighbours_come_in_random_order():
    one, other = (growth_order(31, 31, 2, np.random.default_rng(seed)) for seed in (0, 1))
    assert (one[:9] == other[:9]).all()
    assert (one != other).mean() > 0.9


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


@pytest.mark.parametrize("h", [sample(), np.full((20, 20, 3), 7, np.float32)], ids=["grain", "constant"])
def test_the_result_depends_on_the_seed_and_not_on_the_threads(h):
    one, three = (efros_leung(h, 30, 27, seed=5, threads=threads) for threads in (1, 3))
    assert all(np.array_equal(getattr(one, name), getattr(three, name)) for name in one._fields)
    other = efros_leung(h, 30, 27, seed=6)
    assert (other.copied != one.copied).any()


@pytest.mark.parametrize("period", [2, 5, 7])
def test_periodic_stripes_grow_into_perfect_stripes(period):
    """With no tolerance, and with one: the nearest window always matches, and none is within a multiple of 0."""
    profile = np.random.default_rng(period).permutation(period).astype(np.float32) * 30
    for tolerance in (0, 0.1):
        z = efros_leung(np.tile(profile, (20, 10))[:, :, None], 40, 45, tolerance=tolerance, seed=1).texture[:, :, 0]
        assert (z == z[0]).all()
        assert any((z[0] == np.roll(np.tile(profile, 45), shift)[:45]).all() for shift in range(period))


def test_the_verbatim_share_counts_pixels_of_the_offset_of_the_left_or_upper_neighbour():
    y, x = np.mgrid[:6, :8]
    whole = np.stack([y + 3, x + 2], 2)
    assert verbatim_share(whole) == pytest.approx(100 * 47 / 48)
    halves = whole.copy()
    halves[:, 4:, 1] += 5  # the right half from elsewhere: its first pixel is copied along with none
    assert verbatim_share(halves) == pytest.approx(100 * 46 / 48)
    confetti = np.random.default_rng(0).permutation(48 * 100).reshape(-1, 2)[:48].reshape(6, 8, 2)
    assert verbatim_share(confetti) == 0


@pytest.mark.parametrize(("size", "n"), [((20, 23), 2), ((9, 30), 4), ((11, 9), 4)])
def test_the_border_share_counts_pixels_drawn_whose_windows_the_sample_does_not_hold(size, n):
    """Counted one by one; and what is known of such a window lies in the sample, or it could not be compared."""
    grown = efros_leung(sample(*size), 24, 27, half_patch=n, seed=2)
    when = np.pad(grown.order, n, constant_values=grown.order.size)
    offsets = np.arange(-n, n + 1)
    reaching, drawn = 0, 0
    for y, x in np.ndindex(24, 27):
        if grown.order[y, x] >= 9:
            known = when[y : y + 2 * n + 1, x : x + 2 * n + 1] < grown.order[y, x]
            rows, columns = (at + offsets for at in grown.copied[y, x])
            inside = ((rows >= 0) & (rows < size[0]))[:, None] & ((columns >= 0) & (columns < size[1]))
            assert inside[known].all()
            reaching += not inside.all()
            drawn += 1
    assert 0 < reaching <= drawn
    assert border_share(grown, *size, n) == pytest.approx(100 * reaching / drawn)


def test_nothing_is_drawn_where_the_first_pixels_are_all():
    assert border_share(efros_leung(sample(), 3, 2, seed=1), 20, 23, 4) == 0


def test_a_sample_that_is_smaller_than_the_window_is_refused():
    with pytest.raises(ValueError, match="must hold a window of 9 × 9"):
        efros_leung(sample(8, 20))


@pytest.mark.parametrize("stop_at", [1, 2, 9])
def test_what_the_progress_raises_stops_the_work_at_once(stop_at):
    calls = []

    def progress(stage, part):
        calls.append(part)
        if len(calls) == stop_at:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        efros_leung(sample(), 40, 40, threads=2, progress=progress)
    assert len(calls) == stop_at


def test_the_progress_of_every_stage_rises():
    calls = []
    efros_leung(sample(), 70, 70, half_patch=2, progress=lambda stage, part: calls.append((stage, part)))
    stages = {stage: [part for name, part in calls if name == stage] for stage, _ in calls}
    assert list(stages) == ["order", "patches", "growth"]
    assert [stage for stage, _ in calls] == sorted((stage for stage, _ in calls), key=list(stages).index)
    for parts in stages.values():
        assert parts == sorted(parts)
    assert stages["growth"][-1] == 1
    assert len(stages["growth"]) > 70  # no step is more than a small part of the whole

"""Efros–Leung copies pixels whose windows match, one after the other, and computes this together and exactly."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from app.synthesis.sampling.efros_leung import border_share, efros_leung, growth_order, verbatim_share
from app.synthesis.sampling.window_search import gaussian_window
from tests.profiles import examples
from tests.synthesis.sampling.grain import distances, far_from_zero, of_two_worlds, sample


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
    confetti = np.random.default_rng(0).permutation(48 * 100).reshape(-1, 2)[:48].reshape(6, 8, 2)
    assert verbatim_share(confetti) == 0


@pytest.mark.parametrize("coordinate", [0, 1])
@pytest.mark.parametrize("axis", [0, 1])
def test_one_coordinate_that_jumps_parts_two_halves_in_either_direction(axis, coordinate):
    """A single line, in which each pixel has one neighbour: the second half's first is copied along with none."""
    shape = (8, 1) if axis == 0 else (1, 8)
    copied = np.moveaxis(np.indices(shape), 0, 2) + np.array((3, 2))
    copied.reshape(8, 2)[4:, coordinate] += 5
    assert verbatim_share(copied) == 100 * 6 / 8


def test_the_verbatim_share_is_that_of_a_plain_count():
    """Offsets of two values each, so that both, one or none of them are the neighbour's."""
    rng = np.random.default_rng(1)
    copied = np.moveaxis(np.indices((12, 15)), 0, 2) + rng.integers(0, 2, (12, 15, 2))
    along = 0
    for y, x in np.ndindex(12, 15):
        left, above = (
            ny >= 0 and nx >= 0 and tuple(copied[y, x] - copied[ny, nx]) == (y - ny, x - nx)
            for ny, nx in ((y, x - 1), (y - 1, x))
        )
        along += left or above
    assert verbatim_share(copied) == pytest.approx(100 * along / 180)


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

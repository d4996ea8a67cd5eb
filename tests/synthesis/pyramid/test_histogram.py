"""Histogram matching is exact and keeps the order of the values."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from app.synthesis.pyramid.histogram import match, quantiles
from tests.profiles import examples

FLOATS = hnp.arrays(np.float32, st.integers(1, 200), elements=st.floats(-(2.0**100), 2.0**100, width=32))


def matched(values, ordered):
    result = values.copy()
    match(result, ordered)
    return result


@settings(max_examples=examples(200))
@given(FLOATS, st.integers(0, 2**32))
def test_the_histogram_is_the_targets_and_the_order_stays(values, seed):
    target = np.sort(np.random.default_rng(seed).standard_normal(len(values)).astype(np.float32))
    values += 0  # no −0, which comes before 0
    result = matched(values, target)
    assert (np.sort(result) == target).all()
    assert (result[np.argsort(values, kind="stable")] == target).all()


def test_more_values_than_fit_into_a_piece_of_work_are_matched_too():
    rng = np.random.default_rng(0)
    values, target = rng.standard_normal((300, 301)).astype(np.float32), np.sort(rng.random(90300, np.float32))
    result = matched(values, target)
    assert (np.sort(result, axis=None) == target).all()
    assert (result.flat[np.argsort(values, axis=None, kind="stable")] == target).all()


@given(FLOATS)
def test_values_that_have_the_histogram_already_stay_as_they_are(values):
    values += 0  # no −0, which comes before 0
    assert (matched(values, np.sort(values)) == values).all()


@given(st.integers(1, 60), st.integers(1, 60))
def test_other_sizes_take_quantiles_interpolated_between_the_targets(size, count):
    ordered = np.sort(np.random.default_rng(size).standard_normal(size).astype(np.float32))
    places = (np.arange(count) + 0.5) * size / count - 0.5
    expected = np.interp(places, np.arange(size), ordered)
    np.testing.assert_allclose(quantiles(ordered, count), expected, atol=1e-6)
    assert (
        quantiles(ordered, count, count // 3, count // 2) == quantiles(ordered, count)[count // 3 : count // 2]
    ).all()
    values = np.random.default_rng(count).permutation(count).astype(np.float32)
    np.testing.assert_allclose(np.sort(matched(values, ordered)), expected, atol=1e-6)


@pytest.mark.parametrize("factor", [4, 9, 0.25])
def test_another_number_of_values_keeps_mean_and_deviation(factor):
    """Quantiles at the middles of equal shares: the mean of 4 or 9 neighbours of a piecewise linear function is the
    function's but at the ends, 1 of 4096 values each, whose outer neighbours stay with them.
    """
    ordered = np.sort(np.random.default_rng(0).gamma(2, size=4096).astype(np.float32))
    other = quantiles(ordered, int(4096 * factor))
    assert other.mean() == pytest.approx(ordered.mean(), rel=2e-3)
    assert other.std() == pytest.approx(ordered.std(), rel=1e-2)


def test_what_is_raised_between_its_steps_stops_it():
    def stop():
        raise InterruptedError

    with pytest.raises(InterruptedError):
        match(np.zeros(10, np.float32), np.zeros(10, np.float32), stop)


def test_values_that_cannot_be_matched_in_place_are_refused():
    with pytest.raises(ValueError, match="copy"):
        match(np.zeros((10, 10), np.float32)[:, :5], np.zeros(50, np.float32))

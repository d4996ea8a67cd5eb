"""The extended spot keeps mean and variance of the sample; see also test_spot_variance.py."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from app.synthesis.fourier.spot import centre, extend_spot, window
from tests.profiles import examples

PROFILES = ["bump", "gaussian"]


@settings(max_examples=examples(60))
@given(st.integers(1, 300), st.floats(0, 0.5), st.sampled_from(PROFILES))
def test_the_window_has_l2_norm_one_is_symmetric_and_never_falls_on_its_way_in(n, alpha, profile):
    phi = window(n, alpha, profile)
    assert np.isfinite(phi).all()
    np.testing.assert_allclose((phi**2).mean(), 1, rtol=1e-12)
    np.testing.assert_allclose(phi, phi[::-1])
    assert (phi >= 0).all()
    assert (np.diff(phi[: (n + 1) // 2]) >= -1e-12).all()


@pytest.mark.parametrize("profile", PROFILES)
def test_the_window_is_constant_inside(profile):
    inside = window(500, 0.2, profile)[100:400]
    np.testing.assert_allclose(inside, inside[0])


def test_the_bump_window_rises_as_the_primitive_of_the_article():
    alpha, n = 0.3, 200

    def bump(t):
        u = 2 * t / alpha - 1
        return np.exp(-1 / (1 - u**2)) if abs(u) < 1 else 0.0

    total = quad(bump, 0, alpha)[0]
    expected = [quad(bump, 0, (i + 0.5) / n)[0] / total for i in range(int(alpha * n))]
    phi = window(n, alpha, "bump")
    np.testing.assert_allclose(phi[: len(expected)] / phi[n // 2], expected, atol=2e-6)


def test_the_gaussian_window_falls_with_a_quarter_of_alpha_as_its_deviation():
    alpha, n = 0.2, 400
    phi = window(n, alpha, "gaussian")
    t = (np.arange(80) + 0.5) / n
    np.testing.assert_allclose(phi[:80] / phi[n // 2], np.exp(-((t - alpha) ** 2) / (2 * (alpha / 4) ** 2)), rtol=1e-9)


def test_without_a_transition_the_window_is_one():
    assert (window(17, 0, "bump") == 1).all()
    assert (window(17, 0, "gaussian") == 1).all()


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("size", [(128, 128), (200, 300), (333, 101), (101, 100)])
def test_a_homogeneous_sample_keeps_the_variance_of_every_channel(size, profile):
    p = np.random.default_rng(0).normal(100, 20, (100, 100, 2)).astype(np.float32)
    mean = p.mean((0, 1), dtype=np.float64)
    spot = extend_spot(p, mean, *size, 0.1, profile)
    variance = ((spot - mean) ** 2).mean((0, 1), dtype=np.float64)
    # the weighted mean of N = 10⁴ squares of normals deviates by at most sqrt(2 E φ⁴ / N) ≈ sqrt(3.2 / N)
    np.testing.assert_allclose(variance, p.var((0, 1), dtype=np.float64), rtol=4 * np.sqrt(3.2 / 1e4))


def test_it_is_the_formula_on_a_centred_rectangle_and_the_mean_elsewhere():
    p = np.random.default_rng(1).random((6, 9, 3)).astype(np.float32)
    mean = p.mean((0, 1), dtype=np.float64)
    spot = extend_spot(p, mean, 12, 20, 0.2, "bump")
    faded = np.zeros((12, 20, 3))
    faded[3:9, 5:14] = window(6, 0.2)[:, None, None] * window(9, 0.2)[None, :, None] * (p - mean)
    factor = np.sqrt(p.var((0, 1), dtype=np.float64).sum() / faded.var((0, 1)).sum())
    np.testing.assert_allclose(spot, mean + factor * faded, rtol=1e-5)
    assert factor == pytest.approx(np.sqrt(12 * 20 / (6 * 9)), rel=0.2)


def test_an_axis_that_is_not_extended_is_not_attenuated():
    p = np.random.default_rng(2).random((8, 8, 1)).astype(np.float32)
    mean = p.mean((0, 1), dtype=np.float64)
    wide = extend_spot(p, mean, 8, 32, 0.5, "bump") - mean
    inner = wide[:, 12:20, 0] / (p - mean)[:, :, 0]
    phi = window(8, 0.5)
    np.testing.assert_allclose(inner / inner[0, 0], np.tile(phi / phi[0], (8, 1)), rtol=1e-3)


def test_the_same_size_changes_nothing():
    p = np.random.default_rng(3).random((8, 9, 1)).astype(np.float32)
    np.testing.assert_allclose(extend_spot(p, p.mean((0, 1), dtype=np.float64), 8, 9), p, atol=1e-6)


def test_the_centre_is_at_most_as_large_as_asked_for():
    h = np.arange(70, dtype=np.float32).reshape(7, 10)
    assert centre(h, 3, 99).tolist() == h[2:5].tolist()
    assert centre(h, 7, 4).tolist() == h[:, 3:7].tolist()

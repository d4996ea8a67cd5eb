"""Spot noise is the convolution on the torus, written out as sums over all translations."""

import numpy as np
import pytest

from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.fourier.spot import Spot, centre, extend_spot
from app.synthesis.fourier.spot_noise import convolve, sample_spot, transform
from tests.synthesis.images import image, whole

SIZES = [(6, 7), (8, 6), (1, 9), (9, 1), (5, 5)]


def white(height, width, seed=0):
    """A noise in the plane, and its half spectrum."""
    noise = np.random.default_rng(seed).normal(size=(height, width))
    return noise, np.fft.rfft2(noise).astype(np.complex64)


def translated_sum(h, noise):
    """Σ_u W(u) h(x − u) on the torus."""
    total = np.zeros_like(h)
    for place in np.ndindex(noise.shape):
        total += noise[place] * np.roll(h, place, (0, 1))
    return total


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("channels", [1, 3])
def test_it_is_the_sum_of_all_translates_about_the_spots_mean(size, channels):
    spot = sample_spot(image(4, 5, channels), *size)
    noise, spectrum = white(*size)
    h = whole(spot)
    expected = spot.mean + translated_sum(h - h.mean((0, 1)), noise)
    np.testing.assert_allclose(convolve([spot], [spectrum]), expected, atol=1e-4 * np.abs(expected).max())


def test_several_spots_add_up_and_have_their_mean_once():
    spots = [sample_spot(image(4, 5), 8, 7) for _ in range(2)]
    spots[1] = Spot(spots[1].planes * np.float32(0.5), spots[0].mean, 8, 7)
    (_, one), (_, two) = white(8, 7, 1), white(8, 7, 2)
    alone = [convolve([spot], [noise]) for spot, noise in zip(spots, (one, two), strict=True)]
    np.testing.assert_allclose(convolve(spots, [one, two]), alone[0] + alone[1] - spots[0].mean, atol=1e-3)


def test_the_value_of_the_noise_at_the_origin_is_ignored():
    spot, (_, noise) = sample_spot(image(4, 5), 8, 7), white(8, 7)
    other = noise.copy()
    other[0, 0] = 1e6
    assert (convolve([spot], [noise]) == convolve([spot], [other])).all()


@pytest.mark.parametrize("size", [(4, 5), (9, 12), (3, 12)])
@pytest.mark.parametrize(("alpha", "window"), [(0.1, "bump"), (0.4, "gaussian")])
def test_the_spot_of_a_sample_is_its_extended_periodic_component(size, alpha, window):
    h = image(4, 5)
    spot = sample_spot(h, *size, alpha, window)
    p = periodic_component(centre(h, *size))
    mean = centre(h, *size).mean((0, 1), dtype=np.float64)
    assert spot.mean == pytest.approx(mean, rel=1e-6)
    assert np.abs(whole(spot) - extend_spot(p, mean, *size, alpha, window)).max() < 1e-3


@pytest.mark.parametrize("size", [(4, 5), (9, 12), (4, 11)])
def test_the_transform_of_a_plane_is_that_of_it_with_zeros_around(size):
    spot = sample_spot(image(4, 5), *size)
    padded = np.zeros(size)
    padded[spot.top : spot.top + 4, spot.left : spot.left + 5] = spot.planes[1]
    np.testing.assert_allclose(transform(spot.planes[1], spot), np.fft.rfft2(padded), atol=1e-3)


def test_the_result_does_not_depend_on_the_threads():
    spot, (_, noise) = sample_spot(image(4, 5), 90, 70), white(90, 70)
    assert (convolve([spot], [noise], threads=2) == convolve([spot], [noise])).all()

"""The steerable pyramid gives images of any size back, and its bands are those of pyrtools."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pyrtools.pyramids import SteerablePyramidFreq

from app.synthesis.pyramid.pyramid import Band, SteerablePyramid, Total, to_image, to_spectrum
from tests.profiles import examples

SIZES = [(64, 64), (33, 33), (61, 67), (48, 100), (101, 30), (17, 2), (1, 40), (5, 1), (1, 1)]


def image(height, width, seed=0):
    """Noise with a mean of its own."""
    return (50 + 20 * np.random.default_rng(seed).standard_normal((height, width))).astype(np.float32)


def bands_of(picture, scales, orientations):
    pyramid, spectrum = SteerablePyramid(*picture.shape, scales, orientations), to_spectrum(picture)
    return {band: pyramid.filter(band).analyse(spectrum) for band in pyramid.bands}


def put_together(bands, height, width, scales, orientations):
    pyramid = SteerablePyramid(height, width, scales, orientations)
    total = np.zeros((height, width // 2 + 1), np.complex64)
    for band, values in bands.items():
        window = pyramid.filter(band)
        window.add(window.synthesise(values), total)
    return to_image(total, (height, width))


def rebuilt(picture, scales, orientations):
    return put_together(bands_of(picture, scales, orientations), *picture.shape, scales, orientations)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize(("scales", "orientations"), [(4, 4), (1, 1), (3, 2), (2, 5), (6, 8)])
def test_an_image_of_even_odd_or_prime_size_is_rebuilt_to_1e_5(size, scales, orientations):
    picture = image(*size)
    error = np.abs(rebuilt(picture, scales, orientations) - picture).max()
    assert error <= 1e-5 * np.abs(picture).max()


@settings(max_examples=examples(60))
@given(st.integers(1, 90), st.integers(1, 90), st.integers(1, 8), st.integers(1, 8))
def test_an_image_of_any_size_is_rebuilt_to_1e_5_of_its_contrast(height, width, scales, orientations):
    picture = image(height, width) - 50
    error = np.abs(rebuilt(picture, scales, orientations) - picture).max()
    assert error <= 1e-5 * np.abs(picture).max()


@pytest.mark.parametrize("size", SIZES)
def test_the_bands_together_have_the_energy_of_the_image(size):
    """A tight frame: Σ mean(band²) = mean(image²), since each decimated band holds its whole spectrum."""
    picture = image(*size)
    energy = sum(np.square(values, dtype=np.float64).mean() for values in bands_of(picture, 4, 4).values())
    assert energy == pytest.approx(np.square(picture, dtype=np.float64).mean(), rel=1e-5)


@pytest.mark.parametrize("size", [(64, 64), (128, 64)])
@pytest.mark.parametrize(("scales", "orientations"), [(4, 4), (3, 1), (2, 3), (3, 6)])
def test_the_bands_are_those_of_pyrtools(size, scales, orientations):
    """Up to a factor 4^s: pyrtools cuts the spectrum of a scale without rescaling it, and here bands are samples of
    the filtered image. It interpolates its windows linearly between tabulated points at steps h = π/512 (radial)
    and π/1024 (angular), an error up to h²/8 · max |f″|: 5e-6 and, for the cos⁵ of six orientations, 6e-6 of a
    window, which bounds what is left over together with single precision.
    """
    picture = image(*size)
    theirs = SteerablePyramidFreq(picture.astype(float), height=scales, order=orientations - 1, is_complex=False)
    names = {Band(0, None): "residual_highpass", Band(scales, None): "residual_lowpass"}
    ours = bands_of(picture, scales, orientations)
    assert len(ours) == len(theirs.pyr_coeffs) == 2 + scales * orientations
    for band, values in ours.items():
        expected = theirs.pyr_coeffs[names.get(band, tuple(band))] / 4**band.scale
        assert values.shape == expected.shape
        np.testing.assert_allclose(values, expected, atol=1.2e-5 * np.abs(expected).max())


@pytest.mark.parametrize("orientations", [1, 2, 3, 4, 6])
@pytest.mark.parametrize("direction", [(8, 0), (0, 8), (5, 7), (-6, 6)])
def test_an_oscillation_is_shared_out_by_its_radius_and_its_angle(direction, orientations):
    """Energy c²(log₂ r + s + 1) · κ cos^2q(θ − πb/Q) of scale s and orientation b, as the windows say."""
    down, across = direction
    y, x = np.mgrid[:64, :60]
    wave = (math.sqrt(2) * np.cos(2 * np.pi * (down * y / 64 + across * x / 60) + 1)).astype(np.float32)
    ky, kx = 2 * down / 64, 2 * across / 60
    t, theta, order = np.log2(np.hypot(ky, kx)), np.arctan2(ky, kx), orientations - 1
    kappa = 4**order * math.factorial(order) ** 2 / (orientations * math.factorial(2 * order))
    for band, values in bands_of(wave, 3, orientations).items():
        if band.orientation is None:
            continue
        radial = np.cos(np.pi / 2 * np.clip(t + band.scale + 1, -1, 1)) ** 2
        angular = kappa * np.cos(theta - np.pi * band.orientation / orientations) ** (2 * order)
        assert np.square(values).mean() == pytest.approx(radial * angular, abs=1e-5)


def test_a_constant_is_in_the_low_pass_residual_alone():
    bands = bands_of(np.full((40, 31), 7, np.float32), 3, 4)
    for band, values in bands.items():
        np.testing.assert_allclose(values, 7 if band == Band(3, None) else 0, atol=1e-6)


def test_the_sum_of_the_bands_does_not_depend_on_their_order():
    picture = image(40, 50)
    pyramid, spectrum, sums = SteerablePyramid(40, 50, 3, 4), to_spectrum(picture), []
    for bands in (pyramid.bands, pyramid.bands[::-1]):
        total = Total(pyramid)
        for band in bands:
            window = pyramid.filter(band)
            done = total.add(band, window, window.synthesise(window.analyse(spectrum)))
            assert (done is not None) == (band == bands[-1])
        sums.append(done)
    assert (sums[0] == sums[1]).all()

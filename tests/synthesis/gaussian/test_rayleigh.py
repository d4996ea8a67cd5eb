"""The Rayleigh noise changes the modulus by its law, and the phase not at all."""

import numpy as np
import pytest
from scipy import stats

from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.fourier.spot import centre
from app.synthesis.gaussian.adsn import adsn
from app.synthesis.gaussian.rayleigh import rayleigh
from app.synthesis.gaussian.rpn import rpn
from tests.synthesis.images import image

LIKELY = 1e-3  # a seed is pinned; a p-value below this says that the law is wrong
SIZES = [(1, 1), (1, 12), (12, 1), (2, 3), (16, 16), (16, 17), (17, 16), (37, 41)]


def spectrum(picture):
    return np.fft.fft2(picture.astype(np.float64), axes=(0, 1))


@pytest.mark.parametrize("size", SIZES)
def test_the_phase_is_unchanged(size):
    """The ratio of both spectra is a positive number wherever the sample has something to multiply."""
    before, after = spectrum(periodic_component(image(*size))), spectrum(rayleigh(image(*size), seed=1))
    strong = np.abs(before) > 1e-3 * np.abs(before).max()
    ratio = after[strong] / before[strong]
    np.testing.assert_allclose(ratio.imag, 0, atol=1e-3)
    assert (ratio.real > -1e-3).all()


def test_the_ratio_of_the_moduli_is_rayleigh_with_a_mean_square_of_one():
    h = image(128, 130, 1)
    ratio = np.abs(spectrum(rayleigh(h, seed=1))) / np.abs(spectrum(periodic_component(h)))
    half = ratio[:, 1:65, 0].ravel()  # one of each pair k, −k: independent
    assert stats.kstest(half, stats.rayleigh(scale=np.sqrt(0.5)).cdf).pvalue > LIKELY
    # R² is exponential, of mean and deviation 1: the mean of n has a deviation of n^(−1/2)
    assert abs((half**2).mean() - 1) < 4 / np.sqrt(half.size)


@pytest.mark.parametrize("size", SIZES)
def test_the_noise_is_even_and_the_same_for_every_channel(size):
    before, after = spectrum(periodic_component(image(*size))), spectrum(rayleigh(image(*size), seed=2))
    ratio = (np.abs(after) / np.abs(before))[np.abs(before).min(2) > 1e-2 * np.abs(before[0, 0]).min()]
    np.testing.assert_allclose(ratio, ratio[:, :1].repeat(3, 1), rtol=1e-3)
    whole = np.abs(after)
    np.testing.assert_allclose(whole, whole[-np.arange(size[0])][:, -np.arange(size[1])], rtol=1e-9, atol=1e-9)


def test_the_noise_is_white():
    """The squared moduli of neighbouring frequencies are uncorrelated: n^(−1/2) is the deviation of a correlation."""
    h = image(128, 130, 1)
    power = (np.abs(spectrum(rayleigh(h, seed=1))) / np.abs(spectrum(periodic_component(h))))[1:64, 1:64, 0] ** 2
    for one, other in ((power[1:], power[:-1]), (power[:, 1:], power[:, :-1])):
        assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 4 / np.sqrt(one.size)


@pytest.mark.parametrize("size", [(16, 16), (17, 20)])
def test_to_randomise_its_phase_is_to_make_the_adsn_of_the_same_seed(size):
    """Its output is its own periodic component up to the jump at the borders, so phases are added by hand."""
    h = image(*size)
    phase = spectrum(rpn(h, seed=3)) / spectrum(periodic_component(h))
    made = np.fft.ifft2(spectrum(rayleigh(h, seed=3)) * phase, axes=(0, 1)).real
    np.testing.assert_allclose(made, adsn(h, seed=3), atol=0.1)


@pytest.mark.parametrize("size", SIZES)
def test_the_mean_is_kept(size):
    h = image(*size)
    np.testing.assert_allclose(rayleigh(h, seed=1).mean((0, 1)), h.mean((0, 1)), rtol=1e-5)


def test_a_smaller_one_is_that_of_the_centre_and_a_larger_one_is_refused():
    h = image(30, 41)
    assert (rayleigh(h, 16, 21, seed=5) == rayleigh(centre(h, 16, 21), seed=5)).all()
    for size in ((31, 41), (30, 42), (10, 50)):
        with pytest.raises(ValueError, match="own size"):
            rayleigh(h, *size)


def test_a_grey_image_stays_two_dimensional_and_equals_its_one_channel():
    h = image(20, 21, 1)
    assert (rayleigh(h[:, :, 0], seed=2) == rayleigh(h, seed=2)[:, :, 0]).all()


def test_the_result_depends_on_the_seed_and_not_on_the_threads():
    h = image(40, 50)
    assert (rayleigh(h, seed=3, threads=2) == rayleigh(h, seed=3)).all()
    assert (rayleigh(h, seed=4) != rayleigh(h, seed=3)).mean() > 0.99

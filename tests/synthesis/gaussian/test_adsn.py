"""ADSN is the Gaussian texture whose covariance is the autocorrelation of the spot."""

import numpy as np
import pytest
from scipy import stats

from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.fourier.spectral import half_spectrum
from app.synthesis.fourier.spot import extend_spot
from app.synthesis.gaussian.adsn import adsn, white_noise
from app.synthesis.gaussian.rpn import random_phase, rpn
from tests.synthesis.images import image

LIKELY = 1e-3  # a seed is pinned; a p-value below this says that the law is wrong


def spectrum(picture):
    return np.fft.rfft2(picture.astype(np.float64), axes=(0, 1))


def correlations(picture):
    """(1/MN) Σ_u z_c(u) z_d(u + x) of the centred picture, for all channels c, d and lags x."""
    z = np.fft.fft2(picture - picture.mean((0, 1)), axes=(0, 1))
    products = z.conj()[:, :, :, None] * z[:, :, None, :]
    return np.fft.ifft2(products, axes=(0, 1)).real / (picture.shape[0] * picture.shape[1])


@pytest.mark.parametrize("sizes", [(6, 7, 6, 7), (6, 5, 9, 12)])
def test_the_covariance_is_the_autocorrelation_of_the_spot(sizes):
    h, draws = image(*sizes[:2]), 800
    p = periodic_component(h)
    expected = correlations(extend_spot(p, p.mean((0, 1), dtype=np.float64), *sizes[2:]).astype(np.float64))
    seen = np.array([correlations(adsn(h, *sizes[2:], seed=seed).astype(np.float64)) for seed in range(draws)])
    error = seen.std(0) / np.sqrt(draws)
    # a few hundred values, each normal with this standard error
    assert (np.abs(seen.mean(0) - expected) <= 4.5 * error + 1e-4 * expected.max()).all()


def test_every_pixel_is_gaussian_with_the_variance_of_the_sample():
    h = image(8, 8, 1)
    values = np.array([adsn(h, seed=seed)[3, 5, 0] for seed in range(800)])
    law = stats.norm(h.mean(), periodic_component(h).std())
    assert stats.kstest(values, law.cdf).pvalue > LIKELY


def test_the_modulus_is_the_samples_times_a_rayleigh_noise():
    h = image(128, 130, 1)
    ratio = np.abs(spectrum(adsn(h, seed=1))) / np.abs(spectrum(periodic_component(h)))
    ratio = ratio[:, 1:-1].ravel()
    assert stats.kstest(ratio, stats.rayleigh(scale=np.sqrt(0.5)).cdf).pvalue > LIKELY


@pytest.mark.parametrize("sizes", [(24, 30, 24, 30), (24, 31, 61, 50)])
def test_it_has_the_phase_of_the_rpn_of_the_same_seed(sizes):
    h = image(*sizes[:2])
    a, r = spectrum(adsn(h, *sizes[2:], seed=6)), spectrum(rpn(h, *sizes[2:], seed=6))
    strong = np.abs(a) > 1e-2 * np.abs(a[1:]).max()
    np.testing.assert_allclose(np.angle(a / r)[strong], 0, atol=1e-3)


def test_channels_share_phase_and_modulus_noise():
    h = image(24, 30)
    a, p = spectrum(adsn(h, seed=6)), spectrum(periodic_component(h))
    a[0, 0] = p[0, 0]
    cross = a[:, :, 0] * p[:, :, 1] - a[:, :, 1] * p[:, :, 0]
    assert np.abs(cross).max() <= 1e-5 * np.abs(p[1:]).max() * np.abs(a).max()


@pytest.mark.parametrize("sizes", [(16, 16, 16, 16), (17, 16, 40, 41)])
def test_the_mean_is_kept(sizes):
    h = image(*sizes[:2])
    np.testing.assert_allclose(adsn(h, *sizes[2:], seed=1).mean((0, 1)), h.mean((0, 1)), rtol=1e-5)


def test_of_two_sinusoids_it_favours_one():
    """Figure 6 of the TIP article: the amplitudes of two oscillations become independent Rayleigh variables."""
    y, x = (np.mgrid[:16, :16] + 0.5) * 2 * np.pi / 16
    h = (100 + 30 * np.cos(3 * x) + 30 * np.cos(5 * y)).astype(np.float32)
    before = np.abs(spectrum(periodic_component(h))[[0, 5], [3, 0]])
    draws = np.array([np.abs(spectrum(adsn(h, seed=seed))[[0, 5], [3, 0]]) / before for seed in range(600)])
    for amplitude in draws.T:
        assert stats.kstest(amplitude, stats.rayleigh(scale=np.sqrt(0.5)).cdf).pvalue > LIKELY
    # R₁² / (R₁² + R₂²) of two independent exponentials is uniform: one is at least thrice the other half of the time
    share = draws[:, 0] ** 2 / (draws**2).sum(1)
    assert stats.kstest(share, stats.uniform.cdf).pvalue > LIKELY


def test_the_rayleigh_modulus_leaves_the_phase_alone_and_has_unit_mean_square():
    phase, noise = half_spectrum(random_phase, 256, 256, seed=3), half_spectrum(white_noise, 256, 256, seed=3)
    np.testing.assert_allclose(np.abs(np.angle(noise / phase)), 0, atol=1e-5)
    modulus = np.abs(noise[:, 1:-1]).ravel()
    assert stats.kstest(modulus, stats.rayleigh(scale=np.sqrt(0.5)).cdf).pvalue > LIKELY
    # R² is exponential: mean 1, standard deviation 1
    assert abs((modulus**2).mean() - 1) < 4 / np.sqrt(modulus.size)
    angle = np.angle(phase[:, 1:-1]).ravel()
    assert abs(np.corrcoef(modulus, np.cos(angle))[0, 1]) < 4 / np.sqrt(modulus.size)


def test_modulus_at_a_self_conjugate_frequency_is_that_of_a_real_normal():
    values = [half_spectrum(white_noise, 2, 2, seed)[1, 1].real for seed in range(1000)]
    assert stats.kstest(values, stats.norm.cdf).pvalue > LIKELY


def test_with_rayleigh_moduli_it_is_a_gaussian_white_noise():
    white = np.fft.irfft2(half_spectrum(white_noise, 128, 129, seed=4), s=(128, 129)) * np.sqrt(128 * 129)
    white -= white.mean()
    assert stats.kstest(white.ravel(), stats.norm.cdf).pvalue > LIKELY

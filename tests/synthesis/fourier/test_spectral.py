"""Random phases are odd, uniform and independent; Rayleigh moduli make them the transform of a white noise."""

import numpy as np
import pytest
from scipy import stats

from app.synthesis.fourier.spectral import LogModulus, column_blocks, half_spectrum, random_bits
from app.synthesis.gaussian.adsn import white_noise
from app.synthesis.gaussian.rpn import random_phase

SIZES = [(1, 1), (1, 8), (8, 1), (2, 2), (7, 7), (8, 8), (8, 7), (7, 8), (101, 130)]
LIKELY = 1e-3  # a seed is pinned; a p-value below this says that the law is wrong


def whole(half, width):
    """The full spectrum that a half one stands for."""
    height = len(half)
    k, m = np.meshgrid(np.arange(height), np.arange(width), indexing="ij")
    mirrored = half[-k % height, np.minimum(-m % width, half.shape[1] - 1)].conj()
    return np.where(m < half.shape[1], half[k, np.minimum(m, half.shape[1] - 1)], mirrored)


@pytest.mark.parametrize("rayleigh", [False, True])
@pytest.mark.parametrize("size", SIZES)
def test_it_is_the_spectrum_of_a_real_image(size, rayleigh):
    full = whole(half_spectrum(white_noise if rayleigh else random_phase, *size, seed=5), size[1])
    opposite = np.roll(full[::-1, ::-1], (1, 1), (0, 1))
    assert (full == opposite.conj()).all()


@pytest.mark.parametrize("size", SIZES)
def test_the_phase_is_zero_at_the_origin_and_zero_or_pi_where_a_frequency_is_its_own_opposite(size):
    spectrum = half_spectrum(random_phase, *size, seed=5)
    np.testing.assert_allclose(np.abs(spectrum), 1, rtol=1e-6)
    assert spectrum[0, 0] == 1
    rows = {0, size[0] // 2} if size[0] % 2 == 0 else {0}
    columns = {0, size[1] // 2} if size[1] % 2 == 0 else {0}
    assert all(spectrum[k, m] in (1, -1) for k in rows for m in columns)


def test_the_signs_at_self_conjugate_frequencies_are_fair():
    signs = [half_spectrum(random_phase, 4, 4, seed)[[2, 0, 2], [0, 2, 2]].real.sum() for seed in range(300)]
    # 900 fair coins have a standard deviation of 30
    assert abs(sum(signs)) < 4 * 30


def test_the_phase_is_uniform():
    phase = np.angle(half_spectrum(random_phase, 256, 256, seed=1)[:, 1:-1]).ravel()
    assert stats.kstest(phase, stats.uniform(-np.pi, 2 * np.pi).cdf).pvalue > LIKELY


def test_neighbouring_phases_are_independent():
    values = half_spectrum(random_phase, 256, 256, seed=2)[:, 1:-1]
    for other in (np.roll(values, 1, 0), np.roll(values, 1, 1), np.roll(values, 32, 1), values.conj()[::-1]):
        # a mean of n independent points of the unit circle has a modulus of about n^(-1/2)
        assert abs((values * other.conj()).mean()) < 4 / np.sqrt(values.size)


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


def test_every_seed_draws_anew():
    assert len({half_spectrum(random_phase, 8, 8, seed).tobytes() for seed in (0, 1, 2, 2**32, 2**53 - 1)}) == 5


def test_a_block_depends_on_no_other_block():
    spectrum = half_spectrum(white_noise, 40, 150, seed=9)
    for first, last in reversed(column_blocks(150)):
        assert (white_noise(40, 150, (first, last), random_bits(9, (first, last))) == spectrum[:, first:last]).all()


@pytest.mark.parametrize("size", SIZES)
def test_the_picture_of_a_spectrum_is_the_centred_logarithm_of_the_whole_one(size):
    height, width = size
    h = np.random.default_rng(0).random(size)
    h -= h.mean()
    spectrum = LogModulus((np.abs(np.fft.rfft2(h)) ** 2).astype(np.float32), width)
    picture = spectrum.rows(0, height)
    modulus = np.fft.fftshift(np.abs(np.fft.fft2(h)))
    greatest = modulus.max()
    modulus[height // 2, width // 2] = greatest
    with np.errstate(divide="ignore", invalid="ignore"):
        expected = np.nan_to_num(255 * (1 + np.log10(modulus / greatest) / 4), nan=255).clip(0, 255)
    assert picture.shape == size
    assert np.abs(picture - expected).max() <= 1
    strips = [spectrum.rows(y, y + 1) for y in range(height)]
    assert (np.concatenate(strips) == picture).all()

"""The half spectrum: what is drawn for it is that of a real image, block by block, and so is its picture."""

import numpy as np
import pytest

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

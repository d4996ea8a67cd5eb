"""The periodic component solves Δp = Δᵢh with the mean of h."""

from pathlib import Path

import numpy as np
import pytest
import scipy.fft
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from app.synthesis.fourier.periodic import periodic_component, periodic_spectrum, smooth_component
from tests.profiles import examples

SAMPLES = Path(__file__).parents[3] / "samples"
SIZES = [(1, 1), (1, 9), (9, 1), (2, 2), (2, 7), (6, 7), (8, 8), (13, 11)]


def laplacian(height, width, periodic):
    """The dense matrix of Δ (on the torus) or Δᵢ (inside), neighbour by neighbour."""
    matrix = np.zeros((height * width, height * width))
    for y in range(height):
        for x in range(width):
            for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)):
                v, u = y + dy, x + dx
                if periodic or (0 <= v < height and 0 <= u < width):
                    matrix[y * width + x, y * width + x] += 1
                    matrix[y * width + x, v % height * width + u % width] -= 1
    return matrix


def image(height, width, channels=3, seed=0):
    return np.random.default_rng(seed).uniform(0, 255, (height, width, channels)).astype(np.float32)


@settings(max_examples=examples(25))
@given(st.integers(1, 9), st.integers(1, 9), st.integers(0, 1000))
def test_it_is_the_solution_of_the_dense_poisson_problem(height, width, seed):
    h = image(height, width, 1, seed)
    p = periodic_component(h)[:, :, 0].ravel()
    left = np.vstack([laplacian(height, width, periodic=True), np.full((1, height * width), 1 / (height * width))])
    right = np.append(laplacian(height, width, periodic=False) @ h.ravel(), h.mean(dtype=np.float64))
    expected = np.linalg.lstsq(left, right, rcond=None)[0]
    np.testing.assert_allclose(p, expected, atol=255 * 1e-5)


@pytest.mark.parametrize("size", SIZES)
def test_the_spectrum_is_the_transform_of_the_component(size):
    h = image(*size)
    expected = scipy.fft.rfft2(periodic_component(h).astype(np.float64), axes=(0, 1))
    assert np.abs(periodic_spectrum(h) - expected).max() <= 1e-5 * np.abs(expected).max()


def test_the_low_frequencies_of_a_large_image_are_accurate_in_single_precision():
    h = image(509, 512, 1) + np.linspace(0, 255, 512, dtype=np.float32)[None, :, None]
    jumps = np.zeros((509, 512))
    jumps[0] = h[0, :, 0] - h[-1, :, 0].astype(np.float64)
    jumps[-1] -= h[0, :, 0] - h[-1, :, 0].astype(np.float64)
    jumps[:, 0] += h[:, 0, 0] - h[:, -1, 0].astype(np.float64)
    jumps[:, -1] -= h[:, 0, 0] - h[:, -1, 0].astype(np.float64)
    k, m = np.meshgrid(np.arange(509) / 509, np.arange(257) / 512, indexing="ij")
    denominator = 4 - 2 * np.cos(2 * np.pi * k) - 2 * np.cos(2 * np.pi * m)
    denominator[0, 0] = np.inf
    expected = np.fft.rfft2(h[:, :, 0].astype(np.float64)) - np.fft.rfft2(jumps) / denominator
    error = np.abs(periodic_spectrum(h)[:, :, 0] - expected)
    assert (error[:8, :8].ravel()[1:] <= 1e-4 * np.abs(expected[:8, :8].ravel()[1:])).all()


@pytest.mark.parametrize("size", SIZES)
def test_the_mean_is_kept_and_the_components_add_up(size):
    h = image(*size)
    p, s = periodic_component(h), smooth_component(h)
    np.testing.assert_allclose(p.mean((0, 1), dtype=np.float64), h.mean((0, 1), dtype=np.float64), rtol=1e-6)
    np.testing.assert_allclose(p + s, h, atol=1e-4)


def test_an_image_whose_border_is_constant_is_its_own_periodic_component():
    h = np.full((20, 31), 40, np.float32)
    h[1:-1, 1:-1] = image(18, 29, 1)[:, :, 0]
    assert (periodic_component(h) == h).all()


@pytest.mark.parametrize("size", [*SIZES, (97, 101)])
def test_a_constant_image_is_its_own_periodic_component(size):
    h = np.full((*size, 3), np.float32(0.1))
    assert (periodic_component(h) == h).all()
    assert (smooth_component(h) == 0).all()


def test_the_cross_in_the_spectrum_of_a_photograph_goes():
    photograph = np.asarray(Image.open(SAMPLES / "soil_ground010.png").convert("L"))[100:356, 60:316]
    h = photograph.astype(np.float32) + np.linspace(0, 60, 256, dtype=np.float32)

    def along_the_axis(spectrum):
        return float((np.abs(spectrum[0, 20:]) ** 2).mean())

    assert along_the_axis(periodic_spectrum(h)) < 0.2 * along_the_axis(scipy.fft.rfft2(h))

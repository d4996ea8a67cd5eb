"""The fused engine agrees with the plain formulas, written here a second time in double precision."""

import numpy as np
import pytest

from app.synthesis.fourier.field import Noise, NoiseField
from app.synthesis.fourier.spectral import half_spectrum
from app.synthesis.gaussian.adsn import white_noise
from app.synthesis.gaussian.rpn import random_phase
from app.synthesis.parallel import Team


def synthesize(h, noise, threads=1):
    with Team(threads) as team:
        return NoiseField(h, noise, team).array()


def plain_periodic(h):
    """Δp = Δᵢh by full complex transforms of the Laplacian."""
    height, width = h.shape[:2]
    inner = np.zeros_like(h)
    inner[1:] += h[1:] - h[:-1]
    inner[:-1] += h[:-1] - h[1:]
    inner[:, 1:] += h[:, 1:] - h[:, :-1]
    inner[:, :-1] += h[:, :-1] - h[:, 1:]
    k, m = np.meshgrid(np.arange(height) / height, np.arange(width) / width, indexing="ij")
    laplacian = 4 - 2 * np.cos(2 * np.pi * k) - 2 * np.cos(2 * np.pi * m)
    laplacian[0, 0] = 1
    spectrum = np.fft.fft2(inner, axes=(0, 1)) / laplacian[:, :, None]
    spectrum[0, 0] = h.sum((0, 1))
    return np.fft.ifft2(spectrum, axes=(0, 1)).real


def plain_bump(n, alpha):
    """Primitive by the trapezium rule on a fine grid."""
    t = np.linspace(0, alpha, 20001)
    with np.errstate(divide="ignore"):
        values = np.exp(-1 / (1 - (2 * t / alpha - 1) ** 2))
    primitive = np.append(0, np.cumsum(values[1:] + values[:-1]))
    x = (np.arange(n) + 0.5) / n
    phi = np.interp(np.minimum(x, 1 - x), t, primitive / primitive[-1])
    return phi / np.sqrt((phi**2).mean())


def plain_gaussian(n, alpha):
    """exp(−(α − t)² / (2σ²)) with σ = α/4 up to α, and 1 beyond."""
    t = (np.arange(n) + 0.5) / n
    t = np.minimum(t, 1 - t)
    phi = np.exp(-(np.maximum(alpha - t, 0) ** 2) / (2 * (alpha / 4) ** 2)) if alpha else np.ones(n)
    return phi / np.sqrt((phi**2).mean())


def plain_window(n, noise):
    if noise.window == "gaussian":
        return plain_gaussian(n, noise.alpha)
    return plain_bump(n, noise.alpha) if noise.alpha else np.ones(n)


def plain(h, noise):
    """RPN and ADSN by the letter of the articles, and the extended spot with the variance of p."""
    p = plain_periodic(h.astype(np.float64)) if noise.periodic else h.astype(np.float64)
    (rows, columns), mean = h.shape[:2], p.mean((0, 1))
    spot = np.zeros((noise.height, noise.width, h.shape[2]))
    down = plain_window(rows, noise) if noise.height > rows else np.ones(rows)
    across = plain_window(columns, noise) if noise.width > columns else np.ones(columns)
    top, left = (noise.height - rows) // 2, (noise.width - columns) // 2
    spot[top : top + rows, left : left + columns] = (p - mean) * down[:, None, None] * across[None, :, None]
    spot *= np.sqrt(p.var((0, 1)).sum() / spot.var((0, 1)).sum())
    half = half_spectrum(noise.draw, noise.height, noise.width, noise.seed).astype(np.complex128)
    half[0, 0] = 0
    factors = np.fft.fft2(np.fft.irfft2(half, s=(noise.height, noise.width)))
    spectrum = np.fft.fft2(spot, axes=(0, 1))
    if noise.phase == "replace":
        spectrum = np.abs(spectrum)
    z = np.fft.ifft2(spectrum * factors[:, :, None], axes=(0, 1))
    assert np.abs(z.imag).max() <= 1e-9 * np.abs(z.real).max()
    smooth = h - p if noise.add_smooth else 0
    return mean + z.real + smooth


@pytest.mark.parametrize("draw", [random_phase, white_noise])
@pytest.mark.parametrize("options", [{}, {"phase": "replace"}, {"add_smooth": True}, {"periodic": False}])
@pytest.mark.parametrize("size", [(64, 64), (65, 97), (101, 128), (1, 50), (50, 1), (2, 200)])
def test_at_the_same_size_it_agrees_with_the_plain_formula(size, options, draw):
    h = np.random.default_rng(0).uniform(0, 255, (*size, 3)).astype(np.float32)
    noise = Noise(draw, *size, seed=11, **options)
    np.testing.assert_allclose(synthesize(h, noise, threads=2), plain(h, noise), atol=255 * 1e-5)


@pytest.mark.parametrize("draw", [random_phase, white_noise])
@pytest.mark.parametrize("options", [{}, {"phase": "replace"}, {"periodic": False}])
@pytest.mark.parametrize("size", [(128, 128), (131, 99), (64, 300), (70, 64)])
def test_at_a_larger_size_it_agrees_with_the_plain_formula(size, options, draw):
    h = np.random.default_rng(1).uniform(0, 255, (64, 64, 2)).astype(np.float32)
    noise = Noise(draw, *size, seed=12, alpha=0.2, **options)
    np.testing.assert_allclose(synthesize(h, noise, threads=2), plain(h, noise), atol=255 * 1e-5)


@pytest.mark.parametrize("draw", [random_phase, white_noise])
@pytest.mark.parametrize("profile", ["bump", "gaussian"])
@pytest.mark.parametrize("alpha", [0, 0.01, 0.1, 0.5])
def test_with_every_window_it_agrees_with_the_plain_formula(profile, alpha, draw):
    h = np.random.default_rng(3).uniform(0, 255, (40, 50, 2)).astype(np.float32)
    noise = Noise(draw, 61, 90, seed=13, alpha=alpha, window=profile)
    np.testing.assert_allclose(synthesize(h, noise, threads=2), plain(h, noise), atol=255 * 1e-5)


@pytest.mark.parametrize("size", [(40, 50), (90, 77)])
def test_the_power_is_the_squared_modulus_of_the_noise(size):
    h = np.random.default_rng(2).uniform(0, 255, (40, 50, 3)).astype(np.float32)
    noise = Noise(white_noise, *size, seed=3)
    with Team(2) as team:
        power = NoiseField(h, noise, team).power()
    z = synthesize(h, noise)
    expected = (np.abs(np.fft.rfft2(z - z.mean((0, 1), dtype=np.float64), axes=(0, 1))) ** 2).mean(2)
    np.testing.assert_allclose(power, expected, atol=1e-5 * expected.max())


@pytest.mark.parametrize("order", ["rows", "columns"])
def test_it_does_not_mind_how_the_sample_lies_in_memory(order):
    h = np.random.default_rng(4).uniform(0, 255, (30, 40, 3)).astype(np.float32)
    other = np.asfortranarray(h) if order == "columns" else np.repeat(h, 2, axis=0)[::2]
    for size in ((30, 40), (60, 61)):
        assert (synthesize(other, Noise(random_phase, *size)) == synthesize(h, Noise(random_phase, *size))).all()


def test_the_sample_is_not_changed():
    h = np.random.default_rng(5).uniform(0, 255, (30, 40, 3)).astype(np.float32)
    before = h.copy()
    synthesize(h, Noise(random_phase, 30, 40))
    synthesize(h, Noise(random_phase, 60, 41))
    synthesize(h, Noise(random_phase, 60, 41, periodic=False))
    assert (h == before).all()


def test_rows_come_each_once_and_as_often_as_asked_for():
    h = np.random.default_rng(6).uniform(0, 255, (30, 40, 1)).astype(np.float32)
    with Team(2) as team:
        field = NoiseField(h, Noise(random_phase, 150, 90), team).randomise()
        for _ in range(2):
            seen = []
            field.emit(lambda first, planes, seen=seen: seen.extend(first + y for y in range(len(next(planes)))))
            assert sorted(seen) == list(range(150))

"""Mixtures are barycentres of Gaussian models: ends, symmetry, constant speed, and the fixed point.

A model is read off a texture: its spectrum, divided by the white noise of the seed, is the spot's.
"""

import itertools

import numpy as np
import pytest

from app.synthesis.fourier.spectral import half_spectrum
from app.synthesis.gaussian.adsn import adsn, white_noise
from app.synthesis.gaussian.mixing import mix

SIZES = [(16, 16), (17, 20), (37, 41), (1, 12), (12, 1)]


def image(height, width, channels=3, seed=0):
    """Correlated channels with values of 0–255, streaked along one axis or the other."""
    rng = np.random.default_rng(seed)
    common = rng.uniform(0, 100, (height, width, 1))
    own = rng.uniform(0, 155, (height, width, channels)) * rng.uniform(0.2, 1, channels)
    return np.cumsum(common + own, axis=seed % 2).astype(np.float32) % 256


def spot(texture, seed=1):
    """Spectrum of the texture's spot, (H, W // 2 + 1, C), the mean apart."""
    height, width = texture.shape[:2]
    spectrum = np.fft.rfft2(texture.astype(np.float64), axes=(0, 1))
    spectrum[0, 0] = 0
    return spectrum / half_spectrum(white_noise, height, width, seed)[:, :, None]


def inner(f, g):
    """f* g at every frequency."""
    return (f.conj() * g).sum(axis=2)


def covariances(f):
    """f f*: what a Gaussian model is told by."""
    return f[:, :, :, None] * f[:, :, None, :].conj()


def assert_same_model(f, g):
    scale = max(np.abs(f).max(), np.abs(g).max(), 1) ** 2
    np.testing.assert_allclose(covariances(f), covariances(g), atol=1e-4 * scale)


def distance(f, g):
    """Wasserstein distance of two models without their means."""
    squares = inner(f, f).real + inner(g, g).real - 2 * np.abs(inner(f, g))
    return np.sqrt(squares.clip(0).sum())


def along(first, second, rho, **options):
    return mix([first, second], [1 - rho, rho], seed=1, **options)


@pytest.mark.parametrize("size", [(16, 16), (40, 51)])
def test_a_path_begins_with_the_adsn_of_the_first_sample(size):
    first, second = image(16, 16, seed=1), image(20, 12, seed=2)
    assert (along(first, second, 0, height=size[0], width=size[1]) == adsn(first, *size, seed=1)).all()


@pytest.mark.parametrize("size", [(16, 16), (40, 51)])
def test_a_path_ends_with_the_model_of_the_second_sample(size):
    """The modulus of its ADSN and all phase differences between channels; at each frequency it may be turned."""
    first, second = image(16, 16, seed=1), image(20, 12, seed=2)
    end = along(first, second, 1, height=size[0], width=size[1])
    own = adsn(second, *size, seed=1)
    assert_same_model(spot(end), spot(own))
    np.testing.assert_allclose(end.mean((0, 1)), own.mean((0, 1)), rtol=1e-5)


@pytest.mark.parametrize("size", SIZES)
def test_in_between_is_the_formula_of_the_geodesic(size):
    first, second = image(*size, seed=1), image(*size, seed=2)
    f, g = spot(adsn(first, seed=1)), spot(adsn(second, seed=1))
    product = inner(g, f)
    turn = product / np.where(product == 0, 1, np.abs(product)) + (product == 0)
    for rho in (0.25, 0.5):
        made = spot(along(first, second, rho))
        np.testing.assert_allclose(made, (1 - rho) * f + rho * g * turn[:, :, None], atol=2e-4 * np.abs(f).max())


@pytest.mark.parametrize("size", SIZES)
def test_the_path_is_symmetric_in_its_arguments(size):
    first, second = image(*size, seed=1), image(*size, seed=2)
    for rho in (0.2, 0.5):
        assert_same_model(spot(along(first, second, rho)), spot(along(second, first, 1 - rho)))


@pytest.mark.parametrize("size", SIZES)
def test_it_is_a_geodesic_of_constant_speed(size):
    """Distances along it are differences of ρ times the whole distance, in the closed form for two models."""
    first, second = image(*size, seed=1), image(*size, seed=2)
    path = {rho: spot(along(first, second, rho)) for rho in (0, 0.3, 0.8, 1)}
    whole = distance(path[0], path[1])
    assert whole > 0
    for (start, f), (end, g) in itertools.combinations(path.items(), 2):
        expected = (end - start) * whole
        assert distance(f, g) == pytest.approx(expected, abs=1e-3 * whole)


def test_the_textures_at_both_ends_are_as_near_as_any_of_these_models():
    """With one noise, their distance is the models' in the mean over draws; this texture's noise is divided out."""
    first, second = image(24, 30, seed=1), image(24, 30, seed=2)
    f, g = (spot(along(first, second, rho)) for rho in (0, 1))
    assert np.sqrt((np.abs(f - g) ** 2).sum()) == pytest.approx(distance(f, g), rel=1e-3)


def test_a_grey_mixture_averages_the_moduli_that_is_the_textons():
    first, second = image(24, 30, 1, seed=1), image(24, 30, 1, seed=2)
    f, g, made = (np.abs(spot(along(first, second, rho))) for rho in (0, 1, 0.3))
    np.testing.assert_allclose(made, 0.7 * f + 0.3 * g, atol=1e-4 * f.max())


def test_contrast_does_not_sink_in_the_middle_as_a_cross_fade_of_two_noises_would_make_it():
    """Two spots of like moduli: the middle has their energy, where independent noises would leave half of it."""
    first, second = image(64, 64, 1, seed=1), image(64, 64, 1, seed=1)[::-1, ::-1]
    energies = [np.var(along(first, second, rho)) for rho in (0, 0.5, 1)]
    np.testing.assert_allclose(energies, energies[0], rtol=1e-3)


@pytest.mark.parametrize("weights", [[1, 1], [1, 3], [1, 2, 3], [2, 0, 1, 1]])
def test_the_mean_is_the_average_of_the_means(weights):
    samples = [image(12, 15, seed=number) for number in range(len(weights))]
    expected = np.average([sample.mean((0, 1), dtype=np.float64) for sample in samples], axis=0, weights=weights)
    for size in ((12, 15), (30, 31)):
        np.testing.assert_allclose(mix(samples, weights, *size).mean((0, 1), dtype=np.float64), expected, rtol=1e-6)


def three(count=3, size=(32, 33)):
    samples, weights = [image(*size, seed=number) for number in range(count)], np.arange(1, count + 1)
    spots = [spot(adsn(sample, seed=1)) for sample in samples]
    return weights / weights.sum(), spots, spot(mix(samples, list(weights), seed=1))


@pytest.mark.parametrize("count", [3, 4])
def test_the_barycentre_is_a_fixed_point(count):
    weights, spots, f = three(count)
    again = 0
    for weight, g in zip(weights, spots, strict=True):
        product = inner(g, f)
        again = again + weight * g * (product / np.maximum(np.abs(product), 1e-9))[:, :, None]
    assert np.sqrt((np.abs(again - f) ** 2).sum()) <= 1e-3 * np.sqrt((np.abs(f) ** 2).sum())


def test_the_barycentre_of_three_is_that_of_the_gaussian_models_with_any_noises():
    """The dual certificate of the article's problem over all couplings, frequency by frequency.

    With Mᵢⱼ = wᵢ wⱼ f̂ᵢ* f̂ⱼ and λᵢ = (M u)ᵢ / uᵢ, correlations u u* are best if diag(λ) − M has no eigenvalue below 0.
    """
    weights, spots, f = three()
    weighted = np.stack([weight * g for weight, g in zip(weights, spots, strict=True)])
    gram = np.einsum("iyxc,jyxc->yxij", weighted.conj(), weighted)
    slack = -gram
    for i, g in enumerate(weighted):
        slack[:, :, i, i] += np.abs(inner(g, f))
    eigenvalues = np.linalg.eigvalsh(slack)[:, 1:-1].min(axis=2)  # without the columns that hold real frequencies
    scale = np.trace(gram, axis1=2, axis2=3).real[:, 1:-1]
    assert (eigenvalues >= -2e-3 * scale).all()


@pytest.mark.parametrize("count", [3, 4])
def test_no_other_phases_make_a_greater_barycentre(count):
    weights, spots, f = three(count, (16, 17))
    greatest = inner(f, f).real
    rng = np.random.default_rng(0)
    for _ in range(200):
        turns = np.exp(2j * np.pi * rng.random((count, *greatest.shape)))
        other = sum(w * g * turn[:, :, None] for w, g, turn in zip(weights, spots, turns, strict=True))
        assert (inner(other, other).real[:, 1:-1] <= (1 + 1e-3) * greatest[:, 1:-1] + 1e-3).all()


def test_the_order_of_three_samples_does_not_matter_to_the_model():
    samples, weights = [image(16, 17, seed=number) for number in range(3)], [1, 2, 4]
    turned = mix(samples[1:] + samples[:1], weights[1:] + weights[:1], seed=1)
    assert_same_model(spot(mix(samples, weights, seed=1)), spot(turned))


def test_all_the_weight_on_one_sample_gives_its_model():
    samples = [image(16, 17, seed=number) for number in range(3)]
    assert (mix(samples, [1, 0, 0], seed=1) == adsn(samples[0], seed=1)).all()
    assert_same_model(spot(mix(samples, [0, 0, 5], seed=1)), spot(adsn(samples[2], seed=1)))


def test_samples_of_colours_that_have_nothing_in_common_mix_too():
    red, green = image(16, 18, seed=1) * [1, 0, 0], image(16, 18, seed=2) * [0, 1, 0]
    made = along(red.astype(np.float32), green.astype(np.float32), 0.5)
    ends = [adsn(sample.astype(np.float32), seed=1) for sample in (red, green)]
    np.testing.assert_allclose(made, (ends[0] + ends[1]) / 2, atol=1e-3)


@pytest.mark.parametrize("count", [2, 3])
def test_the_result_depends_on_the_seed_and_not_on_the_threads(count):
    samples = [image(30 + number, 40, seed=number) for number in range(count)]
    one = mix(samples, height=70, width=90, seed=3)
    assert (mix(samples, height=70, width=90, seed=3, threads=2) == one).all()
    assert (mix(samples, height=70, width=90, seed=4) != one).mean() > 0.99


def test_samples_that_differ_in_channels_are_refused():
    with pytest.raises(ValueError, match="channels"):
        mix([image(8, 8, 1), image(8, 8, 3)])


def test_the_progress_of_every_stage_rises_to_one():
    samples, calls = [image(64, 64, seed=number) for number in range(3)], []
    mix(samples, height=200, width=200, threads=2, progress=lambda stage, part: calls.append((stage, part)))
    for stage in ("spot", "random phase", "texture"):
        parts = [part for name, part in calls if name == stage]
        assert parts == sorted(parts)
        assert parts[-1] == 1
    assert calls == sorted(calls, key=lambda call: ("spot", "random phase", "texture").index(call[0]))


@pytest.mark.parametrize("profile", ["bump", "gaussian"])
@pytest.mark.parametrize("alpha", [0, 0.3, 0.5])
def test_an_end_of_the_path_is_the_adsn_with_the_same_window(profile, alpha):
    one, other = (np.random.default_rng(seed).uniform(0, 255, (20, 24, 3)).astype(np.float32) for seed in (0, 1))
    z = mix([one, other], [1, 0], 33, 50, seed=2, alpha=alpha, window=profile)
    assert (z == adsn(one, 33, 50, seed=2, alpha=alpha, window=profile)).all()

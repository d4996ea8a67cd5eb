"""The texton has the sample's modulus and no phase, and its noise is the sample's."""

import numpy as np
import pytest
from scipy import stats

from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.fourier.spectral import half_spectrum
from app.synthesis.gaussian.adsn import adsn, white_noise
from app.synthesis.gaussian.cut_texton import cut_texton
from app.synthesis.gaussian.texton import extend_texton, radii, texton, texton_noise
from app.synthesis.luminance import luminance
from tests.synthesis.images import correlations, whole
from tests.synthesis.stopping import stops_at

SIZES = [(1, 1), (1, 12), (12, 1), (2, 3), (16, 16), (16, 17), (37, 41)]
LARGER = [(40, 51), (70, 90), (41, 52), (40, 130)]
LIKELY = 1e-3  # a seed is pinned; a p-value below this says that the law is wrong


def image(height, width, channels=3, seed=0):
    """Channels that are correlated and displaced against each other."""
    rng = np.random.default_rng(seed)
    common, own = rng.uniform(0, 155, (height, width)), rng.uniform(0, 100, (height, width, channels))
    return (own + np.stack([np.roll(common, channel, 1) for channel in range(channels)], 2)).astype(np.float32)


def spectrum(picture):
    return np.fft.rfft2(picture.astype(np.float64), axes=(0, 1))


def at_origin(t):
    """The texton with its origin at pixel (0, 0)."""
    return np.fft.ifftshift(t, axes=(0, 1))


def made(h, height, width, cut=None):
    """The extended texton of h, or what a cut leaves of it."""
    mean = h.mean((0, 1), dtype=np.float64)
    if cut is None:
        return [extend_texton(texton(h), mean, height, width)]
    return cut_texton(h, mean, height, width, cut).spots


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("channels", [1, 3, 4])
def test_every_channel_keeps_its_modulus_and_its_phase_displacements(size, channels):
    h = image(*size, channels)
    before, after = spectrum(periodic_component(h)), spectrum(texton(h))
    before[0, 0] = 0  # the mean is kept apart
    scale = max(np.abs(before).max(), 1)
    np.testing.assert_allclose(np.abs(after), np.abs(before), atol=1e-5 * scale)
    for c in range(channels):
        for d in range(c):
            # t_c conj t_d = p_c conj p_d: both moduli and the difference of the phases at once
            np.testing.assert_allclose(
                after[:, :, c] * after[:, :, d].conj(), before[:, :, c] * before[:, :, d].conj(), atol=1e-5 * scale**2
            )


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("channels", [1, 3])
def test_the_luminance_has_no_phase(size, channels):
    t = at_origin(texton(image(*size, channels)))
    phaseless = spectrum(luminance(t))
    scale = np.abs(phaseless).max()
    assert np.abs(phaseless.imag).max() <= 1e-5 * scale
    assert phaseless.real.min() >= -1e-5 * scale


def test_a_grey_texton_is_even_and_greatest_at_its_origin():
    t = at_origin(texton(image(21, 24, 1)))[:, :, 0]
    np.testing.assert_allclose(t, np.roll(t[::-1, ::-1], 1, (0, 1)), atol=1e-4)
    assert t.argmax() == 0


@pytest.mark.parametrize("channels", [1, 3])
def test_its_autocorrelation_and_so_its_noises_covariance_is_the_samples(channels):
    h = image(40, 51, channels)
    expected = correlations(periodic_component(h).astype(np.float64))
    np.testing.assert_allclose(correlations(whole(made(h, 40, 51)[0])), expected, atol=1e-5 * expected.max())


@pytest.mark.parametrize("channels", [1, 3])
def test_its_noise_is_the_adsn_of_the_sample_at_the_same_seed(channels):
    h = image(40, 51, channels)
    np.testing.assert_allclose(texton_noise(h, made(h, 40, 51), seed=3), adsn(h, seed=3), atol=1e-3)


@pytest.mark.parametrize("size", LARGER)
@pytest.mark.parametrize("cut", [None, 1, 9])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_its_luminance_has_the_phase_of_rpn_and_adsn_at_any_size_and_cut(size, channels, cut):
    h = image(40, 51, channels)
    noise = texton_noise(h, made(h, *size, cut), seed=6)
    z, a = (spectrum(luminance(z)) for z in (noise, adsn(h, *size, seed=6)))
    strong = (np.abs(a) > 1e-2 * np.abs(a[1:]).max()) & (np.abs(z) > 1e-2 * np.abs(z[1:]).max())
    assert strong.mean() > 0.5
    np.testing.assert_allclose(np.angle(z / a)[strong], 0, atol=2e-3)


@pytest.mark.parametrize("size", LARGER)
def test_its_noise_is_the_adsn_of_the_extended_texton(size):
    """The white noise behind it: one for all channels, of Rayleigh modulus, its phase uniform."""
    h = image(40, 51)
    (spot,) = made(h, *size)
    noise = spectrum(texton_noise(h, [spot], seed=6))[:, 1:-1] / spectrum(whole(spot))[:, 1:-1]
    strong = np.abs(spectrum(whole(spot)))[:, 1:-1] > 1e-2 * np.abs(spectrum(whole(spot)))[1:].max()
    for channel in range(3):
        both = strong[:, :, 0] & strong[:, :, channel]
        np.testing.assert_allclose(noise[:, :, channel][both], noise[:, :, 0][both], rtol=1e-2)
    drawn = half_spectrum(white_noise, *size, seed=6)[:, 1:-1][strong[:, :, 0]]
    noise = noise[:, :, 0][strong[:, :, 0]]
    np.testing.assert_allclose(np.abs(noise), np.abs(drawn), rtol=1e-2)
    assert stats.kstest(np.angle(noise), stats.uniform(-np.pi, 2 * np.pi).cdf).pvalue > LIKELY


@pytest.mark.slow
@pytest.mark.parametrize("cut", [None, 3])
def test_the_covariance_of_many_draws_is_the_autocorrelation_of_the_extended_texton(cut):
    h, draws = image(6, 5, 2), 600
    spots = made(h, 9, 12, cut)
    expected = sum(correlations(whole(spot)) for spot in spots)
    seen = np.array([correlations(texton_noise(h, spots, seed=seed).astype(np.float64)) for seed in range(draws)])
    error = seen.std(0) / np.sqrt(draws)
    # a few hundred values, each a mean of 600 draws with this standard error
    assert (np.abs(seen.mean(0) - expected) <= 4.5 * error + 1e-4 * expected.max()).all()


@pytest.mark.parametrize("size", LARGER)
def test_r_keeps_the_mean_and_the_covariance_of_the_colours(size):
    h = image(40, 51)
    (spot,) = made(h, *size)
    expected = np.cov(periodic_component(h).reshape(-1, 3).T, bias=True)
    np.testing.assert_allclose(correlations(whole(spot))[0, 0], expected, rtol=1e-4)
    np.testing.assert_allclose(texton_noise(h, [spot], seed=1).mean((0, 1)), h.mean((0, 1)), rtol=1e-5)


@pytest.mark.parametrize("cut", [None, 3])
def test_a_constant_sample_gives_itself_back(cut):
    h = np.full((8, 9, 3), [0, 77, 255], np.float32)
    assert (texton_noise(h, made(h, 16, 17, cut), seed=1) == [0, 77, 255]).all()
    assert radii(texton(h), [0.5, 0.99]) == [0, 0]


@pytest.mark.parametrize("cut", [None, 7])
def test_a_channel_without_contrast_stays_as_it_is(cut):
    h = image(20, 21)
    h[:, :, 1] = 90
    z = texton_noise(h, made(h, 30, 31, cut), seed=1)
    assert np.isfinite(z).all()
    np.testing.assert_allclose(z[:, :, 1], 90, atol=1e-3)


def test_the_radii_hold_their_parts_of_the_energy():
    """A Gaussian exp(−d²/2σ²) has the part 1 − exp(−R²/σ²) of its energy within R."""
    y, x = np.mgrid[:128, :129]
    square, deviation = (y - 64) ** 2 + (x - 64) ** 2, 7
    t = np.exp(-square / (2 * deviation**2)).astype(np.float32)[:, :, None]
    parts = [0.1, 0.5, 0.9, 0.99]
    found = radii(t, parts)
    np.testing.assert_allclose(found, deviation * np.sqrt(-np.log1p(-np.array(parts))), atol=0.3)
    for part, radius in zip(parts, found, strict=True):
        energy = t[:, :, 0].astype(np.float64) ** 2
        assert energy[square <= radius**2 + 0.5].sum() >= part * energy.sum() > energy[square < radius**2 - 0.5].sum()


def test_the_radii_grow_with_their_parts_and_end_at_the_furthest_pixel():
    found = radii(texton(image(40, 51)), [0.01, 0.5, 0.9, 0.99, 1])
    assert found == sorted(found)
    assert found[-1] == pytest.approx(np.hypot(20, 25))


def test_half_the_energy_of_a_white_noises_texton_is_in_one_point():
    """Its modulus is Rayleigh, and (E R)² / E R² = π/4 of the energy comes from the modulus' mean, a single peak."""
    h = np.random.default_rng(0).normal(0, 1, (128, 129, 1)).astype(np.float32)
    t = texton(h)
    # The mean of 8256 independent moduli is known to 0.6 %, its square to 1.2 %; the periodic component adds a little.
    assert (t[64, 64, 0] ** 2 / (t**2).sum()) == pytest.approx(np.pi / 4, rel=0.03)
    assert radii(t, [0.5]) == [0]


@pytest.mark.parametrize("cut", [None, 9])
def test_the_result_does_not_depend_on_the_threads(cut):
    h = image(40, 51)
    spots = made(h, 133, 190, cut)
    one = texton_noise(h, spots, seed=3)
    assert (texton(h, threads=2) == texton(h)).all()
    assert (texton_noise(h, spots, seed=3, threads=2) == one).all()
    assert (texton_noise(h, spots, seed=4) != one).mean() > 0.99


@pytest.mark.parametrize("stop_at", [1, 3, 5])
def test_what_the_progress_raises_stops_the_work(stop_at):
    h = image(16, 16)
    spots = made(h, 20, 20)
    stops_at(stop_at, lambda progress: texton_noise(h, spots, progress=progress))

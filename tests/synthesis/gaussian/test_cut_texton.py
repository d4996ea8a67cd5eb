"""A cut texton keeps the covariance of the colours, and says how far that of two places is off."""

import numpy as np
import pytest

from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.gaussian.adsn import adsn
from app.synthesis.gaussian.cut_texton import cut_texton, lag_error
from app.synthesis.gaussian.texton import texton, texton_noise
from tests.synthesis.images import along_colours, correlations, covariance, photograph, whole
from tests.synthesis.stopping import stops_at

SIZES = [(1, 1), (1, 12), (12, 1), (2, 3), (16, 16), (37, 41), (40, 51)]
CUTS = [1, 2, 3, 9, 38, 500]


def image(height, width, channels=3, seed=0):
    """Channels of unlike contrast that are correlated, displaced and smooth to different degrees."""
    rng = np.random.default_rng(seed)
    common = rng.uniform(0, 155, (height, width))
    planes = []
    for channel in range(channels):
        own = rng.uniform(0, 20 * (channel + 1), (height, width))
        plane = np.roll(common, channel, 1) + own
        for _ in range(channel):
            plane = (plane + np.roll(plane, 1, 0) + np.roll(plane, 1, 1)) / 3
        planes.append(plane)
    return np.stack(planes, 2).astype(np.float32)


def cut(h, height, width, size):
    return cut_texton(h, h.mean((0, 1), dtype=np.float64), height, width, size)


def of_model(spots):
    """Covariance of the model's colours at every lag: its noises are independent and white."""
    return sum(correlations(whole(spot)) for spot in spots)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("channels", [1, 2, 3, 5])
@pytest.mark.parametrize("kept", CUTS)
def test_the_covariance_of_the_colours_is_the_samples(size, channels, kept):
    """Along every axis of the colours, also the weakest, and at the texture's own size and a larger one."""
    h = image(*size, channels)
    wanted = covariance(periodic_component(h))
    for larger in (size, (size[0] + 30, size[1]), (2 * size[0] + 1, 3 * size[1])):
        found = of_model(cut(h, *larger, kept).spots)[0, 0]
        if wanted.max() > 1e-3:
            assert along_colours(found, wanted) < 1e-3
        np.testing.assert_allclose(found, wanted, atol=1e-4 * wanted.max() + 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "place"), [("leaves_forest_floor", (256, 256)), ("rockface_pink", (190, 60))])
@pytest.mark.parametrize("kept", [65, 15, 1])
def test_textures_of_photographs_keep_their_colours(name, place, kept):
    """The mean covariance of 24 draws along every axis of the colours: to a fiftieth, and four standard errors.

    That of the differences of colours fell to a fifth and a tenth once: leaves turned sepia.
    """
    h = photograph(name, *place)
    wanted = covariance(periodic_component(h))
    spots = cut(h, 256, 256, kept).spots
    assert along_colours(of_model(spots)[0, 0], wanted) < 0.001
    draws = np.array([covariance(texton_noise(h, spots, seed=seed)) for seed in range(24)])
    spread = np.max([along_colours(draw, draws.mean(0)) for draw in draws])
    assert along_colours(draws.mean(0), wanted) < 0.02 + 4 * spread / np.sqrt(24)
    red_to_blue = [c[0, 2] / np.sqrt(c[0, 0] * c[2, 2]) for c in (draws.mean(0), wanted)]
    assert red_to_blue[0] == pytest.approx(red_to_blue[1], abs=0.02)


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize(
    ("size", "kept"), [((40, 51), 9), ((41, 51), 1), ((70, 90), 9), ((80, 51), 45), ((40, 99), 38)]
)
def test_the_error_at_two_places_is_that_of_all_lags_compared_one_by_one(channels, size, kept):
    """In double precision, and by translation: a lag is the way from a pixel to another one within half the sample."""
    h = image(40, 51, channels)
    spots = cut(h, *size, kept).spots
    own, model = correlations(periodic_component(h).astype(np.float64)), of_model(spots)
    errors = np.empty((40, 51))
    for y, x in np.ndindex(40, 51):
        lag = (y + 20) % 40 - 20, (x + 25) % 51 - 25
        errors[y, x] = np.linalg.norm(own[y, x] - model[lag[0] % size[0], lag[1] % size[1]])
    error, distance = lag_error(h, spots)
    assert error == pytest.approx(errors.max() / np.linalg.norm(own[0, 0]), rel=1e-3)
    place = np.unravel_index(errors.argmax(), errors.shape)
    assert distance == pytest.approx(np.hypot(min(place[0], 40 - place[0]), min(place[1], 51 - place[1])))


def test_the_error_falls_as_more_is_kept_and_is_nothing_for_the_whole():
    h = photograph("rockface_pink", 190, 60, 128)
    errors = [lag_error(h, cut(h, 128, 128, kept).spots)[0] for kept in (1, 7, 31, 128)]
    assert errors == sorted(errors, reverse=True)
    assert errors[0] > 0.4
    assert errors[-1] < 1e-5


@pytest.mark.parametrize("channels", [1, 2, 3])
def test_whole_its_noise_is_the_adsn_of_the_sample_at_the_same_seed(channels):
    """The root of what rounds to 1e-7 of a power is 3e-4 of an amplitude, and these have a deviation of 45 levels."""
    h = image(40, 51, channels)
    np.testing.assert_allclose(texton_noise(h, cut(h, 40, 51, 99).spots, seed=3), adsn(h, seed=3), atol=0.2)


@pytest.mark.parametrize(("kept", "inside"), [(1, (1, 1)), (4, (4, 4)), (9, (9, 9)), (45, (40, 45))])
def test_of_a_grey_sample_it_is_the_square_around_the_textons_origin(kept, inside):
    h = image(40, 51, 1)
    made = cut(h, 70, 90, kept)
    (spot,), (gain,), t = made.spots, made.gains, texton(h)[:, :, 0]
    top, left = 20 - inside[0] // 2, 25 - inside[1] // 2
    assert spot.planes.shape == (1, *inside)
    np.testing.assert_allclose(
        spot.planes[0], gain * t[top : top + inside[0], left : left + inside[1]], atol=1e-4 * gain * t.max()
    )
    assert gain > np.sqrt(70 * 90 / (40 * 51))


@pytest.mark.parametrize("kept", [1, 7])
def test_grey_that_is_stored_in_three_channels_takes_one_noise_and_stays_grey(kept):
    h = image(20, 21, 1)
    spots = cut(np.repeat(h, 3, axis=2), 30, 31, kept).spots
    assert len(spots) == 1
    z = texton_noise(np.repeat(h, 3, axis=2), spots, seed=1)
    np.testing.assert_allclose(z, np.repeat(texton_noise(h, cut(h, 30, 31, kept).spots, seed=1), 3, axis=2), atol=1e-2)


def test_colours_on_one_plane_take_two_noises_and_stay_on_it():
    h = image(20, 21, 3)
    h[:, :, 2] = 0.5 * h[:, :, 0] + 0.25 * h[:, :, 1]
    spots = cut(h, 30, 31, 5).spots
    assert len(spots) == 2
    z = texton_noise(h, spots, seed=1)
    np.testing.assert_allclose(z[:, :, 2], 0.5 * z[:, :, 0] + 0.25 * z[:, :, 1], atol=0.02)


def test_the_strongest_colours_come_first():
    gains_of = cut(photograph("leaves_forest_floor", 256, 256, 128), 128, 128, 15)
    energies = [float(np.square(spot.planes).sum()) for spot in gains_of.spots]
    assert energies == sorted(energies, reverse=True)


def test_another_seed_gives_other_colours_too():
    """What a luminance does not say comes from noises of its own, which hang on the seed as well."""
    h = photograph("leaves_forest_floor", 256, 256, 128)
    spots = cut(h, 128, 128, 15).spots
    red_less_blue = [texton_noise(h, spots, seed=seed) @ [1, 0, -1] for seed in (1, 1, 2)]
    assert (red_less_blue[0] == red_less_blue[1]).all()
    # some 80 independent stains of 15 pixels: a correlation by chance has deviation 0.11
    assert abs(np.corrcoef(red_less_blue[0].ravel(), red_less_blue[2].ravel())[0, 1]) < 0.45


@pytest.mark.parametrize("size", [(1, 1), (5, 1), (8, 9)])
def test_a_sample_without_contrast_gives_itself_back(size):
    h = np.full((*size, 3), (0, 77.1, 255), np.float32)
    made = cut(h, 20, 21, 3)
    assert (texton_noise(h, made.spots, seed=1) == h[0, 0]).all()
    assert lag_error(h, made.spots) == (0, 0)


@pytest.mark.parametrize("stop_at", [1, 4, 9])
def test_what_the_progress_raises_stops_the_work(stop_at):
    h = image(16, 16)
    mean = h.mean((0, 1), dtype=np.float64)
    stops_at(stop_at, lambda progress: cut_texton(h, mean, 20, 20, 5, progress=progress))


def plain_gains(h, height, width, kept):
    """R along the principal axes, by the formulas of the module's docstring on the whole torus in double precision."""
    p = np.moveaxis(periodic_component(h).astype(np.float64), 2, 0)
    p -= p.mean((1, 2), keepdims=True)
    rows, columns = p.shape[1:]
    colours, axes = np.linalg.eigh(np.einsum("ayx,byx->ab", p, p) / (rows * columns))
    colours, axes = colours[::-1], axes.T[::-1]
    spectra = np.fft.fft2(np.einsum("ab,byx->ayx", axes, p))
    down, across = (
        np.maximum(1 - np.abs(np.fft.fftfreq(side) * side) / (4 * kept * side / (side - kept)), 0)
        for side in (rows, columns)
    )
    faded = np.fft.ifft2(spectra[:, None] * spectra[None].conj()) * down[:, None] * across
    values, vectors = np.linalg.eigh(np.moveaxis(np.fft.fft2(faded), (0, 1), (2, 3)))
    root = (vectors * np.sqrt(np.maximum(values, 0))[:, :, None, :]) @ vectors.conj().swapaxes(2, 3)
    kernel = np.fft.ifft2(np.moveaxis(root, (2, 3), (0, 1))).real
    around = np.arange(kept) - kept // 2
    kernel = kernel[:, :, around[:, None], around]
    sums = kernel.sum((2, 3)) / (height * width)
    covariance = np.einsum("ajyx,bjyx->ab", kernel, kernel) / (height * width) - sums @ sums.T

    def power(matrix, exponent):
        found, turned = np.linalg.eigh(matrix)
        return (turned * found**exponent) @ turned.T

    half, inverse = power(covariance, 0.5), power(covariance, -0.5)
    return np.diagonal(inverse @ power(half @ np.diag(colours) @ half, 0.5) @ inverse)


@pytest.mark.parametrize("kept", [3, 5, 9])
@pytest.mark.parametrize("size", [(16, 21), (40, 50)])
def test_the_gains_are_those_of_the_formula_in_absolute_units(size, kept):
    h = image(16, 21)
    np.testing.assert_allclose(cut(h, *size, kept).gains, plain_gains(h, *size, kept), rtol=1e-3)


@pytest.mark.parametrize("channels", [1, 3])
def test_whole_the_gains_are_the_factor_of_the_extended_texton(channels):
    """r² = M₂N₂ / (M₁N₁) along every axis: nothing else is lost."""
    gains = cut(image(16, 21, channels), 40, 50, 99).gains
    np.testing.assert_allclose(gains, np.sqrt(40 * 50 / (16 * 21)), rtol=2e-3)


@pytest.mark.parametrize("channels", [1, 3])
def test_without_contrast_nothing_is_divided_by_it(channels):
    """No covariance to be off, no variance to make up for: the figures that are shown are numbers."""
    h = np.full((8, 9, channels), 77, np.float32)
    texton = cut(h, 16, 17, 3)
    assert lag_error(h, texton.spots) == (0, 0)
    assert np.isfinite(texton.gains).all()
    assert all(not spot.planes.any() for spot in texton.spots)

"""DSN: translates of a spot at random places; mean and covariance are the same for every n, and ADSN is the limit."""

import itertools

import numpy as np
import pytest
from scipy import stats

from app.synthesis.fourier.spectral import half_spectrum
from app.synthesis.fourier.spot_noise import sample_spot
from app.synthesis.gaussian.adsn import adsn, adsn_of_spot, white_noise
from app.synthesis.gaussian.dsn import POINTS, counts, dsn, excess_kurtosis, impulses, spot_shape, standard_spot
from tests.synthesis.images import correlations, image, whole
from tests.synthesis.stopping import stops_at

LIKELY = 1e-3  # a seed is pinned; a p-value below this says that the law is wrong
MANY = (256, 257)  # more pixels than 16-bit words take values: so their counts come from the table


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (16, 17), MANY])
@pytest.mark.parametrize("order", [1, 10, POINTS, 10**6, 10**9])
def test_every_spot_falls_on_one_pixel(size, order):
    drawn = counts(*size, order, seed=1)
    assert drawn.shape == size
    assert drawn.min() >= 0
    assert drawn.sum() == order


@pytest.mark.parametrize("size", [(16, 17), MANY])
def test_spots_of_a_smaller_order_are_among_those_of_a_greater_one(size):
    orders = [1, 10, 100, 1000, 10_000, 100_000, 10**7, 10**9]
    drawn = [counts(*size, order, seed=3) for order in orders]
    for fewer, more in itertools.pairwise(drawn):
        assert (fewer <= more).all()


@pytest.mark.parametrize(
    ("size", "order"), [((8, 9), 10**6), (MANY, 50_000), (MANY, 200_000), (MANY, 10**7), (MANY, 10**9)]
)
def test_the_count_of_a_pixel_is_binomial(size, order):
    """Counts of n points on N pixels: each is B(n, 1/N), and all together are nearly independent.

    The chi-square statistic Σ (c − n/N)² / (n/N) has mean N − 1 and variance 2 (N − 1) (1 − 1/n); and the values
    are distributed as the binomial law says, in cells that each expect 20 or more of them.
    """
    drawn = np.concatenate([counts(*size, order, seed).ravel() for seed in range(4)])
    pixels = size[0] * size[1]
    each = order / pixels
    excess = ((drawn - each) ** 2).sum() / each - 4 * (pixels - 1)
    assert abs(excess) < 4 * np.sqrt(4 * 2 * (pixels - 1))
    law = stats.binom(order, 1 / pixels)
    edges = np.unique(law.ppf(np.linspace(0, 1, min(30, drawn.size // 20))[1:-1]))
    expected = np.diff(law.cdf(np.concatenate([[-1], edges, [order]]))) * drawn.size
    seen = np.bincount(np.searchsorted(edges, drawn), minlength=len(expected))
    assert stats.chisquare(seen, expected * (seen.sum() / expected.sum())).pvalue > LIKELY


def test_points_are_uniform_and_pixels_independent():
    """The spectrum of the counts is that of a white noise: exponential powers, no correlation with neighbours."""
    noise = impulses(*MANY, 10**7, seed=5)
    power = np.abs(np.fft.rfft2(noise))[:, 1:] ** 2
    assert stats.kstest(power.ravel(), stats.expon.cdf).pvalue > LIKELY
    for axis in (0, 1):
        # N products of independent values of variance 1/N: their sum has variance 1/N
        assert abs((noise * np.roll(noise, 1, axis)).sum()) < 4 / np.sqrt(noise.size)


@pytest.mark.parametrize("sizes", [(6, 7, 6, 7), (6, 5, 9, 12)])
@pytest.mark.parametrize("order", [1, 3, 25])
def test_it_is_the_normalised_sum_of_translated_spots(sizes, order):
    spot = sample_spot(image(*sizes[:2]), *sizes[2:])
    h, drawn = whole(spot), counts(*sizes[2:], order, seed=4)
    total = sum(drawn[place] * np.roll(h, place, (0, 1)) for place in np.ndindex(drawn.shape))
    expected = (total - order * h.mean((0, 1))) / np.sqrt(order) + spot.mean
    np.testing.assert_allclose(dsn(spot, order, seed=4), expected, atol=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("order", [2, 30, 10**6])
def test_mean_and_covariance_are_those_of_the_spot_for_every_n(order):
    spot, draws = sample_spot(image(6, 5), 9, 12), 800
    expected = correlations(whole(spot))
    pictures = [dsn(spot, order, seed=seed).astype(np.float64) for seed in range(draws)]
    for picture in pictures[:20]:
        np.testing.assert_allclose(picture.mean((0, 1)), spot.mean, rtol=1e-5)
    seen = np.array([correlations(picture) for picture in pictures])
    error = seen.std(0) / np.sqrt(draws)
    # a few hundred values, each a mean of 800 draws with this standard error
    assert (np.abs(seen.mean(0) - expected) <= 4.5 * error + 1e-4 * expected.max()).all()


@pytest.mark.slow
def test_the_excess_kurtosis_of_a_pixel_falls_as_one_over_n():
    """E (Z − m)⁴ = σ⁴ (3 + κ/n): its mean over the pixels of 1500 draws, within 4 standard errors of that mean."""
    spot, draws = standard_spot("disc", 32, 30, radius=3, mean=0, deviation=1), 1500
    kurtosis = excess_kurtosis(spot)[0]
    assert kurtosis > 25
    for order in (4, 16, 64):
        fourth = np.array([(dsn(spot, order, seed=seed).astype(np.float64) ** 4).mean() for seed in range(draws)])
        error = fourth.std() / np.sqrt(draws)
        assert error < 0.2 * kurtosis / order  # precise enough to tell 1/n from another power
        assert abs(fourth.mean() - 3 - kurtosis / order) < 4 * error


@pytest.mark.slow
def test_for_large_n_a_pixel_has_the_law_of_the_adsns():
    spot, draws = sample_spot(image(8, 8, 1), 8, 8), 600
    many = np.array([dsn(spot, 10**8, seed=seed)[3, 5, 0] for seed in range(draws)])
    limit = np.array([adsn_of_spot(spot, seed)[3, 5, 0] for seed in range(draws)])
    assert stats.ks_2samp(many, limit).pvalue > LIKELY
    assert stats.kstest(many, stats.norm(spot.mean[0], whole(spot).std()).cdf).pvalue > LIKELY
    # the excess kurtosis of n normal values has deviation sqrt(24 / n)
    assert abs(stats.kurtosis(many)) < 4 * np.sqrt(24 / draws)


def test_for_large_n_the_white_noise_has_the_law_of_the_adsns():
    """Rayleigh modulus, uniform phase, as `white_noise` has at every frequency with −k ≠ k."""
    many, limit = np.fft.rfft2(impulses(*MANY, 10**9, seed=8)), half_spectrum(white_noise, *MANY, seed=8)
    for part in (np.abs, np.angle):
        assert stats.ks_2samp(part(many[:, 1:]).ravel(), part(limit[:, 1:]).ravel()).pvalue > LIKELY


@pytest.mark.parametrize("size", [(40, 51), (70, 90), (20, 77)])
def test_the_limit_is_the_adsn_of_the_same_seed(size):
    h = image(40, 51, 3)
    np.testing.assert_allclose(adsn_of_spot(sample_spot(h, *size), 3), adsn(h, *size, seed=3), atol=1e-3)


def test_it_depends_on_the_seed_and_not_on_the_threads():
    spot = sample_spot(image(40, 51, 3), 133, 190)
    one = dsn(spot, 1000, seed=3)
    assert (dsn(spot, 1000, seed=3, threads=2) == one).all()
    assert (dsn(spot, 1000, seed=4) != one).mean() > 0.99


@pytest.mark.parametrize("value", [0, 0.1, 65535])
@pytest.mark.parametrize("size", [(8, 9), (20, 21)])
def test_a_constant_sample_gives_itself_back(value, size):
    spot = sample_spot(np.full((8, 9, 3), value, np.float32), *size)
    assert (dsn(spot, 10**6, seed=1) == np.float32(value)).all()
    assert (excess_kurtosis(spot) == 0).all()


def test_the_disc_is_binary_and_of_its_radius():
    disc = spot_shape("disc", 64, 65, 10)
    assert set(np.unique(disc)) == {0, 1}
    # Gauss's circle problem: as many pixels as the area, but for some of the 2πr on its border
    assert abs(disc.sum() - np.pi * 100) < 2 * np.pi * 10 / 3
    assert disc[32, 22] == disc[42, 32] == 1
    assert disc[32, 21] == disc[43, 32] == 0


def test_the_gaussian_has_half_the_radius_as_its_deviation():
    spot = spot_shape("gaussian", 65, 65, 12).astype(np.float64)
    x = np.arange(65) - 32
    assert np.sqrt((spot.sum(0) * x**2).sum() / spot.sum()) == pytest.approx(6, rel=1e-3)


@pytest.mark.parametrize("kind", ["disc", "gaussian"])
def test_a_standard_spot_has_the_mean_and_deviation_asked_for(kind):
    spot = standard_spot(kind, 50, 61, 4.5, mean=100, deviation=30)
    assert whole(spot).mean() == pytest.approx(100, rel=1e-5)
    assert whole(spot).std() == pytest.approx(30, rel=1e-5)


def test_a_disc_that_covers_the_texture_is_refused():
    with pytest.raises(ValueError, match="covers"):
        standard_spot("disc", 8, 8, 20, mean=100, deviation=30)


@pytest.mark.parametrize("size", [(24, 31), (50, 61), (24, 50)])
def test_the_kurtosis_is_that_of_the_spots_values_over_the_whole_torus(size):
    spot = sample_spot(image(24, 31), *size)
    np.testing.assert_allclose(excess_kurtosis(spot), stats.kurtosis(whole(spot), axis=(0, 1)), atol=1e-3)


@pytest.mark.parametrize("stop_at", [1, 3, 5])
def test_what_the_progress_raises_stops_the_work(stop_at):
    stops_at(stop_at, lambda progress: dsn(sample_spot(image(16, 16), 16, 16), 10, progress=progress))

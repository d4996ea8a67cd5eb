"""Every noise of an extended spot has the variance of the sample's periodic component, the mean over the channels."""

import numpy as np
import pytest

from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.fourier.spot import centre, extend_spot
from app.synthesis.fourier.spot_noise import sample_spot
from app.synthesis.gaussian.adsn import adsn
from app.synthesis.gaussian.dsn import dsn
from app.synthesis.gaussian.mixing import mix
from app.synthesis.gaussian.rpn import rpn
from app.synthesis.gaussian.video_rpn import video_rpn

CROP = (48, 61)
SIZES = [(96, 122), (97, 130), (48, 200), (150, 61), (49, 62), (30, 140), (100, 31)]
WINDOWS = [("bump", 0), ("bump", 0.1), ("bump", 0.5), ("gaussian", 0.2), ("gaussian", 0.5)]


def coarse(height, width, channels=3, seed=0):
    """Stains as large as a quarter of the crop, other ones in each channel: what a window hits most."""
    noise = np.fft.rfft2(np.random.default_rng(seed).normal(size=(channels, 2 * height, 2 * width)))
    k = [np.fft.fftfreq(2 * height)[:, None], np.fft.rfftfreq(2 * width)]
    noise *= np.exp(-2 * (np.pi * height / 8) ** 2 * (k[0] ** 2 + k[1] ** 2))
    stains = np.fft.irfft2(noise)[:, :height, :width]
    scales = np.arange(1, channels + 1)[:, None, None]
    return (100 + 20 * scales * stains / stains.std()).astype(np.float32).transpose(1, 2, 0)


def variance(picture):
    """The mean over the channels, about each one's mean."""
    axes = tuple(range(picture.ndim - 1))
    return picture.var(axes, dtype=np.float64).mean()


def own(h, height, width):
    """Variance of the periodic component of what is taken of the sample."""
    return variance(periodic_component(centre(h, height, width)))


@pytest.mark.parametrize(("window", "alpha"), WINDOWS)
@pytest.mark.parametrize("size", SIZES)
def test_rpn_has_it_in_every_draw(size, window, alpha):
    h = coarse(*CROP)
    for seed in range(2):
        z = rpn(h, *size, seed=seed, alpha=alpha, window=window)
        assert variance(z) == pytest.approx(own(h, *size), rel=1e-4)


@pytest.mark.parametrize("channels", [1, 2, 5])
def test_it_holds_for_any_number_of_channels(channels):
    h = coarse(*CROP, channels)
    assert variance(rpn(h, 100, 130, alpha=0.5, window="gaussian")) == pytest.approx(own(h, 100, 130), rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(("window", "alpha"), [("bump", 0.1), ("gaussian", 0.5)])
def test_adsn_has_it_on_average_over_seeds(window, alpha):
    """Within four standard errors of the mean of 200 draws, which are known to 3 % at most."""
    h = coarse(*CROP)
    found = [variance(adsn(h, 100, 130, seed=seed, alpha=alpha, window=window)) for seed in range(200)]
    error = np.std(found, ddof=1) / np.sqrt(len(found))
    assert error < 0.03 * np.mean(found)
    assert abs(np.mean(found) - own(h, 100, 130)) < 4 * error


@pytest.mark.parametrize(("window", "alpha"), WINDOWS)
@pytest.mark.parametrize("size", SIZES)
def test_the_spot_that_other_methods_throw_has_it_too(size, window, alpha):
    """Its autocorrelation at 0 about its mean, which is the variance of its ADSN and of its DSN of every order."""
    h = coarse(*CROP)
    spot = sample_spot(h, *size, alpha, window)
    assert variance(spot.rows(0, size[0]).transpose(1, 2, 0)) == pytest.approx(own(h, *size), rel=1e-4)


def test_a_discrete_spot_noise_and_the_ends_of_a_mixture_are_those_of_this_spot():
    """One copy of the spot is the spot, moved; the ends of a mixture are the ADSN."""
    h = coarse(*CROP)
    assert variance(dsn(sample_spot(h, 100, 130, 0.5, "gaussian"), 1)) == pytest.approx(own(h, 100, 130), rel=1e-4)
    end = mix([h, coarse(50, 50, seed=1)], [1, 0], 100, 130, seed=3, alpha=0.5, window="gaussian")
    assert (end == adsn(h, 100, 130, seed=3, alpha=0.5, window="gaussian")).all()


@pytest.mark.parametrize(("window", "alpha"), [("bump", 0.1), ("gaussian", 0.5)])
@pytest.mark.parametrize("shape", [(9, 48, 61), (6, 90, 61), (9, 100, 130), (4, 100, 61), (7, 20, 140)])
def test_a_video_has_it_over_time_and_space(shape, window, alpha):
    """Against the clip's own RPN, whose modulus is that of its periodic component."""
    video = np.stack([coarse(*CROP, seed=seed) for seed in range(6)]) + coarse(*CROP, seed=9)
    cut = [slice(max(0, (have - asked) // 2), None) for have, asked in zip(video.shape, shape, strict=False)]
    taken = video[tuple(cut)][tuple(slice(0, asked) for asked in shape)]
    z = video_rpn(video, *shape, alpha=alpha, window=window)
    assert variance(z) == pytest.approx(variance(video_rpn(taken)), rel=1e-3)


def test_the_factor_is_one_for_all_channels_so_the_window_decides_how_they_compare():
    p = periodic_component(coarse(*CROP))
    mean = p.mean((0, 1), dtype=np.float64)
    together = extend_spot(p, mean, 100, 130, 0.5, "gaussian")
    each = [extend_spot(p[:, :, [c]], mean[[c]], 100, 130, 0.5, "gaussian") for c in range(3)]
    ratios = [np.ptp(together[:, :, c]) / np.ptp(alone) for c, alone in enumerate(each)]
    assert np.ptp(ratios) > 0.02  # what remains: single channels are off
    faded = extend_spot(p[:, :, :1], mean[:1], 100, 130, 0.5, "gaussian")[:, :, 0] - mean[0]
    np.testing.assert_allclose((together[:, :, 0] - mean[0]), faded * ratios[0], atol=1e-3)


@pytest.mark.parametrize("size", [(48, 200), (150, 61)])
def test_an_axis_that_is_not_extended_keeps_its_profile(size):
    """A crop that changes along that axis alone comes back as it was, but for the window along the other one."""
    h = np.zeros((*CROP, 1), np.float32)
    h += np.sin(2 * np.pi * np.arange(48) / 12)[:, None, None] if size[0] == 48 else 0
    h += np.sin(2 * np.pi * np.arange(61) / 61)[:, None] if size[1] == 61 else 0
    spot = extend_spot(h, np.zeros(1), *size, 0.5, "bump")[:, :, 0]
    line, profile = (spot[:, 100], h[:, 0, 0]) if size[0] == 48 else (spot[75], h[0, :, 0])
    np.testing.assert_allclose(line / line.std(), profile / profile.std(), atol=1e-4)


@pytest.mark.parametrize("size", [(1, 1), (1, 2), (5, 1), (40, 33)])
@pytest.mark.parametrize("alpha", [0, 0.1, 0.5])
def test_a_constant_crop_gives_itself_back(size, alpha):
    h = np.full((*size, 3), (0, 77.1, 255), np.float32)
    assert (rpn(h, 47, 50, alpha=alpha) == h[0, 0]).all()


def test_contrast_at_the_border_alone_stays_finite():
    h = np.zeros((16, 16, 1), np.float32)
    h[0] = h[-1] = 1
    z = rpn(h, 40, 40, alpha=0.5, window="gaussian")
    assert np.isfinite(z).all()
    assert variance(z) == pytest.approx(own(h, 40, 40), rel=1e-4)

"""The structure index: exact statistics, invariances, and what it says of photographs."""

import numpy as np
import pytest
import scipy.fft
from PIL import Image

from app.samples import read_catalogue
from app.settings import ROOT
from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.gaussian.adsn import adsn
from app.synthesis.gaussian.rpn import rpn
from app.synthesis.luminance import luminance
from app.synthesis.structure import CENTRE, Structure, is_too_small, measure_delta, structure_index

NOTHING = Structure(0, 0, 0, 0, 0)
SAMPLES = {entry.id: entry for entry in read_catalogue(ROOT / "samples")}


def photograph(name):
    """The suggested crop of a bundled photograph."""
    image = np.asarray(Image.open(SAMPLES[name].path).convert("RGB"), np.float32)
    area = SAMPLES[name].crop
    return image[area.y : area.y + area.height, area.x : area.x + area.width]


def smoothed(p, sigma):
    """A periodic Gaussian, by its transform and in double precision."""
    down, across = (2 * np.pi * np.fft.fftfreq(side) for side in p.shape)
    gain = np.exp(-(sigma**2) * (down[:, None] ** 2 + across**2) / 2)
    return scipy.fft.ifft2(scipy.fft.fft2(p.astype(np.float64)) * gain).real


def differences(p):
    return [np.roll(p, -1, axis) - p for axis in (0, 1)]


def total_variation(p):
    return sum(np.abs(each).sum() for each in differences(p))


def image(height, width, channels=3, seed=0):
    rng = np.random.default_rng(seed)
    return (rng.normal(100, 20, (height, width, channels)) + 5 * np.arange(width)[None, :, None]).astype(np.float32)


@pytest.mark.parametrize("sigma", [0, 2])
@pytest.mark.parametrize("name", ["gravel_gray", "brick_gray"])
def test_mean_and_deviation_are_those_of_200_draws_of_the_gaussian_texture(name, sigma):
    """Four standard errors: of the mean of 200 draws σ_TV / √200, of their deviation about σ_TV / √398.

    With these crops that is 0.2 % to 0.6 % of the mean and 20 % of the deviation: more draws tell more, see below.
    """
    p = smoothed(periodic_component(photograph(name)[64:192, 64:192, 0]), sigma).astype(np.float32)
    found = structure_index(p, 0)
    draws = [total_variation(adsn(p, seed=seed).astype(np.float64)) for seed in range(200)]
    assert abs(np.mean(draws) - found.mean) < 4 * found.deviation / np.sqrt(200)
    assert abs(np.std(draws, ddof=1) / found.deviation - 1) < 4 / np.sqrt(398)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gravel_gray", "brick_gray"])
def test_mean_and_deviation_hold_to_a_thousandth_and_two_hundredths(name):
    """20,000 Gaussian textures by transforms of white noise, nothing of the program's own.

    The mean of so many is known to σ_TV / √20000, less than 0.02 % here, and the deviation to 1 / √40000 = 0.5 %.
    """
    h = photograph(name)[64:128, 64:128, 0]
    found = structure_index(h, 0)
    p = periodic_component(h)
    p -= p.mean()
    rng = np.random.default_rng(3)
    spectrum = np.fft.rfft2(p) / np.sqrt(p.size)
    draws = []
    for _ in range(40):
        white = np.fft.rfft2(rng.standard_normal((500, *p.shape), np.float32))
        z = np.fft.irfft2(spectrum * white, s=p.shape)
        steps = (np.abs(z - np.roll(z, 1, axis)).sum((1, 2)) for axis in (1, 2))
        draws.append(sum(steps))
    assert np.mean(draws) == pytest.approx(found.mean, rel=1e-3)
    assert np.std(draws) == pytest.approx(found.deviation, rel=0.02)


@pytest.mark.parametrize("sigma", [0, 1.3])
@pytest.mark.parametrize("size", [(12, 16), (9, 11), (7, 1), (1, 8), (2, 3)])
def test_every_number_is_that_of_the_formula_summed_pixel_by_pixel(size, sigma):
    """In double precision, with correlations by translation: nothing but the formula is shared."""
    h = image(*size)
    p = smoothed(periodic_component(luminance(h)), sigma)
    steps = differences(p)
    norms = [np.sqrt(np.square(each).sum()) for each in steps]
    mean = sum(norms) * np.sqrt(2 / np.pi * p.size)
    variance = 0.0
    for i, j in np.ndindex(2, 2):
        for shift in np.ndindex(p.shape):
            if norms[i] * norms[j] > 1e-3:
                t = (steps[i] * np.roll(steps[j], shift, (0, 1))).sum() / (norms[i] * norms[j])
                t = np.clip(t, -1, 1)
                variance += 2 / np.pi * norms[i] * norms[j] * (t * np.arcsin(t) + np.sqrt(1 - t**2) - 1)
    found = structure_index(h, sigma)
    assert found.mean == pytest.approx(mean, rel=1e-4)
    assert found.total_variation == pytest.approx(total_variation(p), rel=1e-4)
    assert found.deviation == pytest.approx(np.sqrt(variance), rel=1e-3)
    assert found.delta == pytest.approx((mean - total_variation(p)) / mean, abs=1e-4)
    assert found.z == pytest.approx((mean - total_variation(p)) / np.sqrt(variance), abs=1e-3)


@pytest.mark.parametrize("name", ["gravel_gray", "bark_fir", "crazy_paving001", "stonewall_rockwall"])
def test_a_random_phase_texture_lies_at_nothing_whatever_it_was_made_from(name):
    """δ of a crop's random phase textures has a deviation of 0.003 at most here: 0.01 is three of them."""
    h = photograph(name)
    deltas = [measure_delta(rpn(h, seed=seed)) for seed in range(4)]
    assert None not in deltas
    assert max(abs(delta) for delta in deltas if delta is not None) < 0.01


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [
        ("grass_gray", 0.01, 0.03), ("grass_jungle002", 0.01, 0.03), ("dirt003", 0.01, 0.03),
        ("gravel_gray", 0.02, 0.04), ("towel_red", -0.01, 0.03), ("paper_mamurk_a1", -0.01, 0.03),
        ("brick_gray", 0.12, 0.36), ("crazy_paving001", 0.2, 0.26),
        ("leaves_forest_floor", 0.12, 0.31), ("soil_ground010", 0.08, 0.13),
    ],
)  # fmt: skip
def test_grass_and_gravel_lie_low_bricks_and_cobbles_high_and_soil_is_a_false_alarm(name, low, high):
    assert low < measure_delta(photograph(name)) < high


@pytest.mark.parametrize(("gain", "offset"), [(0.01, 0), (257, 0), (-1, 255), (1, -1e4)])
def test_it_does_not_depend_on_brightness_contrast_or_depth(gain, offset):
    h = photograph("brick_gray")[:96, :101]
    found, changed = structure_index(h), structure_index(gain * h + np.float32(offset))
    assert changed.delta == pytest.approx(found.delta, abs=1e-4)
    assert changed.z == pytest.approx(found.z, rel=1e-3)


@pytest.mark.parametrize("shift", [(3, -7), (-10, 10)])
def test_it_does_not_depend_on_translation_on_the_torus(shift):
    """On an image that is constant at its borders, before and after: it is its own periodic component."""
    h = np.full((64, 80), 30, np.float32)
    h[12:-12, 12:-12] = image(40, 56, 1)[:, :, 0]
    assert structure_index(np.roll(h, shift, (0, 1))).delta == pytest.approx(structure_index(h).delta, abs=1e-5)


@pytest.mark.parametrize("turn", [np.flipud, np.fliplr, lambda h: h.transpose(1, 0, 2)])
def test_it_does_not_depend_on_mirroring_or_on_which_axis_comes_first(turn):
    h = photograph("crazy_paving001")[:90, :128]
    assert structure_index(np.ascontiguousarray(turn(h))).delta == pytest.approx(structure_index(h).delta, abs=1e-5)


@pytest.mark.parametrize("value", [0, 0.1, 200, 65535])
@pytest.mark.parametrize("shape", [(1, 1), (1, 1, 3), (5, 7), (64, 63, 3), (2, 1, 4)])
def test_a_constant_crop_is_its_own_random_phase_texture(value, shape):
    h = np.full(shape, value, np.float32)
    assert structure_index(h) == NOTHING
    assert measure_delta(h) == (0 if shape == (64, 63, 3) else None)


@pytest.mark.parametrize(("size", "known"), [((1, 1), 0), ((3, 1), 0), ((31, 32), 0), ((32, 31), 0), ((32, 32), 1)])
def test_of_less_than_32_pixels_along_a_side_there_is_no_telling(size, known):
    h = image(*size)
    assert is_too_small(*size) != known
    assert measure_delta(h) == (structure_index(h).delta if known else None)


def test_a_crop_without_contrast_at_the_scale_has_no_structure_there():
    """A fine checkerboard, smoothed by far more than its squares, would leave rounding to be measured."""
    assert structure_index(np.tile(np.array([[0, 255], [255, 0]], np.float32), (16, 16)), 40) == NOTHING


@pytest.mark.parametrize("size", [(1, 1), (1, 2), (2, 2), (3, 1), (5, 4)])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_the_smallest_crops_have_an_index_too(size, channels):
    found = structure_index(image(*size, channels))
    assert np.isfinite([found.delta, found.z, found.deviation]).all()
    assert found.delta <= 1


def test_of_a_large_crop_the_centre_is_measured():
    h = image(40, CENTRE + 60, 1)
    h[:, :30], h[:, -30:] = 0, 999
    assert measure_delta(h) == pytest.approx(structure_index(h[:, 30:-30]).delta)
    assert measure_delta(h[:, :100]) == structure_index(h[:, :100]).delta


def test_colour_counts_by_its_luminance():
    h = image(20, 30)
    assert structure_index(h) == structure_index(luminance(h))

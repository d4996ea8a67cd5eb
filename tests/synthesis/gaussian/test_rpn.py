"""RPN keeps the modulus and the phase differences between channels, and draws everything else at random."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from app.synthesis.fourier.periodic import periodic_component, smooth_component
from app.synthesis.fourier.spectral import half_spectrum
from app.synthesis.fourier.spot import centre, extend_spot
from app.synthesis.gaussian.adsn import adsn
from app.synthesis.gaussian.rpn import random_phase, rpn
from tests.profiles import examples
from tests.synthesis.images import image
from tests.synthesis.stopping import stops_at

LIKELY = 1e-3  # a seed is pinned; a p-value below this says that the law is wrong
SIZES = [(1, 1), (1, 12), (12, 1), (2, 3), (16, 16), (16, 17), (17, 16), (37, 41), (130, 67)]


def spectrum(picture):
    return np.fft.rfft2(picture.astype(np.float64), axes=(0, 1))


def spot(h, height, width):
    """What the texture is made of: the extended periodic component."""
    p = periodic_component(centre(h, height, width))
    return extend_spot(p, p.mean((0, 1), dtype=np.float64), height, width)


@pytest.mark.parametrize("size", SIZES)
def test_the_modulus_is_kept(size):
    h = image(*size)
    before, after = np.abs(spectrum(periodic_component(h))), np.abs(spectrum(rpn(h, seed=1)))
    assert (np.abs(after - before) <= 1e-4 * before + 1e-6 * before.max()).all()


@settings(max_examples=examples(40))
@given(st.tuples(*[st.integers(1, 40)] * 4), st.integers(1, 5), st.integers(0, 2**53 - 1))
def test_modulus_mean_and_phase_differences_are_those_of_the_spot_at_any_size(sizes, channels, seed):
    h = image(sizes[0], sizes[1], channels)
    z = rpn(h, sizes[2], sizes[3], seed=seed)
    assert z.shape == (sizes[2], sizes[3], channels)
    assert z.dtype == np.float32
    before, after = spectrum(spot(h, sizes[2], sizes[3])), spectrum(z)
    after[0, 0] = before[0, 0] = 0
    scale = max(np.abs(before).max(), 1e-3)
    np.testing.assert_allclose(np.abs(after), np.abs(before), atol=1e-4 * scale)
    # z_c conj z_d = h_c conj h_d: modulus and phase displacement at once
    for c, d in itertools.combinations(range(channels), 2):
        np.testing.assert_allclose(
            after[:, :, c] * after[:, :, d].conj(), before[:, :, c] * before[:, :, d].conj(), atol=2e-4 * scale**2
        )
    expected = centre(h, sizes[2], sizes[3]).mean((0, 1), dtype=np.float64)
    np.testing.assert_allclose(z.mean((0, 1), dtype=np.float64), expected, rtol=1e-6)


def test_a_grey_image_stays_two_dimensional_and_equals_its_one_channel():
    h = image(20, 21, 1)
    assert (rpn(h[:, :, 0], 30, 40, seed=2) == rpn(h, 30, 40, seed=2)[:, :, 0]).all()


@pytest.mark.parametrize("model", [rpn, adsn])
@pytest.mark.parametrize("value", [0, 0.1, 128, 65535])
@pytest.mark.parametrize("sizes", [(16, 16, 16, 16), (37, 41, 37, 41), (1, 7, 1, 7), (10, 11, 23, 29), (20, 20, 7, 50)])
def test_a_constant_image_gives_itself_back(model, value, sizes):
    h = np.full((*sizes[:2], 3), value, np.float32)
    assert (model(h, *sizes[2:], seed=1) == np.float32(value)).all()


@pytest.mark.parametrize("model", [rpn, adsn])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("size", [8, 16])
@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
def test_values_that_are_not_finite_are_refused(model, bad, size):
    h = image(8, 8)
    h[3, 4, 1] = bad
    with pytest.raises(ValueError, match="not finite"):
        model(h, size, size)


@settings(max_examples=examples(30))
@given(st.tuples(*[st.integers(1, 12)] * 4), st.sampled_from(["add", "replace"]), st.booleans(), st.floats(0, 0.5))
def test_no_size_or_option_makes_a_value_that_is_not_finite(sizes, phase, rayleigh, alpha):
    h = image(*sizes[:2])
    for window in ("bump", "gaussian"):
        model = adsn if rayleigh else rpn
        assert np.isfinite(model(h, *sizes[2:], phase=phase, alpha=alpha, window=window)).all()


@pytest.mark.parametrize("model", [rpn, adsn])
@pytest.mark.parametrize("sizes", [(40, 50, 40, 50), (40, 50, 133, 190)])
def test_the_result_depends_on_the_seed_and_not_on_the_threads(model, sizes):
    h = image(*sizes[:2])
    one = model(h, *sizes[2:], seed=3)
    assert (model(h, *sizes[2:], seed=3, threads=2) == one).all()
    assert (model(h, *sizes[2:], seed=4) != one).mean() > 0.99


def test_two_sinusoids_are_only_translated():
    """Section 4 of the TIP article: the RPN of a sum of two oscillations is a translation of it."""
    # Half a pixel off, opposite borders are equal, and the image is its own periodic component.
    y, x = (np.mgrid[:32, :32] + 0.5) * 2 * np.pi / 32
    h = (100 + 30 * np.cos(3 * x) + 20 * np.cos(5 * y)).astype(np.float32)
    for seed in range(5):
        z = rpn(h, seed=seed)
        right, down = np.angle(spectrum(z)[[0, 5], [3, 0]] / spectrum(h)[[0, 5], [3, 0]])
        translated = 100 + 30 * np.cos(3 * x + right) + 20 * np.cos(5 * y + down)
        np.testing.assert_allclose(z, translated, atol=1e-3)


def test_replacing_the_phase_keeps_every_modulus_and_drops_the_phase_differences():
    h = image(24, 30)
    wrong = spectrum(rpn(h, seed=1, phase="replace"))
    before = spectrum(periodic_component(h))
    np.testing.assert_allclose(np.abs(wrong), np.abs(before), atol=1e-5 * np.abs(before).max())
    strong = np.abs(before[:, :, :2]).min(2) > 1e-2 * np.abs(before[1:]).max()
    np.testing.assert_allclose(np.angle(wrong[:, :, 0] / wrong[:, :, 1])[strong], 0, atol=1e-2)
    assert np.abs(np.angle(before[:, :, 0] / before[:, :, 1])[strong]).max() > 1


def test_replacing_the_phase_keeps_a_mean_below_zero():
    h = image(16, 16) - 500
    np.testing.assert_allclose(rpn(h, phase="replace").mean((0, 1)), h.mean((0, 1)), rtol=1e-5)


@pytest.mark.parametrize("model", [rpn, adsn])
def test_the_smooth_component_can_be_added_back_at_the_same_size_only(model):
    h = image(20, 25) + np.linspace(0, 300, 25, dtype=np.float32)[None, :, None]
    with_smooth = model(h, seed=1, add_smooth=True)
    np.testing.assert_allclose(with_smooth, model(h, seed=1) + smooth_component(h), atol=1e-3)
    with pytest.raises(ValueError, match="own size"):
        model(h, 20, 26, add_smooth=True)


@pytest.mark.parametrize("model", [rpn, adsn])
def test_the_smooth_component_cannot_be_added_to_what_was_not_freed_of_it(model):
    with pytest.raises(ValueError, match="taken out"):
        model(image(20, 25), periodic=False, add_smooth=True)


def test_without_the_periodic_component_the_modulus_is_the_samples_own_with_its_cross():
    """A slope along x jumps at the border: its frequencies k₁ = 0 are strong, and the periodic component's are not."""
    h = image(32, 40) + np.linspace(0, 600, 40, dtype=np.float32)[None, :, None]
    cross = [np.abs(spectrum(rpn(h, seed=1, periodic=periodic)))[0, 1:] for periodic in (False, True)]
    np.testing.assert_allclose(cross[0], np.abs(spectrum(h))[0, 1:], rtol=1e-3)
    assert (np.square(cross[0]).sum(0) > 20 * np.square(cross[1]).sum(0)).all()


def test_a_texture_smaller_than_the_sample_is_that_of_its_centre():
    h = image(30, 41)
    assert (rpn(h, 16, 21, seed=5) == rpn(np.ascontiguousarray(h[7:23, 10:31]), seed=5)).all()


def test_the_result_tiles_without_a_seam():
    rng = np.random.default_rng(0)
    h = np.cumsum(rng.normal(0, 10, (64, 64, 1)), axis=1).astype(np.float32)  # strongly correlated along x
    z = rpn(h, 192, 200, seed=0)
    inside, across = np.diff(z, axis=1), z[:, 0] - z[:, -1]
    # the mean of 192 correlated squares: a seam of the size of the texture's contrast would be far above
    assert across.std() < 1.5 * inside.std()
    assert across.std() < 0.5 * z.std()


@pytest.mark.parametrize("stop_at", [1, 4, 9])
def test_what_the_progress_raises_stops_the_work_at_once(stop_at):
    stops_at(stop_at, lambda progress: rpn(image(64, 64), 640, 640, threads=2, progress=progress))


def test_the_progress_of_every_stage_rises_to_one():
    calls = []
    rpn(image(64, 64), 200, 200, threads=2, progress=lambda stage, part: calls.append((stage, part)))
    stages = {stage: [part for name, part in calls if name == stage] for stage, _ in calls}
    assert list(stages) == ["spot", "random phase", "texture"]
    for parts in stages.values():
        assert parts == sorted(parts)
        assert parts[-1] == 1


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


def test_every_seed_draws_anew():
    assert len({half_spectrum(random_phase, 8, 8, seed).tobytes() for seed in (0, 1, 2, 2**32, 2**53 - 1)}) == 5

"""RPN in three dimensions keeps the modulus over time and space, stands still where the video does, loops and tiles."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.fourier.spot import window
from app.synthesis.gaussian.rpn import rpn
from app.synthesis.gaussian.video_rpn import centre_video, jump_share, video_rpn
from tests.profiles import examples
from tests.synthesis.images import image
from tests.synthesis.stopping import stops_at

SHAPES = [(1, 1, 1), (2, 1, 5), (4, 6, 8), (5, 7, 11), (8, 9, 6), (7, 16, 13), (12, 17, 16)]


def clip(frames, height, width, channels=3, seed=0):
    """Correlated channels that change with time, neither periodic nor with a constant mean, 0–255."""
    still = image(height, width, channels, seed)
    moving = np.stack([image(height, width, channels, seed + 1 + index) for index in range(frames)])
    ramp = np.linspace(0, 40, frames, dtype=np.float32)[:, None, None, None]
    return (0.4 * still + 0.4 * moving + ramp).astype(np.float32)


def periodic(video):
    """What the module's docstring says, in double precision and all at once."""
    frames, height, width, _ = video.shape
    p = np.stack([periodic_component(frame).astype(np.float64) for frame in video])
    jump = np.fft.fft2(p[0] - p[-1], axes=(0, 1))
    k, down, across = (
        2 * np.pi * np.fft.fftfreq(side).reshape(shape)
        for side, shape in ((frames, (-1, 1, 1, 1)), (height, (-1, 1, 1)), (width, (-1, 1)))
    )
    below = sum(4 * np.sin(each / 2) ** 2 for each in (k, down, across))
    below[0, 0, 0] = 1
    return p - np.fft.ifftn((1 - np.exp(1j * k)) * jump / below, axes=(0, 1, 2)).real


def spot(video, shape, alpha=0.1, profile="bump"):
    """The extended spot frame by frame, double precision."""
    p = periodic(centre_video(video, shape))
    if p.shape[:3] == shape:
        return p
    count, channels = len(p), video.shape[3]
    phi = [
        window(have, alpha, profile) if asked > have else np.ones(have)
        for asked, have in zip(shape, p.shape, strict=False)
    ]
    still = np.einsum("thwc,t->hwc", p, phi[0] / phi[0].sum())
    rows, columns = (slice((shape[i] - p.shape[i]) // 2, (shape[i] + p.shape[i]) // 2) for i in (1, 2))

    def spread(frame):
        mean = frame.mean((0, 1))
        high = np.zeros((*shape[1:], channels))
        high[rows, columns] = (frame - mean) * phi[1][:, None, None] * phi[2][:, None]
        high *= np.sqrt(shape[1] * shape[2] / (p.shape[1] * p.shape[2]))
        return high - high.mean((0, 1)), mean

    extended = np.zeros((*shape, channels))
    extended += spread(still)[0]
    first = (shape[0] - count) // 2
    for index, frame in enumerate(p):
        high, mean = spread(frame - still)
        extended[first + index] += phi[0][index] * np.sqrt(shape[0] / count) * (high + mean)
    extended -= extended.mean((0, 1, 2))
    variance = extended.var((0, 1, 2)).sum()
    if variance > 0:
        extended *= np.sqrt(p.var((0, 1, 2)).sum() / variance)
    return extended + p.mean((0, 1, 2))


def spectrum(video):
    found = np.fft.rfftn(video.astype(np.float64), axes=(0, 1, 2))
    found[0, 0, 0] = 0
    return found


def keeps(video, z, *options):
    """Assert that moduli, differences of phases between channels and the mean are the spot's."""
    before, after = spectrum(spot(video, z.shape[:3], *options)), spectrum(z)
    scale = max(np.abs(before).max(), 1e-3)
    np.testing.assert_allclose(np.abs(after), np.abs(before), atol=2e-4 * scale)
    for c, d in itertools.combinations(range(video.shape[3]), 2):
        np.testing.assert_allclose(
            after[..., c] * after[..., d].conj(), before[..., c] * before[..., d].conj(), atol=4e-4 * scale**2
        )
    expected = centre_video(video, z.shape[:3]).mean((0, 1, 2), dtype=np.float64)
    np.testing.assert_allclose(z.mean((0, 1, 2), dtype=np.float64), expected, rtol=1e-6)


@pytest.mark.parametrize("shape", SHAPES)
def test_modulus_mean_and_phase_differences_are_those_of_the_clip(shape):
    video = clip(*shape)
    z = video_rpn(video, seed=1)
    assert (z.shape, z.dtype) == (video.shape, np.float32)
    keeps(video, z)


@settings(max_examples=examples(40))
@given(st.tuples(*[st.integers(1, 12)] * 6), st.integers(1, 4), st.integers(0, 2**53 - 1))
def test_at_any_other_size_they_are_those_of_the_extended_spot(sizes, channels, seed):
    video = clip(*sizes[:3], channels)
    keeps(video, video_rpn(video, *sizes[3:], seed=seed))


@pytest.mark.parametrize("profile", ["bump", "gaussian"])
@pytest.mark.parametrize("alpha", [0, 0.3, 0.5])
def test_with_every_window_they_are_those_of_the_spot_extended_with_it(profile, alpha):
    video = clip(8, 12, 11)
    keeps(video, video_rpn(video, 13, 20, 17, seed=2, alpha=alpha, window=profile), alpha, profile)


@pytest.mark.parametrize("shape", [(4, 6, 8), (5, 7, 11), (6, 5, 4)])
def test_what_is_taken_out_is_the_poisson_problem_of_the_jump(shape):
    """Δs is the jump at the two ends of time and zero elsewhere; Δ is the sum of differences to the six neighbours."""
    height, width = shape[1:]
    jump = image(height, width, 1)[:, :, 0].astype(np.float64)
    jump -= jump.mean()
    share = np.concatenate([jump_share(*shape, [row]) for row in range(height)], axis=1)
    s = np.fft.irfftn(share * np.fft.rfft2(jump), s=shape, axes=(0, 1, 2))
    laplacian = sum(2 * s - np.roll(s, 1, axis) - np.roll(s, -1, axis) for axis in range(3))
    expected = np.zeros(shape)
    expected[0], expected[-1] = jump, -jump
    np.testing.assert_allclose(laplacian, expected, atol=1e-4 * np.abs(jump).max())


@pytest.mark.parametrize("shape", [(6, 20, 24), (10, 20, 24), (3, 20, 24), (9, 31, 40)])
def test_a_video_that_stands_still_becomes_the_rpn_of_its_picture_and_stands_still(shape):
    """Its modulus lives at the frequency 0 in time, where the phase is that of RPN at this seed."""
    h = image(20, 24)
    z = video_rpn(np.repeat(h[None], 6, axis=0), *shape, seed=5)
    np.testing.assert_allclose(z, np.broadcast_to(rpn(h, *shape[1:], seed=5), z.shape), atol=1e-3)


@pytest.mark.parametrize("shape", [(4, 6, 8), (7, 9, 8), (3, 11, 5)])
def test_a_constant_video_gives_itself_back(shape):
    video = np.full((4, 6, 8, 3), (0, 77.1, 255), np.float32)
    assert (video_rpn(video, *shape) == video[0, 0, 0]).all()


def test_a_light_that_pulsates_pulsates_everywhere_alike():
    """A video that is constant over space stays so, at any size: what does not change with place is no spot."""
    light = 100 + 50 * np.cos(2 * np.pi * (np.arange(16) + 0.5) * 3 / 16)
    video = np.broadcast_to(light[:, None, None, None], (16, 8, 9, 1)).astype(np.float32)
    z = video_rpn(video, 16, 20, 9, seed=2)
    np.testing.assert_allclose(z, np.broadcast_to(z[:, :1, :1], z.shape), atol=1e-3)
    assert z.std() == pytest.approx(light.std(), rel=0.01)


def drift(frames, height, width, step=0.5, correlation=3.0, seed=0):
    """A smooth noise without borders that drifts, in double precision, (T, H, W, 1)."""
    side = 128
    k = np.fft.fftfreq(side)
    noise = np.fft.fft2(np.random.default_rng(seed).normal(size=(side, side)))
    noise *= np.exp(-2 * (np.pi * correlation) ** 2 * (k[:, None] ** 2 + k**2))
    moved = np.stack([np.fft.ifft2(noise * np.exp(-2j * np.pi * k * step * t)).real for t in range(frames)])
    return (100 + 30 * moved / moved.std())[:, :height, :width, None].astype(np.float32)


def test_what_moves_goes_on_moving_with_its_velocity():
    video = drift(32, 64, 64, step=1)
    z = video_rpn(video, seed=4)[..., 0]
    following, standing = (
        np.corrcoef((z[1:]).ravel(), np.roll(z[:-1], shift, axis=2).ravel())[0, 1] for shift in (1, 0)
    )
    backwards = np.corrcoef((z[1:]).ravel(), np.roll(z[:-1], -1, axis=2).ravel())[0, 1]
    assert following > 0.98 > standing > backwards


def test_the_loop_has_no_jump_and_the_whole_no_flicker():
    """The clip's own jump, between uncorrelated frames, has 100 times the mean square of a step, and so had the noise's
    steps 100 / 24 times that of the clip's."""
    video = drift(24, 48, 56, step=0.25, correlation=5)
    z = video_rpn(video, seed=1)[..., 0]
    own, inside = np.mean(np.diff(video, axis=0) ** 2), np.mean(np.diff(z, axis=0) ** 2)
    assert np.mean((video[-1] - video[0]) ** 2) > 20 * own
    assert inside < 1.1 * own
    assert np.mean((z[-1] - z[0]) ** 2) < 2 * inside


@pytest.mark.parametrize("axis", [1, 2])
def test_it_tiles_without_a_seam(axis):
    z = video_rpn(drift(12, 40, 50, correlation=4), 18, 90, 100, seed=3)[..., 0]
    inside = np.mean(np.diff(z, axis=axis) ** 2)
    across = np.mean((z.take(0, axis) - z.take(-1, axis)) ** 2)
    assert across < 2 * inside


def test_variance_and_correlation_in_time_are_kept_at_a_larger_size():
    """Variance: the periodic component's. Correlation: four standard errors of the mean over 16 clips of a stationary
    noise, and what the borders of so small a clip do.

    The window, the only thing that changes at its borders, falls there within 2 of 24 frames, which adds its own
    steps: their mean square is 2 / 24 / 2 = 0.04 of the variance.
    """
    correlations = []
    for seed in range(16):
        video = drift(24, 48, 48, step=1, correlation=1.0, seed=seed)
        z = video_rpn(video, 50, 80, 80, seed=seed, threads=2)
        assert z.var() == pytest.approx(periodic(video).var(), rel=1e-3)
        correlations.append(
            np.subtract(*(np.corrcoef(each[1:].ravel(), each[:-1].ravel())[0, 1] for each in (z, video)))
        )
    assert abs(np.mean(correlations)) < 4 * np.std(correlations) / np.sqrt(len(correlations)) + 0.04


def test_a_smaller_texture_is_that_of_the_clips_centre():
    video = clip(9, 14, 13)
    z = video_rpn(video, 4, 8, 7, seed=6)
    assert (z == video_rpn(np.ascontiguousarray(video[2:6, 3:11, 3:10]), seed=6)).all()


@pytest.mark.parametrize("shape", [(6, 20, 22), (9, 31, 22)])
def test_the_result_depends_on_the_seed_and_not_on_the_threads(shape):
    video = clip(6, 20, 22)
    one = video_rpn(video, *shape, seed=3)
    assert (video_rpn(video, *shape, seed=3, threads=2) == one).all()
    assert (video_rpn(video, *shape, seed=4) != one).mean() > 0.99


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_values_that_are_not_finite_are_refused(bad):
    video = clip(3, 4, 5)
    video[1, 2, 3, 0] = bad
    with pytest.raises(ValueError, match="not finite"):
        video_rpn(video)


@pytest.mark.parametrize("stop_at", [1, 5, 20])
def test_what_the_progress_raises_stops_the_work_at_once(stop_at):
    stops_at(stop_at, lambda progress: video_rpn(clip(6, 16, 16), 8, 20, 20, threads=2, progress=progress))


@pytest.mark.parametrize("size", [(None, None, None), (9, 20, 16)])
def test_the_progress_of_every_stage_rises_to_one(size):
    calls = []
    video_rpn(clip(6, 16, 16), *size, threads=2, progress=lambda stage, part: calls.append((stage, part)))
    stages = {stage: [part for name, part in calls if name == stage] for stage, _ in calls}
    assert next(iter(stages)) == "periodic"
    for parts in stages.values():
        assert parts == sorted(parts)
        assert parts[-1] == 1

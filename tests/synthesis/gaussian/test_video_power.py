"""The power of a video's noise, in absolute units: sums of squared moduli of the plain transform of the texture."""

import numpy as np
import pytest

from app.synthesis.gaussian.video_phase import conjugate_rows
from app.synthesis.gaussian.video_power import BAND, VideoPower
from app.synthesis.gaussian.video_rpn import VideoNoiseField
from app.synthesis.parallel import Team

SHAPES = [(4, 6, 8), (5, 7, 11), (6, 1, 9), (3, 2, 5), (8, 9, 6), (7, 4, 1)]


def clip(frames, height, width, channels=3, seed=0):
    """A part that stands still, a part that does not, and a mean that changes with time."""
    rng = np.random.default_rng(seed)
    still, moving = rng.uniform(0, 100, (height, width, channels)), rng.uniform(0, 120, (frames, height, width, 1))
    return (still + moving + 3 * np.arange(frames)[:, None, None, None]).astype(np.float32)


def field_of(video, shape, seed=2):
    def progress(stage, part):
        pass

    with Team(2) as team:
        return VideoNoiseField(video, shape, seed=seed, alpha=0.1, profile="bump", team=team, progress=progress)


def squares(video):
    """Squared moduli of all frequencies, the mean apart, summed over the channels: (T, H, W)."""
    video = video.astype(np.float64)
    return np.square(np.abs(np.fft.fftn(video - video.mean((0, 1, 2)), axes=(0, 1, 2)))).sum(-1)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("size", [None, (9, 12, 14), (5, 10, 9)])
def test_what_is_shown_of_a_texture_is_the_plain_power_of_its_values(shape, size):
    """The picture over space, the picture over time, and the part of the variance that stands still."""
    video = clip(*shape)
    field = field_of(video, size or shape)
    z = np.stack(list(field.frames()))
    power = squares(z)
    columns = field.shape[2] // 2 + 1
    np.testing.assert_allclose(field.power, power.sum(0)[:, :columns], rtol=1e-3, atol=1e-6 * power.sum())
    near = np.minimum(np.arange(field.shape[1]), -np.arange(field.shape[1]) % field.shape[1]) <= BAND
    np.testing.assert_allclose(
        field.power_in_time, power[:, near].sum(1)[:, :columns], rtol=1e-3, atol=1e-6 * power.sum()
    )
    assert field.still == pytest.approx(power[0].sum() / power.sum(), rel=1e-3, abs=1e-6)


def test_the_part_that_stands_still_is_the_variance_of_the_average_frame():
    """Of a still picture of variance 100 and as many values of variance 300 that change, a quarter stands still."""
    rng = np.random.default_rng(1)
    still, moving = rng.normal(0, 10, (1, 64, 64, 1)), rng.normal(0, np.sqrt(300), (64, 64, 64, 1))
    field = field_of((128 + still + moving).astype(np.float32), (64, 64, 64))
    z = np.stack(list(field.frames()))
    assert field.still == pytest.approx(z.mean(0).var() / z.var(), rel=1e-3)
    # the changing part adds a 64th of its variance to the average, and 4096 values know a variance to a 45th of it
    assert field.still == pytest.approx((100 + 300 / 64) / 400, rel=4 / 45)


def test_a_video_without_contrast_stands_still_altogether():
    field = field_of(np.full((4, 6, 8, 3), 77, np.float32), (4, 6, 8))
    assert field.still == 1
    assert not field.power.any()


@pytest.mark.parametrize("shape", SHAPES)
def test_the_variance_is_that_of_the_video_whose_spectrum_it_was_given(shape):
    video = clip(*shape)
    centred = video - video.mean((0, 1, 2), dtype=np.float64)
    spectrum = np.fft.rfftn(centred, axes=(0, 1, 2)).astype(np.complex64)
    frames, height, width = shape
    power = VideoPower((frames, height, width // 2 + 1), width)
    for row in range(height // 2 + 1):
        rows = conjugate_rows(row, height)
        for channel in range(3):
            power(row, rows, spectrum[..., channel][:, rows])
    assert power.variance == pytest.approx(centred.var((0, 1, 2)).sum(), rel=1e-5)

"""The three-dimensional mosaic: deviation kept, no seams, and still parts that do not stay still."""

import numpy as np
import pytest

from app.synthesis.patchwork.cells import Window
from app.synthesis.patchwork.video_mosaic import VideoMosaic, least_length
from app.synthesis.patchwork.video_patchwork import PaddedClip
from tests.synthesis.patchwork.plain_mosaic import frame_of, points_of
from tests.synthesis.videos import noise, size_of, steps, still, waves

SIZE = 64


def mosaic(video, frames=40, *, size=SIZE, interval=10, loop=True, tileable=True, sharpness=6, seed=4):
    rng = np.random.default_rng(seed)
    planes, shape = PaddedClip(video).planes, (frames, size, size)
    return VideoMosaic(
        planes, shape, grid=16, interval=interval, sharpness=sharpness, loop=loop, tileable=tileable, rng=rng
    )


def made(video, frames=40, **options):
    synthesis = mosaic(video, frames, **options)
    return np.stack([synthesis.frame(number) for number in range(frames)])


def test_mean_and_deviation_are_the_clips_in_cores_and_in_joins():
    """White noise: 8 frames far apart of 4096 pixels tell the deviation to 1 %, of a tenth of them to 2 %.

    Painting the cells black and white tells where they join: in between, where feathering would leave about half of
    the variance.
    """
    video = noise()
    synthesis = mosaic(video)
    colours = np.random.default_rng(1).choice([0.0, 1.0], (len(synthesis.sources), 1)).astype(np.float32)
    frames = range(0, 40, 5)
    out = np.stack([synthesis.frame(number)[..., 0] for number in frames])
    window = Window(0, SIZE, 0, SIZE)
    painted = np.stack([synthesis.paint(number, window, np.repeat(colours, 3, 1))[..., 0] for number in frames])
    joins = np.abs(painted - 0.5) < 0.1
    assert joins.sum() > 1000
    for where in (joins, ~joins):
        assert out[where].mean() == pytest.approx(video.mean(), abs=2)
        assert out[where].std() == pytest.approx(video.std(), rel=0.05)


def test_what_stands_still_in_the_clip_does_not_in_the_mosaic():
    """Frames further apart than patches last have nothing to do with each other; near ones do."""
    video = still(channels=1)
    out = made(video)
    assert size_of(out[20] - out[0]) == pytest.approx(np.sqrt(2) * video.std(), rel=0.1)
    assert 0 < size_of(out[1] - out[0]) < 0.5 * video.std()


def test_in_a_loop_the_step_from_the_last_frame_to_the_first_is_like_any_other():
    looped, ended = (steps(made(waves(), 30, loop=loop), 0) for loop in (True, False))
    assert looped[-1] < 1.2 * looped[:-1].max()
    assert ended[-1] > 2 * ended[:-1].max()


@pytest.mark.parametrize("axis", [1, 2], ids=["top and bottom", "left and right"])
def test_tileable_frames_have_no_seam(axis):
    tiled, cut = (steps(made(waves(), frames=4, tileable=tileable), axis) for tileable in (True, False))
    assert tiled[-1] < 1.2 * tiled[:-1].max()
    assert cut[-1] > 1.25 * cut[:-1].max()


@pytest.mark.parametrize(("loop", "tileable"), [(True, True), (False, False)], ids=["circular", "ends"])
@pytest.mark.parametrize("sharpness", [1, 40])
def test_a_clip_as_large_as_is_needed_is_large_enough_whatever_the_seed(loop, tileable, sharpness):
    side, length = least_length(70, 16), least_length(30, 5)
    video = noise(length, side, side)
    for seed in range(3):
        synthesis = mosaic(video, 30, size=70, interval=5, loop=loop, tileable=tileable, sharpness=sharpness, seed=seed)
        out = np.stack([synthesis.frame(number) for number in (0, 17)])
        assert np.isfinite(out).all()
        assert out.std() > 10
    with pytest.raises(ValueError, match="low >= high"):
        mosaic(video[:, 1:], 30, size=70, interval=5, loop=loop, tileable=True)


def test_a_constant_clip_gives_that_constant():
    video = np.full((40, SIZE, SIZE, 3), (10, 100, 250), np.uint8)
    assert np.abs(mosaic(video).frame(3) - (10, 100, 250)).max() < 0.01


def test_cells_are_painted_alike_in_any_window():
    synthesis = mosaic(noise(), tileable=False)
    colours = np.random.default_rng(2).uniform(0, 255, (len(synthesis.sources), 3)).astype(np.float32)
    whole = synthesis.paint(5, Window(0, SIZE, 0, SIZE), colours)
    part = synthesis.paint(5, Window(20, 31, 40, SIZE), colours)
    np.testing.assert_allclose(whole[20:31, 40:], part, rtol=1e-4)
    assert whole.std() > 20


@pytest.mark.parametrize(
    ("sharpness", "reach"), [(1, "all"), (2, "all"), (4, "all"), (1, "near"), (2, "near"), (6, "all"), (20, "near")]
)
@pytest.mark.parametrize(("loop", "tileable"), [(True, True), (False, False), (True, False)])
def test_a_frame_is_the_plain_sum_over_the_points_with_every_option(sharpness, reach, loop, tileable):
    """Every point of space and time, or those with weights that end: for near points only, and from f = 6 on."""
    video = noise(30, 60, 62, seed=2)
    shape, grid, interval, wraps = (18, 48, 50), 16, 6, (loop, tileable, tileable)
    made = VideoMosaic(
        PaddedClip(video).planes, shape, grid=grid, interval=interval, sharpness=sharpness,
        loop=loop, tileable=tileable, rng=np.random.default_rng(0), reach=reach,
    )  # fmt: skip
    points, sources = points_of(np.random.default_rng(0), shape, video.shape[:3], grid, interval, wraps)
    assert (made.sources == sources).all()
    options = {"grid": grid, "interval": interval, "sharpness": sharpness, "wraps": wraps}
    for number in (0, 7):
        expected = frame_of(video, shape, points, sources, number, ends=reach == "near" or sharpness >= 6, **options)
        assert np.abs(made.frame(number)[:, :, 0] - expected).max() < 0.5

"""The two-stage video patchwork: deviation kept in time and in space, still parts still, no seams."""

import numpy as np
import pytest

from app.synthesis.parallel import Team, Work
from app.synthesis.patchwork.jittered_cells import jittered_cells
from app.synthesis.patchwork.patchwork import Patchwork
from app.synthesis.patchwork.transfer import transfer
from app.synthesis.patchwork.transitions import Transitions
from app.synthesis.patchwork.video_patchwork import PaddedClip, VideoPatchwork, frames_in_order
from tests.synthesis.stopping import StopError
from tests.synthesis.videos import noise, size_of, steps, still, waves

SIZE = 64


def laid(grid=16, sharpness=6, tileable=True, size=SIZE):
    return jittered_cells(size, size, grid=grid, sharpness=sharpness, tileable=tileable, seed=3)


def in_time(video, cells, frames=40, loop=True):
    return Transitions(cells.count, len(video), frames, 10, loop=loop, rng=np.random.default_rng(4))


def patchwork(video, cells, frames=40, loop=True):
    _, height, width, channels = video.shape
    sources = cells.sources(height, width, 3)
    mean = video.mean((0, 1, 2)).astype(np.float32)
    clip = PaddedClip(video, cells.margin(sources, height, width))
    means = np.broadcast_to(mean, (cells.count, channels))
    return VideoPatchwork(clip, cells, sources, in_time(video, cells, frames, loop), means)


def made(video, cells, frames=40, loop=True):
    synthesis = patchwork(video, cells, frames, loop)
    return np.stack([synthesis.frame(number) for number in range(frames)])


def largest_shares(cells):
    """The largest part that a cell has of every pixel: 1 in the cores, less in the joins."""
    totals, largest = np.zeros((2, cells.height, cells.width))
    for part in cells.parts(cells.plane):
        totals[part.rows, part.columns] += part.weight
        np.maximum(largest[part.rows, part.columns], part.weight, out=largest[part.rows, part.columns])
    return largest / totals


def test_mean_and_deviation_of_every_pixel_over_time_are_the_clips_in_cores_and_in_joins():
    """Of 40 frames of 1500 pixels or more the deviation is known to 1 %, chance meetings of equal frames add 2 %.

    In the joins, where no patch has more than 0.6 of a pixel, feathering would leave at most 0.6² + 0.4² = 0.52 of the
    variance, and amid a transition half of that.
    """
    video, cells = noise(), laid()
    out, shares = made(video, cells), largest_shares(cells)
    for where in (shares > 0.95, shares < 0.6, np.ones_like(shares, bool)):
        pixels = out[:, where]
        assert where.sum() > 300
        assert pixels.mean() == pytest.approx(video.mean(), abs=1.5)
        over_time = np.sqrt(pixels.var(0).mean())
        assert over_time == pytest.approx(np.sqrt(video.var(0).mean()), rel=0.06)


def test_the_mean_over_time_is_the_patchwork_of_the_average_image():
    """The clip's deviation is 6, its average image's 40. Of 160 frames made of 40 the mean is known to 2 or so."""
    structure = np.random.default_rng(5).normal(128, 40, (1, SIZE, SIZE, 1))
    video = (
        (structure + np.random.default_rng(6).normal(0, 6, (40, SIZE, SIZE, 1))).round().clip(0, 255).astype(np.uint8)
    )
    cells = laid()
    out = made(video, cells, frames=160)
    static = made(np.repeat(video.mean(0)[None].round().astype(np.uint8), 40, 0), cells, frames=2)[0]
    assert size_of(out.mean(0) - static) < 3
    assert static.std() > 30


def test_a_clip_that_stands_still_comes_out_still_and_exactly_copied_at_the_centres():
    video, cells = still(), laid()
    out, sources = made(video, cells), cells.sources(SIZE, SIZE, 3)
    assert np.abs(out - out[0]).max() < 0.01
    inside = [index for index, (y, x) in enumerate(cells.centres) if 0 <= y < SIZE and 0 <= x < SIZE]
    assert len(inside) == cells.count
    for (y, x), (from_y, from_x) in zip(cells.centres[inside], sources[cells.cell[inside]], strict=True):
        assert np.abs(out[0, y, x] - video[0, from_y, from_x]).max() < 0.5


def test_each_frame_of_a_still_clip_is_the_patchwork_of_its_frame():
    video, cells = still(), laid()
    expected = Patchwork(video[0].astype(np.float32), cells, seed=3).rows(0, SIZE)
    expected = np.moveaxis(expected, 0, 2) if len(expected) == 3 else expected
    assert np.abs(made(video, cells, frames=3)[2] - expected).max() < 0.5


def test_local_means_give_the_transfer_of_a_still_clips_frame():
    video, cells = still(height=90, width=80), laid(grid=8, sharpness=2, tileable=False)
    pattern = 128 + 50 * np.random.default_rng(7).random((SIZE, SIZE, 3), np.float32)
    with Team(2) as team:
        work = Work(team, lambda stage, part: None)
        expected = transfer(video[0].astype(np.float32), pattern, cells, peak=255, candidates=20, seed=1, work=work)
    places = expected.matches.places
    clip = PaddedClip(video, cells.margin(places, 90, 80))
    frame = VideoPatchwork(clip, cells, places, in_time(video, cells)).frame(11)
    assert np.abs(frame.clip(0, 255) - expected.output).max() < 1


def test_in_a_loop_the_step_from_the_last_frame_to_the_first_is_like_any_other():
    looped, ended = (steps(made(waves(), laid(), loop=loop), 0) for loop in (True, False))
    assert looped[-1] < 1.2 * looped[:-1].max()
    assert ended[-1] > 2 * ended[:-1].max()


@pytest.mark.parametrize("axis", [1, 2], ids=["top and bottom", "left and right"])
def test_tileable_frames_have_no_seam(axis):
    """The steps between neighbours of a smooth clip are small, and so is the step over the border."""
    tiled, cut = (steps(made(waves(), laid(tileable=tileable), frames=6), axis) for tileable in (True, False))
    assert tiled[-1] < 1.2 * tiled[:-1].max()
    assert cut[-1] > 1.5 * cut[:-1].max()


@pytest.mark.parametrize("threads", [1, 3])
def test_frames_come_in_order_and_no_more_are_held_than_there_are_threads(threads):
    made, given, parts = [], 0, []

    def frame(number):
        made.append(number)
        return np.full((1, 1, 1), number, np.float32)

    for expected, found in enumerate(frames_in_order(frame, 8, threads, parts.append)):
        assert found[0, 0, 0] == expected
        given += 1
        assert len(made) - given < threads
    assert given == 8
    assert parts == sorted(parts)
    assert parts[-1] == 1


def test_what_the_progress_raises_ends_the_frames():
    def stop(part):
        raise StopError

    with pytest.raises(StopError):
        list(frames_in_order(lambda number: np.zeros((1, 1, 1), np.float32), 8, 2, stop))

"""The video cube: every face holds what the frames have there."""

import numpy as np
import pytest

from app.images.convert import GROUND
from app.images.video.cube import FRONT, LONGEST, MARGIN, SIDE, VideoCube
from tests.images.video.natural import natural_video


def picture(film: np.ndarray) -> np.ndarray:
    count, height, width, channels = film.shape
    cube = VideoCube(width, height, channels, count)
    for frame in film:
        cube.add(frame)
    return cube.draw()


def block(film: np.ndarray) -> np.ndarray:
    return picture(film)[MARGIN:-MARGIN, MARGIN:-MARGIN]


def dimmed(values: np.ndarray, brightness: float) -> np.ndarray:
    return np.rint(values * np.float32(brightness))


@pytest.mark.parametrize("channels", [1, 3])
def test_the_front_is_the_bottom_row_of_every_frame_and_time_runs_upwards(channels):
    """A video with a frame for every pixel of three quarters of its width is not stretched in time."""
    film = np.random.default_rng(0).integers(0, 256, (36, 20, 48, channels), dtype=np.uint8)
    drawn = block(film)
    assert drawn.shape == (36 + 10, 48 + 10, channels)
    assert (drawn[10:, :48] == dimmed(film[::-1, -1], FRONT)).all()


def test_a_short_video_is_stretched_by_whole_numbers():
    film = np.broadcast_to(np.arange(0, 250, 25, dtype=np.uint8)[:, None, None, None], (10, 20, 48, 1))
    front = block(film)[10:, 24, 0]
    assert front.shape == (30,)
    assert (front[1::3] == dimmed(film[::-1, 0, 0, 0], FRONT)).all()


def test_the_side_is_the_right_column_of_every_frame():
    """Drawn at half its length: rows that come in pairs and rise evenly keep their values, but near the ends."""
    film = np.zeros((36, 24, 48, 1), np.uint8)
    film[:, :, -1, 0] = 20 + 8 * np.repeat(np.arange(12), 2) + 3 * np.arange(36)[:, None]
    drawn = block(film)[..., 0].astype(int)
    for step in range(1, 11):
        column = drawn[12 - step : 12 - step + 36, 48 + step]
        assert np.abs(column - dimmed(film[::-1, 2 * (11 - step), -1, 0], SIDE)).max() <= 1


def test_the_top_is_the_last_frame_slanted():
    film = np.zeros((3, 24, 48, 3), np.uint8)
    film[-1] = np.linspace(0, 255, 48).astype(np.uint8)[:, None]
    drawn = block(film)
    for step in range(12):
        assert np.abs(drawn[11 - step, step + 1 : step + 49].astype(int) - film[-1, 0]).max() <= 1


def test_what_is_not_the_block_is_mid_grey():
    drawn = picture(np.zeros((36, 20, 48, 3), np.uint8))
    assert (drawn[[0, -1]] == GROUND).all()
    assert (drawn[:, [0, -1]] == GROUND).all()
    assert (drawn[MARGIN, MARGIN : MARGIN + 10] == GROUND).all()
    assert (drawn[-MARGIN - 1, -MARGIN - 8 :] == GROUND).all()
    share = (36 * 48 + 10 * 48 + 10 * 36) / drawn[..., 0].size
    assert (drawn == 0).mean() == pytest.approx(share, abs=1e-9)


@pytest.mark.parametrize(("count", "height", "width"), [(2000, 8, 8), (3, 1200, 30), (4, 30, 3000), (2, 1, 1)])
def test_its_size_is_bounded(count, height, width):
    """Whatever its size, it has its three faces, each of one brightness, and nothing else."""
    film = np.broadcast_to(np.array(200, np.uint8), (count, height, width, 1))
    drawn = block(film)
    assert max(drawn.shape) <= LONGEST + 1
    assert min(drawn.shape[:2]) >= 1
    faces = {GROUND, 200, round(200 * FRONT), round(200 * SIDE)}
    assert {*np.unique(drawn).tolist()} == faces
    assert (drawn[-1, 0], drawn[0, -1]) == (round(200 * FRONT), 200)


@pytest.mark.parametrize(
    ("shape", "front", "rise"),
    [
        ((36, 20, 48), (36, 48), 10),  # as it is
        ((40, 20, 48), (40, 48), 10),
        ((18, 20, 48), (36, 48), 10),  # twice as high in time
        ((17, 20, 48), (34, 48), 10),
        ((2, 20, 48), (8, 48), 10),  # four times, and no more
        ((1, 1, 1), (1, 1), 1),
        ((2000, 20, 48), (710, 47), 10),  # as many layers as there are pixels, and all of it 10 in 730 smaller
        ((36, 20, 2000), (52, 716), 4),  # stretched four times, then 720 in 2010 as large
        ((300, 1440, 30), (212, 21), 508),  # 720 in 1020 as large
    ],
)
def test_its_faces_have_the_sizes_of_the_video(shape: tuple[int, int, int], front: tuple[int, int], rise: int) -> None:
    drawn = block(np.full((*shape, 1), 200, np.uint8))
    assert drawn.shape == (front[0] + rise, front[1] + rise, 1)
    assert (drawn[rise:, : front[1]] == round(200 * FRONT)).all()
    assert (drawn == round(200 * FRONT)).sum() == front[0] * front[1]


def test_a_frame_goes_to_one_layer_from_below_upwards() -> None:
    """Not one layer is left out or written twice, however many frames there are for it."""
    for count in (5, 719, 720, 721, 1000, 1440):
        cube = VideoCube(2, 2, 1, count)
        for index in range(count):
            cube.add(np.full((2, 2, 1), index * 255 // count, np.uint8))
        layers = min(count, LONGEST)
        last = [max(i for i in range(count) if i * layers // count == layer) for layer in range(layers)]
        assert cube._front[::-1, 0, 0].tolist() == [index * 255 // count for index in last]
        assert (cube._side == cube._front).all()


def test_a_long_video_runs_from_its_first_to_its_last_frame():
    times = np.linspace(0, 255, 2000).astype(np.uint8)
    front = block(np.broadcast_to(times[:, None, None, None], (2000, 8, 8, 1)))[4:, 2, 0].astype(int)
    assert front[-1] <= 1
    assert front[0] >= dimmed(np.array(254), FRONT)
    assert (np.diff(front) <= 0).all()


def test_it_is_the_same_every_time():
    film = natural_video(20, 60, 80)
    assert (picture(film) == picture(film)).all()

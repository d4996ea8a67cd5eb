"""Weights that do not end: every sum of patches is that of the report's equations, over all cells."""

import numpy as np
import pytest
from scipy import ndimage

from app.synthesis.parallel import Team, Work
from app.synthesis.patchwork.jittered_cells import jittered_cells
from app.synthesis.patchwork.patchwork import Patchwork, paint_cells, patchwork
from app.synthesis.patchwork.transfer import transfer
from app.synthesis.patchwork.transitions import Transitions
from app.synthesis.patchwork.unbounded_cells import ENDS, cells_with_reach, radius
from app.synthesis.patchwork.video_patchwork import PaddedClip, VideoPatchwork
from tests.synthesis.full_sums import cells_at, mirrored, patchwork_sum, transfer_sum
from tests.synthesis.stopping import stops_at

HALF_A_LEVEL = 0.5
SHARPNESSES = [1, 1.5, 2, 3, 4, 5, 6]


def grain(height, width, channels=1, deviation=36, seed=0):
    """Of two pixels, with the contrast of photographs."""
    rng = np.random.default_rng(seed)
    found = ndimage.gaussian_filter(rng.normal(size=(height, width, channels)), (1.5, 1.5, 0))
    return (128 + deviation * found / found.std()).clip(0, 255).astype(np.float32)


def laid(height, width, grid, sharpness, tileable, reach="all", seed=1):
    cells = jittered_cells(height, width, grid=grid, sharpness=sharpness, tileable=tileable, seed=seed)
    return cells, cells_with_reach(cells, reach, tileable=tileable)


def whole(made):
    return made.rows(0, made.cells.height).transpose(1, 2, 0)


def deviation(made, expected):
    return float(np.sqrt(np.square(made - expected).mean()))


@pytest.mark.parametrize("sharpness", SHARPNESSES)
@pytest.mark.parametrize("tileable", [True, False])
def test_a_patchwork_is_the_sum_over_every_cell(sharpness, tileable):
    h = grain(110, 120)
    near, cells = laid(128, 144, 16, sharpness, tileable)
    made = Patchwork(h, cells, seed=3)
    assert deviation(whole(made), patchwork_sum(h, near, made.sources, tileable)) < HALF_A_LEVEL


@pytest.mark.parametrize("sharpness", [1, 2, 3, 4])
@pytest.mark.parametrize(
    ("tileable", "size"), [(True, (96, 107)), (True, (97, 16)), (False, (61, 30)), (False, (1, 90))]
)
def test_it_is_at_any_size_to_the_rounding_of_single_precision(sharpness, tileable, size):
    """Where no plane is wider than the distance up to which cells count, nothing is left out."""
    h = grain(80, 90)
    near, cells = laid(*size, 8, sharpness, tileable)
    made = Patchwork(h, cells, seed=3)
    if max(size) <= 2 * radius(sharpness) * near.unit and (tileable or max(size) < (radius(sharpness) - 3) * near.unit):
        np.testing.assert_allclose(whole(made), patchwork_sum(h, near, made.sources, tileable), atol=0.05)
    else:
        assert deviation(whole(made), patchwork_sum(h, near, made.sources, tileable)) < HALF_A_LEVEL


@pytest.mark.parametrize(("height", "width"), [(20, 30), (30, 100), (50, 40)])
@pytest.mark.parametrize("sharpness", [1, 2, 4])
def test_a_small_torus_counts_turns_as_far_as_two_spacings(height, width, sharpness):
    h = grain(150, 150)
    near, cells = laid(height, width, 20, sharpness, True)
    made = Patchwork(h, cells, seed=3)
    np.testing.assert_allclose(whole(made), patchwork_sum(h, near, made.sources, True), atol=0.05)


@pytest.mark.parametrize("sharpness", [2, 3, 4])
def test_what_is_left_out_far_away_is_the_hundredth_part_of_the_deviation_that_is_promised(sharpness):
    """On a plane that is wider than twice the radius, against all cells: of the order of 1 / 100, not a multiple."""
    h = grain(60, 60)
    near, cells = laid(40, 400, 4, sharpness, True)
    assert radius(sharpness) * near.unit < 200
    made = Patchwork(h, cells, seed=3)
    assert deviation(whole(made), patchwork_sum(h, near, made.sources, True)) < 1.5 * h.std() / 100


@pytest.mark.parametrize("sharpness", [1, 2, 3])
def test_weights_that_end_are_another_model_there(sharpness):
    """So the sums are told apart by the test above."""
    h = grain(110, 120)
    near, cells = laid(128, 144, 16, sharpness, True, "near")
    assert near is cells
    made = Patchwork(h, cells, seed=3)
    assert deviation(whole(made), patchwork_sum(h, near, made.sources, True)) > HALF_A_LEVEL


def test_from_six_on_they_are_the_same_and_the_sources_always_are():
    near, cells = laid(128, 144, 16, ENDS, True)
    assert near is cells
    near, cells = laid(128, 144, 16, 2, True)
    h = grain(110, 120)
    assert (Patchwork(h, near, seed=3).sources == Patchwork(h, cells, seed=3).sources).all()


@pytest.mark.parametrize("sharpness", [1, 2, 4])
def test_the_deviation_is_kept_by_all_cells_too(sharpness):
    """Of white noise, over 8 draws: 4 σ √(2 / 4n), n at most the places in the sample, 100²."""
    h = np.random.default_rng(1).uniform(0, 255, (200, 200, 1)).astype(np.float32)
    values = []
    for seed in range(8):
        _, cells = laid(96, 96, 12, sharpness, True, seed=seed)
        values.append(whole(Patchwork(h, cells, seed=seed)))
    assert abs(np.std(values) - h.std()) < 4 * h.std() * np.sqrt(2 / (4 * 100**2))


def test_feathering_is_the_plain_mean_of_all():
    h = grain(110, 120)
    near, cells = laid(96, 96, 16, 2, True)
    made = Patchwork(h, cells, blend="feather", seed=3)
    total, weights = np.zeros((96, 96, 1)), np.zeros((96, 96))
    for cell, down, across, weight in cells_at(near, True):
        rows, columns = mirrored(down + made.sources[cell][0], 110), mirrored(across + made.sources[cell][1], 120)
        total += h[np.ix_(rows, columns)] * weight[:, :, None]
        weights += weight
    np.testing.assert_allclose(whole(made), total / weights[:, :, None], atol=0.02)


def test_the_picture_of_the_cells_shows_the_same_weights():
    near, cells = laid(96, 96, 16, 2, True)
    colours = np.random.default_rng(0).uniform(0, 1, (cells.count, 3)).astype(np.float32)
    total, weights = np.zeros((96, 96, 3)), np.zeros((96, 96))
    for cell, _, _, weight in cells_at(near, True):
        total += colours[cell] * weight[:, :, None]
        weights += weight
    found = paint_cells(cells, colours, 0, 96).transpose(1, 2, 0)
    np.testing.assert_allclose(found, total / weights[:, :, None], atol=1e-4)


def test_at_a_centre_it_is_the_sample_and_a_constant_stays_constant():
    for tileable in (True, False):
        _, cells = laid(70, 60, 12, 1, tileable)
        h = grain(120, 120)
        made = Patchwork(h, cells, seed=2)
        inside = ((cells.centres >= 0) & (cells.centres < (70, 60))).all(1)
        y, x = cells.centres[inside].T
        assert whole(made)[y, x] == pytest.approx(h[tuple(made.sources[cells.cell[inside]].T)], abs=0.01)
        flat = np.full((120, 120, 3), (3, 90, 250), np.float32)
        assert np.abs(whole(Patchwork(flat, cells)) - (3, 90, 250)).max() < 0.01


@pytest.mark.parametrize("sharpness", [1, 2])
def test_a_torus_has_no_seam_at_its_border(sharpness):
    """A cell passes from one turn to the next elsewhere; across the border no step is larger than those inside."""
    y, x = np.mgrid[:200, :200] / 200
    h = (128 + 100 * np.sin(7 * x + 3 * y)[:, :, None] * np.cos(5 * y)[:, :, None]).astype(np.float32)
    _, cells = laid(96, 96, 16, sharpness, True, seed=4)
    texture = whole(Patchwork(h, cells, seed=4))
    for axis in (0, 1):
        steps = np.abs(
            np.diff(np.concatenate([texture, texture[:1] if axis == 0 else texture[:, :1]], axis), axis=axis)
        )
        steps = steps.mean(1 - axis)[:, 0]
        assert steps[-1] < steps[:-1].max()


def test_neither_threads_nor_the_rows_that_are_made_together_change_a_value():
    h = grain(60, 70)
    one, many = (patchwork(h, 150, 90, grid=10, sharpness=2, seed=5, threads=threads) for threads in (1, 3))
    assert (one == many).all()
    _, cells = laid(150, 90, 10, 2, True, seed=5)
    made = Patchwork(h, cells, seed=5)
    assert (np.concatenate([made.rows(0, 7), made.rows(7, 150)], 1).transpose(1, 2, 0) == one).all()


def test_work_stops_between_patches_when_the_progress_raises():
    h = grain(60, 70)
    stops_at(3, lambda progress: patchwork(h, 300, 90, grid=4, sharpness=1, seed=5, progress=progress))
    _, cells = laid(150, 90, 10, 2, True)
    calls = []

    def checkpoint():
        calls.append(1)
        if len(calls) == 5:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        Patchwork(h, cells).rows(0, 150, checkpoint)
    assert len(calls) == 5


@pytest.mark.parametrize("sharpness", SHARPNESSES)
def test_a_transfer_is_equation_seven_with_every_cell(sharpness):
    texture, pattern = grain(90, 80, 3), grain(64, 72, 3, seed=1)
    cells = jittered_cells(64, 72, grid=8, sharpness=sharpness, tileable=False, seed=0)
    with Team(2) as team:
        work = Work(team, lambda stage, part: None)
        made = transfer(texture, pattern, cells, reach="all", peak=255, candidates=20, seed=0, work=work)
    output, average = transfer_sum(texture, cells, made.matches.places)
    assert deviation(made.average, average) < HALF_A_LEVEL
    assert deviation(made.output, output.clip(0, 255)) < HALF_A_LEVEL


def still(frames=12, height=90, width=80):
    return np.repeat(grain(height, width, 3).round().astype(np.uint8)[None], frames, 0)


@pytest.mark.parametrize("sharpness", SHARPNESSES)
@pytest.mark.parametrize("tileable", [True, False])
def test_a_frame_of_a_video_patchwork_is_the_sum_over_every_cell(sharpness, tileable):
    """Of a still clip each frame is the patchwork of its picture."""
    video = still()
    near, cells = laid(64, 72, 8, sharpness, tileable)
    sources = near.sources(90, 80, 3)
    rng = np.random.default_rng(0)
    mean = video.mean((0, 1, 2), np.float64)
    transitions = Transitions(near.count, 12, 12, 4, loop=True, rng=rng)
    means = np.tile(mean.astype(np.float32), (near.count, 1))
    made = VideoPatchwork(PaddedClip(video, cells.margin(sources, 90, 80)), cells, sources, transitions, means)
    expected = patchwork_sum(video[0], near, sources, tileable, mean)
    assert deviation(made.frame(5), expected) < HALF_A_LEVEL


@pytest.mark.parametrize("sharpness", SHARPNESSES)
def test_a_frame_of_a_video_transfer_is_equation_seven_with_every_cell(sharpness):
    video = still()
    near, cells = laid(64, 72, 8, sharpness, False)
    places = near.sources(90, 80, 3)
    transitions = Transitions(near.count, 12, 12, 4, loop=True, rng=np.random.default_rng(0))
    made = VideoPatchwork(PaddedClip(video, cells.margin(places, 90, 80)), cells, places, transitions)
    expected, _ = transfer_sum(video[0], near, places)
    assert deviation(made.frame(5), expected) < HALF_A_LEVEL

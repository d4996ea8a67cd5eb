"""Texture transfer: sources, joins, colours."""

import numpy as np
import pytest

from app.synthesis.parallel import Team, Work
from app.synthesis.patchwork.cell_match import match_cells
from app.synthesis.patchwork.jittered_cells import jittered_cells, least_sample
from app.synthesis.patchwork.transfer import rescale, transfer
from tests.synthesis.images import image
from tests.synthesis.stopping import stops_at


def cells_of(pattern, *, grid=12, sharpness=2, seed=0):
    return jittered_cells(*pattern.shape[:2], grid=grid, sharpness=sharpness, tileable=False, seed=seed)


def rendered(texture, pattern, cells, *, candidates=50, seed=0, threads=1, progress=lambda stage, part: None):
    with Team(threads) as team:
        work = Work(team, progress)
        return transfer(texture, pattern, cells, peak=255, candidates=candidates, seed=seed, work=work)


def cut(seed=0):
    """A texture, a pattern cut from it, and where that was."""
    texture = image(100, 110, seed=seed).round()
    return texture, texture[20:80, 15:95], np.array((20, 15))


@pytest.mark.parametrize("sharpness", [2, 20])
def test_every_cell_of_a_pattern_cut_from_the_texture_comes_from_its_own_place(sharpness):
    texture, pattern, corner = cut()
    cells = cells_of(pattern, sharpness=sharpness)
    made = rendered(texture, pattern, cells, candidates=0)
    assert (made.matches.places == cells.centres + corner).all()
    assert (made.matches.errors == 0).all()


@pytest.mark.parametrize("sharpness", [2, 20])
def test_its_cores_are_the_pattern_at_eight_bits_and_its_joins_are_too_strong(sharpness):
    """All patches agree there, so equation (7) gives A + (P − A) Σw / √Σw² with the averages' image A, and the factor
    is at least 1: it is 1 at a centre, and wherever other cells have too little of a pixel to change its level.

    Of a pixel that is left to one cell but for a part t of the others, the factor is less than 1 + t, and P − A at most
    255: a level is kept where t < 1/1024 (with room for the rounding of single precision).
    """
    texture, pattern, _ = cut()
    cells = cells_of(pattern, sharpness=sharpness)
    made = rendered(texture, pattern, cells, candidates=0)
    inside = ((cells.centres >= 0) & (cells.centres < pattern.shape[:2])).all(1)
    y, x = cells.centres[inside].T
    assert (made.output.round()[y, x] == pattern[y, x]).all()
    total, squares = np.zeros((2, *pattern.shape[:2]))
    for part in cells.parts(cells.plane):
        total[part.rows, part.columns] += part.weight
        squares[part.rows, part.columns] += part.weight**2
    core = total - 1 < 1 / 1024
    assert (made.output.round()[core] == pattern[core]).all()
    if sharpness == 20:
        assert core.mean() > 0.4
    expected = made.average + (pattern - made.average) * (total / np.sqrt(squares))[:, :, None]
    assert made.output == pytest.approx(expected.clip(0, 255), abs=0.02)


def test_more_candidates_never_match_any_cell_worse():
    texture, pattern = image(90, 80), image(60, 70, seed=1)
    cells = cells_of(pattern)
    errors = [rendered(texture, pattern, cells, candidates=count).matches.errors for count in (1, 10, 200, 0)]
    assert (np.diff(errors, axis=0) <= 0).all()
    assert errors[-1].sum() < errors[0].sum()


def test_it_is_equation_seven():
    """Summed cell by cell as it stands, with the averages by the cells' shares; values that leave the range are cut."""
    texture, pattern = image(90, 80), image(40, 50, seed=1)
    cells = cells_of(pattern)
    made = rendered(texture, pattern, cells)
    margin = cells.margin(made.matches.places, *texture.shape[:2])
    around = np.pad(texture, ((margin, margin), (margin, margin), (0, 0)), "symmetric").astype(float)
    weights = np.zeros((cells.count, 40, 50))
    patches = np.zeros((cells.count, 40, 50, 3))
    for part in cells.parts(cells.plane):
        weights[part.centre, part.rows, part.columns] = part.weight
        y, x = made.matches.places[part.centre] + margin + part.source
        rows, columns = (np.arange(axis.start, axis.stop) for axis in (part.rows, part.columns))
        patches[part.centre, part.rows, part.columns] = around[np.ix_(y + rows, x + columns)]
    shares = weights / weights.sum(0)
    averages = (shares[..., None] * patches).sum((1, 2)) / np.maximum(shares.sum((1, 2)), 1e-30)[:, None]
    blended = np.tensordot(shares, averages, (0, 0))
    deviations = ((patches - averages[:, None, None]) * weights[..., None]).sum(0)
    expected = deviations / np.sqrt((weights**2).sum(0))[..., None] + blended
    assert made.average == pytest.approx(blended, abs=0.01)
    assert made.output == pytest.approx(expected.clip(0, 255), abs=0.02)


def test_the_averages_are_those_of_patches_and_stay_within_the_texture():
    """Σ a_i w_i / Σ w_i is a mean of means of the texture."""
    texture, pattern = image(90, 80) / 4 + 60, image(60, 70, seed=1)
    made = rendered(texture, pattern, cells_of(pattern))
    assert texture.min() - 0.01 <= made.average.min() <= made.average.max() <= texture.max() + 0.01
    assert 0 <= made.output.min() <= made.output.max() <= 255


def test_a_constant_texture_stays_constant():
    texture, pattern = np.full((80, 90, 3), (40, 120, 200), np.float32), image(60, 70)
    for candidates in (0, 5):
        made = rendered(texture, pattern, cells_of(pattern), candidates=candidates)
        assert np.abs(made.output - (40, 120, 200)).max() < 0.01


def test_neither_threads_nor_chance_beyond_the_seed_change_it():
    texture, pattern = image(90, 80), image(140, 60, seed=1)
    cells = cells_of(pattern)
    one, many, other = (
        rendered(texture, pattern, cells, threads=threads, seed=seed).output
        for threads, seed in ((1, 3), (3, 3), (1, 4))
    )
    assert (one == many).all()
    assert (one != other).any()


@pytest.mark.parametrize(("sharpness", "grid"), [(1, 8), (2, 8), (6, 8), (40, 8), (2, 4), (40, 4), (2, 33)])
def test_the_least_texture_holds_every_patch(sharpness, grid):
    """Sources lie where the compared square and the blend zone are inside, also for cells beyond the border."""
    pattern = image(3 * grid + 5, 4 * grid + 1, 1)
    side = least_sample(*pattern.shape[:2], grid, sharpness)
    texture = image(side, side, 1, seed=1)
    cells = cells_of(pattern, grid=grid, sharpness=sharpness)
    with Team(1) as team:
        work = Work(team, lambda stage, part: None)
        places = match_cells(texture, pattern, cells, peak=255, candidates=3, seed=0, work=work).places
    zones = cells.zones + np.repeat(places, 2, axis=1)
    seen = (cells.zones[:, 1] > cells.zones[:, 0]) & (cells.zones[:, 3] > cells.zones[:, 2])
    assert (zones[seen] >= 0).all()
    assert (zones[seen] <= side).all()


def test_rescaled_colours_have_the_textures_mean_and_range():
    texture, pattern = image(30, 40) / 2 + 20, image(20, 50, seed=1) / 3
    made = rescale(pattern, texture)
    assert made.mean((0, 1)) == pytest.approx(texture.mean((0, 1)), rel=1e-5)
    assert np.ptp(made, (0, 1)) == pytest.approx(np.ptp(texture, (0, 1)), rel=1e-5)


def test_a_flat_channel_of_the_pattern_takes_the_textures_mean():
    made = rescale(np.full((5, 6, 3), 7, np.float32), image(30, 40))
    assert np.ptp(made, (0, 1)).max() == 0
    assert made[0, 0] == pytest.approx(image(30, 40).mean((0, 1)), rel=1e-5)


@pytest.mark.parametrize("count", [2, 4, 6])
def test_it_stops_when_the_progress_raises(count):
    texture, pattern = image(90, 80), image(60, 70, seed=1)
    cells = cells_of(pattern)
    stops_at(count, lambda progress: rendered(texture, pattern, cells, progress=progress))

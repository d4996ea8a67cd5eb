"""Patchwork: equation (2) of the report, its claims about mean and deviation, and the two other joins."""

import numpy as np
import pytest

from app.synthesis.patchwork.cell_shapes import REACH
from app.synthesis.patchwork.jittered_cells import jittered_cells
from app.synthesis.patchwork.patchwork import Patchwork, paint_cells, patchwork
from tests.synthesis.full_sums import mirrored
from tests.synthesis.images import image
from tests.synthesis.stopping import stops_at

SIDE, GRID = 96, 16
DRAWS = 12


def laid(h, *, sharpness=6.0, tileable=True, seed=0, blend="deviation", height=SIDE, width=SIDE, grid=GRID):
    cells = jittered_cells(height, width, grid=grid, sharpness=sharpness, tileable=tileable, seed=seed)
    return Patchwork(h, cells, blend=blend, seed=seed)


def whole(made):
    """All of a texture, (H, W, C)."""
    return made.rows(0, made.cells.height).transpose(1, 2, 0)


def full_sum(h, made):
    """The texture on the torus by equation (2) in double precision, of all cells and their turns up to four away."""
    cells = made.cells
    y, x = np.mgrid[: cells.height, : cells.width]
    mean = h.mean((0, 1), np.float64)
    total, squares = np.zeros((*y.shape, h.shape[2])), np.zeros(y.shape)
    for cell, source in enumerate(made.sources):
        centre = cells.centres[cells.cell == cell][0]
        for turn in np.ndindex(9, 9):
            py, px = centre + (np.array(turn) - 4) * (cells.height, cells.width)
            weight = np.maximum(np.hypot(y - py, x - px), 1e-3) ** -cells.sharpness
            patch = h[mirrored(y - py + source[0], h.shape[0]), mirrored(x - px + source[1], h.shape[1])]
            total += (patch - mean) * weight[:, :, None]
            squares += weight**2
    return total / np.sqrt(squares)[:, :, None] + mean


def parts_of(cells):
    """w_i / sqrt(Σ w²) of every centre at every pixel, shape (N, H, W)."""
    parts = np.zeros((len(cells.centres), cells.height, cells.width))
    for part in cells.parts(cells.plane):
        parts[part.centre, part.rows, part.columns] = part.weight
    return parts / np.sqrt((parts**2).sum(0))


def ending_sum(h, made, blend):
    """The texture by the weights d^(−f) − R^(−f), which end, in double precision: every centre at every pixel."""
    cells, mean = made.cells, h.mean((0, 1), np.float64)
    y, x = np.mgrid[: cells.height, : cells.width]
    total, norm = np.zeros((*y.shape, h.shape[2])), np.zeros(y.shape)
    nearest = np.full(y.shape, np.inf)
    for (py, px), cell in zip(cells.centres, cells.cell, strict=True):
        source = made.sources[cell]
        d = np.maximum(np.hypot(y - py, x - px), 1e-3) / cells.unit
        patch = h[mirrored(y - py + source[0], h.shape[0]), mirrored(x - px + source[1], h.shape[1])] - mean
        weight = np.maximum(d**-cells.sharpness - REACH**-cells.sharpness, 0)
        if blend == "sharp":
            total[d < nearest] = patch[d < nearest]
            np.minimum(nearest, d, out=nearest)
            continue
        total += patch * weight[:, :, None]
        norm += weight if blend == "feather" else weight**2
    if blend != "sharp":
        total /= (norm if blend == "feather" else np.sqrt(norm))[:, :, None]
    return total + mean


@pytest.mark.parametrize("tileable", [True, False])
@pytest.mark.parametrize("sharpness", [1, 2, 6, 20])
@pytest.mark.parametrize("blend", ["deviation", "feather", "sharp"])
def test_every_blend_of_weights_that_end_is_its_plain_sum(blend, sharpness, tileable):
    """But for parts below 1/512, half a level or, feathered, one. Of two equally near centres either is the nearest."""
    h = image(180, 180)
    made = laid(h, sharpness=sharpness, tileable=tileable, blend=blend, height=64, width=70)
    off = np.abs(whole(made) - ending_sum(h, made, blend)).max(2)
    if blend == "sharp":
        assert (off > 0.01).mean() < 0.02
    else:
        assert off.max() < (1 if blend == "feather" else 0.5)


@pytest.mark.parametrize("sharpness", [6, 20])
def test_what_is_left_out_of_the_sums_changes_no_value_by_half_a_level(sharpness):
    """Against all terms in double precision, on noise of more contrast (53 levels) than photographs have.

    It holds from f = 6 on: at f = 5 single values are off by a whole level.
    """
    h = image(128, 128)
    made = laid(h, sharpness=sharpness, height=64, width=64)
    assert np.abs(whole(made) - full_sum(h, made)).max() < 0.5


@pytest.mark.parametrize("sharpness", [2, 6, 20, 40])
@pytest.mark.parametrize("tileable", [True, False])
def test_the_core_of_every_cell_is_an_exact_copy_of_the_sample(sharpness, tileable):
    """At 8 bits: where all other cells together have less than a half of a level, and at the centre itself."""
    h = np.round(image(160, 170))
    made = laid(h, sharpness=sharpness, tileable=tileable)
    texture, parts = np.round(whole(made)), parts_of(made.cells)
    others = parts.sum(0) - parts
    for index, (centre, cell) in enumerate(zip(made.cells.centres, made.cells.cell, strict=True)):
        y, x = np.nonzero((others[index] < 0.5 / 256) & (parts[index] > 0.9))
        assert not ((centre >= 0) & (centre < SIDE)).all() or centre.tolist() in np.stack([y, x], 1).tolist()
        source = np.stack([y, x], 1) - centre + made.sources[cell]
        assert (source >= 0).all()
        assert (texture[y, x] == h[source[:, 0], source[:, 1]]).all()


@pytest.mark.slow
@pytest.mark.parametrize("sharpness", [3, 6])
def test_mean_and_deviation_are_the_samples_in_the_joins_as_everywhere(sharpness):
    """Of a white sample of 256², uniform on 0–255, over 12 draws, which begin at places of at least 180² pixels.

    The mean of n independent values is off by less than 4 σ / √n with a chance of 1e-4, and the deviation of uniform
    ones, whose kurtosis is 1.8, by less than 4 σ √(0.8 / 4n) (smooth sums have up to 3: 4 σ √(2 / 4n)). Values are
    independent but for those that come from one place of the sample: n is at most 180².
    """
    h = np.random.default_rng(1).uniform(0, 255, (256, 256, 1)).astype(np.float32)
    values = {blend: [] for blend in ("deviation", "feather", "sharp")}
    inside = []
    for seed in range(DRAWS):
        for blend, found in values.items():
            made = laid(h, sharpness=sharpness, seed=seed, blend=blend)
            found.append(whole(made)[:, :, 0])
        inside.append(parts_of(made.cells).max(0) < 0.8)
    everywhere = {blend: np.array(found) for blend, found in values.items()}
    joins = {blend: found[np.array(inside)] for blend, found in everywhere.items()}
    sigma, mean = h.std(), h.mean()
    for kept in (joins["deviation"], everywhere["deviation"]):
        n = min(kept.size, 180**2)
        assert n > 5_000
        assert abs(kept.mean() - mean) < 4 * sigma / np.sqrt(n)
        assert abs(kept.std() - sigma) < 4 * sigma * np.sqrt(2 / (4 * n))
    assert abs(everywhere["sharp"].std() - sigma) < 4 * sigma * np.sqrt(2 / (4 * 180**2))
    assert joins["feather"].std() < 0.8 * sigma, "feathering is dull, so what the joins keep is the divisor's doing"


@pytest.mark.parametrize("blend", ["deviation", "feather"])
def test_a_torus_has_no_seam(blend):
    """On a smooth sample no step across the border is larger than those inside; without the torus they are."""
    y, x = np.mgrid[:200, :200] / 200
    h = (128 + 100 * np.sin(7 * x + 3 * y)[:, :, None] * np.cos(5 * y)[:, :, None]).astype(np.float32)
    for tileable in (True, False):
        texture = whole(laid(h, tileable=tileable, blend=blend, seed=4))
        across = max(np.abs(texture[0] - texture[-1]).max(), np.abs(texture[:, 0] - texture[:, -1]).max())
        inside = max(np.abs(np.diff(texture, axis=axis)).max() for axis in (0, 1))
        assert (across <= inside) == tileable


def test_one_cell_joins_itself_without_a_seam():
    y, x = np.mgrid[:200, :200] / 200
    h = (128 + 100 * np.sin(7 * x + 3 * y))[:, :, None].astype(np.float32)
    texture = whole(laid(h, height=30, width=30, grid=40))
    rolled = np.roll(texture, 15, (0, 1))
    assert np.abs(np.diff(rolled, axis=0))[14].max() <= np.abs(np.diff(texture, axis=0)).max()
    assert np.abs(np.diff(rolled, axis=1))[:, 14].max() <= np.abs(np.diff(texture, axis=1)).max()


def test_sharp_joins_only_copy():
    h = np.arange(100 * 110, dtype=np.float32).reshape(100, 110, 1)
    texture = whole(laid(h, blend="sharp"))
    assert np.abs(texture - np.round(texture)).max() < 0.01
    assert 0 <= np.round(texture.min()) <= np.round(texture.max()) < h.size
    across = np.abs(np.round(np.diff(texture[:, :, 0], axis=1)) - 1) > 0
    assert 0 < across.mean() < 0.2, "most neighbours come from neighbours"


def test_rows_can_be_made_in_any_order():
    """What is left out, less than half a level, depends on which rows are made together."""
    made = laid(image(120, 120))
    in_one = made.rows(0, SIDE)
    for top, bottom in ((50, 96), (3, 4), (0, 50)):
        np.testing.assert_allclose(made.rows(top, bottom), in_one[:, top:bottom], atol=0.5)


def test_the_picture_of_cells_mixes_their_colours_by_the_weights():
    cells = laid(image(120, 120)).cells
    colours = np.random.default_rng(0).uniform(0, 1, (cells.count, 3)).astype(np.float32)
    soft, hard = (paint_cells(cells, colours, 0, SIDE, soft=soft) for soft in (True, False))
    palette = {tuple(colour) for colour in colours.tolist()}
    assert {tuple(colour) for colour in hard.reshape(3, -1).T.tolist()} <= palette
    inside = [tuple(centre) for centre in cells.centres if ((centre >= 0) & (centre < SIDE)).all()]
    for y, x in inside:
        np.testing.assert_allclose(soft[:, y, x], hard[:, y, x], atol=1e-3)
    assert np.abs(np.diff(soft, axis=2)).max() < np.abs(np.diff(hard, axis=2)).max() / 2


def test_the_seed_alone_decides_and_not_the_threads():
    h = image(100, 100)
    first, again, other = (
        patchwork(h, 140, 90, grid=GRID, seed=seed, threads=threads) for seed, threads in ((1, 1), (1, 3), (2, 3))
    )
    assert first.shape == (140, 90, 3)
    assert (first == again).all()
    assert np.abs(first - other).mean() > 10


@pytest.mark.parametrize("count", [1, 2])
def test_what_the_progress_raises_ends_the_work(count):
    stops_at(count, lambda progress: patchwork(image(100, 100), 400, 90, grid=GRID, progress=progress))


def test_the_work_does_not_grow_faster_than_the_pixels():
    """Pixels of parts that are summed up, for each pixel: no more for 16 times as many, but for chance."""
    found = []
    for side in (128, 512):
        cells = laid(image(100, 100), height=side, width=side).cells
        found.append(sum(part.weight.size for part in cells.parts(cells.plane)) / side**2)
    assert found[1] == pytest.approx(found[0], rel=0.1)
    assert found[1] < np.pi * REACH**2

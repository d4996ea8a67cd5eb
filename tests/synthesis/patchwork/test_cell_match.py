"""Cells are matched by squares about their centres, and taken from where their blend zones lie in the texture."""

import numpy as np
import pytest

from app.synthesis.parallel import Team, Work
from app.synthesis.patchwork.cell_match import match_cells
from app.synthesis.patchwork.jittered_cells import jittered_cells
from tests.synthesis.images import image

GRID = 8


def laid(height=30, width=26, sharpness=6.0):
    return jittered_cells(height, width, grid=GRID, sharpness=sharpness, tileable=False, seed=2)


def matched(texture, pattern, cells, candidates, seed=1):
    with Team(2) as team:
        work = Work(team, lambda stage, part: None)
        return match_cells(texture, pattern, cells, peak=255, candidates=candidates, seed=seed, work=work)


def square(centre, cells):
    """Rows and columns of the plane within three quarters of a spacing of its place that is nearest to a centre."""
    half = round(0.75 * cells.unit)
    rows, columns = (
        [place for place in range(size) if abs(place - min(max(at, 0), size - 1)) <= half]
        for at, size in zip(centre, (cells.height, cells.width), strict=True)
    )
    return rows, columns


def allowed(cell, cells, rows, columns, shape):
    """Places of the texture at which the cell's zone, if it has one, and its square lie inside, by trying them all."""
    top, bottom, left, right = cells.zones[cell]
    y, x = cells.centres[cell]
    offsets = [(rows[0] - y, rows[-1] - y), (columns[0] - x, columns[-1] - x)]
    if top < bottom and left < right:
        zone = (top, bottom - 1), (left, right - 1)
        offsets = [(min(a, c), max(b, d)) for (a, b), (c, d) in zip(offsets, zone, strict=True)]
    return [
        (q, r)
        for q in range(-40, shape[0] + 40)
        for r in range(-40, shape[1] + 40)
        if all(at + a >= 0 and at + b < size for at, (a, b), size in zip((q, r), offsets, shape, strict=False))
    ]


@pytest.mark.parametrize("sharpness", [2, 6])
def test_every_cell_takes_the_best_of_all_places_by_the_plain_sum_over_its_square(sharpness):
    cells = laid(sharpness=sharpness)
    texture, pattern = image(44, 46).round(), image(30, 26, seed=1).round()
    found = matched(texture, pattern, cells, 0)
    assert len(found.places) == cells.count
    for cell in range(0, cells.count, 5):
        rows, columns = square(cells.centres[cell], cells)
        compared = pattern[np.ix_(rows, columns)].astype(np.float64)
        errors = {}
        for q, r in allowed(cell, cells, rows, columns, texture.shape):
            y, x = cells.centres[cell]
            there = texture[np.ix_([row - y + q for row in rows], [column - x + r for column in columns])]
            errors[q, r] = np.square(there - compared).sum()
        assert found.errors[cell] == min(errors.values()) == errors[tuple(found.places[cell])]
        assert found.sizes[cell] == len(rows) * len(columns)


@pytest.mark.parametrize("candidates", [1, 20, 0])
def test_the_blend_zone_lies_inside_the_texture(candidates):
    cells = laid()
    found = matched(image(44, 46), image(30, 26, seed=1), cells, candidates)
    zones = cells.zones + np.repeat(found.places, 2, axis=1)
    seen = (cells.zones[:, ::2] < cells.zones[:, 1::2]).all(1)
    assert zones[seen][:, ::2].min() >= 0
    assert (zones[seen][:, 1::2] <= (44, 46)).all()


def test_the_seed_draws_the_candidates():
    one, again, other = (matched(image(44, 46), image(30, 26, seed=1), laid(), 3, seed).places for seed in (1, 1, 2))
    assert (one == again).all()
    assert (one != other).any()

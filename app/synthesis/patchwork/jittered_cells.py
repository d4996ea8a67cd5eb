"""Jittered grid: one centre of a cell in each square, at a random place of its middle three quarters.

References
----------
P. Harrison, "Patchwork Texture Synthesis", Monash University technical report, 2002: section 3.
"""

from math import ceil, inf

import numpy as np

from .cell_shapes import Axis, extents, reach
from .cells import BLEND, LEFT_OUT, Cells, random_numbers

SLACK = 0.1  # of a spacing: how much wider all squares together may be than the grid parameter says


def least_sample(height: int, width: int, grid: int, sharpness: float) -> int:
    """Compute how many pixels each side of a sample must have to hold every blend zone, whatever the seed.

    Parameters
    ----------
    height, width : int
        Size of the plane, in pixels.
    grid, sharpness
        Those of `jittered_cells`.

    Returns
    -------
    int

    Examples
    --------
    >>> least_sample(512, 512, grid=64, sharpness=6) <= 256
    True
    """
    unit = max(axis.spacing for axis in _axes(height, width, grid, sharpness))
    return 2 * reach(unit, sharpness, BLEND) + 1


def jittered_cells(height: int, width: int, *, grid: int, sharpness: float, tileable: bool, seed: int) -> Cells:
    """Lay cells about the points of a jittered grid.

    Parameters
    ----------
    height, width : int
        Size of the plane in pixels, each at least 1.
    grid : int
        Spacing in pixels, at least 4; it becomes smaller, or at most a tenth larger, so that whole squares fit.
    sharpness : float
        f, from 1 to 40.
    tileable : bool
        Measure distances on the torus. Otherwise cells beyond the plane's border also take part.
    seed : int
        Not negative.

    Returns
    -------
    Cells

    Examples
    --------
    >>> cells = jittered_cells(40, 60, grid=20, sharpness=6, tileable=True, seed=1)
    >>> cells.count, cells.cores.shape
    (6, (6, 4))
    """
    rows, columns = _axes(height, width, grid, sharpness)
    squares = (rows.count + 2 * rows.beyond, columns.count + 2 * columns.beyond)
    if tileable:
        turn = [np.arange(-axis.beyond, axis.count + axis.beyond) % axis.count for axis in (rows, columns)]
        number = turn[0][:, None] * columns.count + turn[1][None, :]
    else:
        number = np.arange(squares[0] * squares[1]).reshape(squares)
    jitter = random_numbers(seed, 0).random((int(number.max()) + 1, 2))[number]
    y, x = rows.jittered(jitter[:, :, 0], 0), columns.jittered(jitter[:, :, 1], 1)
    number = number.ravel()
    found = extents(rows, columns, y, x, sharpness, (1, BLEND, LEFT_OUT)).reshape(3, 4, -1)
    shapes = np.full((3, 4, number.max() + 1), inf, np.float32)  # of a cell, all its centres together
    shapes[:, 1::2] = -inf
    for boxes, shape in zip(found, shapes, strict=True):
        for side in range(4):
            (np.maximum if side % 2 else np.minimum).at(shape[side], number, boxes[side])
    centres = np.stack([y.ravel(), x.ravel()], 1)
    boxes = shapes[2][:, number].T + np.repeat(centres, 2, axis=1)
    boxes = boxes.clip(0, [height, height, width, width])
    kept = np.flatnonzero((boxes[:, 0] < boxes[:, 1]) & (boxes[:, 2] < boxes[:, 3]))
    used, cell = np.unique(number[kept], return_inverse=True)
    shapes = np.where(np.isfinite(shapes), shapes, 0)[:, :, used].astype(np.int64)
    return Cells(
        height=height,
        width=width,
        sharpness=sharpness,
        unit=max(rows.spacing, columns.spacing),
        count=len(used),
        centres=centres[kept],
        cell=cell,
        boxes=boxes[kept].astype(np.int64),
        zones=shapes[1].T,
        cores=shapes[0].T,
    )


def _axes(height: int, width: int, grid: int, sharpness: float) -> tuple[Axis, Axis]:
    counts = [max(1, ceil(size / grid - SLACK)) for size in (height, width)]
    unit = max(height / counts[0], width / counts[1])
    pixels = reach(unit, sharpness, LEFT_OUT)
    rows, columns = (
        Axis(size, count, ceil(pixels * count / size) + 1) for size, count in zip((height, width), counts, strict=True)
    )
    return rows, columns

"""Cells to test, and plain formulas for what they claim."""

import numpy as np

from app.synthesis.patchwork.cell_shapes import log_weight
from app.synthesis.patchwork.jittered_cells import jittered_cells


def cells_of(height=48, width=60, grid=12, sharpness=6.0, tileable=True, seed=3):
    return jittered_cells(height, width, grid=grid, sharpness=sharpness, tileable=tileable, seed=seed)


def shares(cells):
    """Every centre's part of every pixel, w_i / sqrt(Σ w²), in double precision, shape (N, H, W)."""
    y, x = np.ogrid[: cells.height, : cells.width]
    d = np.hypot(*(at[None] - centre[:, None, None] for at, centre in zip((y, x), cells.centres.T, strict=True)))
    logs = log_weight(np.maximum(d, 1) / cells.unit, cells.sharpness)
    logs[d == 0] = 1000  # at a centre its cell is alone
    weights = np.exp(logs - logs.max(0))
    return weights / np.sqrt((weights**2).sum(0))


def inside(box, cells, centre=(0, 0)):
    """Mask of the pixels in a box, given relative to a centre."""
    top, bottom, left, right = box + np.repeat(np.asarray(centre), 2)
    y, x = np.ogrid[: cells.height, : cells.width]
    return (top <= y) & (y < bottom) & (left <= x) & (x < right)

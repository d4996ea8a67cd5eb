"""Patchwork: random patches of a sample, joined so that the joins cannot be seen.

    O(x) = Σ_i (I(x − p_i + q_i) − a) w_i(x) / sqrt(Σ_i w_i(x)²) + a,   w_i(x) = d(x, p_i)^(−f)

The patches are independent, so where they overlap the variance of the weighted sum is Σ w_i² times the sample's: the
divisor gives it the sample's again. Feathering divides by Σ w_i instead, and the joins are dull.

References
----------
P. Harrison, "Patchwork Texture Synthesis", Monash University technical report, 2002: equation (2) and figure 1.
"""

from collections.abc import Callable
from typing import Literal

import numpy as np

from ..arrays import Checkpoint, Ints, Progress, Real, ignore_progress
from ..parallel import Team, Work, row_blocks
from ..sinks import array_sink
from .cells import Cells, Part, Window
from .jittered_cells import jittered_cells
from .unbounded_cells import Reach, cells_with_reach

BAND, TILE = 192, 1024  # rows and columns that are joined at once: with smaller ones calls take longer than sums
SMALL_BAND, SMALL_TILE = 64, 512  # where all cells count: what is added to so often stays in the cache

Blend = Literal["deviation", "feather", "sharp"]


def _never_stop() -> None:
    """Never stop."""


class SamplePatches:
    """Pixels of a sample that the cells show: those at x − p_i + q_i.

    Parameters
    ----------
    planes : ndarray of float32, shape (C, H, W)
        The sample; beyond its border, where only the faint rest of a cell reaches, is its mirror image.
    cells : Cells
    sources : ndarray of int64, shape (cells.count, 2)
        q_i as (y, x), as `Cells.sources` gives them.
    """

    def __init__(self, planes: Real, cells: Cells, sources: Ints) -> None:
        _, height, width = planes.shape
        margin = cells.margin(sources, height, width)
        self._planes = np.pad(planes, [(0, 0), (margin, margin), (margin, margin)], "symmetric")
        self._start = sources[cells.cell] + margin

    def pixels(self, part: Part) -> Real:
        """Return the pixels that a part shows, shape (C, rows, columns), read-only."""
        y, x = self._start[part.centre] + part.source
        return self._planes[:, y + part.rows.start : y + part.rows.stop, x + part.columns.start : x + part.columns.stop]


class Patchwork:
    """Patches of a sample on cells; `rows` joins them.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
        The sample.
    cells : Cells
        Cells of the texture's size, with weights that end or that do not.
    blend : {"deviation", "feather", "sharp"}
        Keep the standard deviation in the joins, feather them, or show at each pixel the cell of the nearest centre;
        "sharp" needs weights that end.
    seed : int
        Not negative; draws the sources.

    Attributes
    ----------
    sources : ndarray of int64, shape (cells.count, 2)
        q_i as (y, x).

    Raises
    ------
    ValueError
        If the sample does not hold the cells.
    """

    def __init__(self, h: Real, cells: Cells, *, blend: Blend = "deviation", seed: int = 0) -> None:
        self.cells, self._blend = cells, blend
        height, width, _ = h.shape
        self.sources = cells.sources(height, width, seed)
        self._mean: Real = h.mean((0, 1), np.float64).astype(np.float32)
        self._patches = SamplePatches(h.transpose(2, 0, 1) - self._mean[:, None, None], cells, self.sources)

    def rows(self, top: int, bottom: int, checkpoint: Checkpoint = _never_stop) -> Real:
        """Compute rows ``top`` to ``bottom`` − 1 of the texture, any number of times and in any order.

        Parameters
        ----------
        top, bottom : int
        checkpoint : callable, optional
            Called between patches; what it raises stops the work.

        Returns
        -------
        ndarray of float32, shape (C, bottom − top, width)
        """
        out = np.zeros((len(self._mean), bottom - top, self.cells.width), np.float32)
        _join(out, top, self.cells, self._patches.pixels, self._blend, checkpoint)
        out += self._mean[:, None, None]
        return out


def paint_cells(
    cells: Cells, colours: Real, top: int, bottom: int, *, soft: bool = True, checkpoint: Checkpoint = _never_stop
) -> Real:
    """Paint rows of a picture of the cells, as in the report's figure 2.

    Parameters
    ----------
    cells : Cells
    colours : ndarray of float32, shape (cells.count, C)
        One of each cell.
    top, bottom : int
        First and last-plus-one row.
    soft : bool
        Mix the colours by the weights, so that the picture shows f.
    checkpoint : callable, optional
        Called between cells; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (C, bottom − top, cells.width)
    """
    out = np.zeros((colours.shape[1], bottom - top, cells.width), np.float32)
    blend: Blend = "feather" if soft else "sharp"
    _join(out, top, cells, lambda part: colours[cells.cell[part.centre], :, None, None], blend, checkpoint)
    return out


def band_rows(cells: Cells) -> int:
    """Return how many rows are best joined at once."""
    return BAND if cells.ends else SMALL_BAND


def _join(
    out: Real, top: int, cells: Cells, show: Callable[[Part], Real], blend: Blend, checkpoint: Checkpoint
) -> None:
    """Join what the parts show in rows from ``top`` on, which hold zeros."""
    bottom = top + out.shape[1]
    among = cells.reaching(Window(top, bottom, 0, cells.width))
    wide = TILE if cells.ends else SMALL_TILE
    for left in range(0, cells.width, wide):
        window = Window(top, bottom, left, min(left + wide, cells.width))
        tile = out[:, :, left : window.right]
        norm = np.zeros(tile.shape[1:], np.float32)
        room = np.empty(tile.size, np.float32)
        for part in cells.parts(window, among):
            checkpoint()
            there, shown = (part.rows, part.columns), show(part)
            if blend == "sharp":
                np.copyto(tile[:, *there], shown, where=part.weight == 1)
                continue
            norm[there] += part.weight if blend == "feather" else np.square(part.weight)
            terms = room[: len(tile) * part.weight.size].reshape(len(tile), *part.weight.shape)
            tile[:, *there] += np.multiply(shown, part.weight, out=terms)
        if blend != "sharp":
            tile /= norm if blend == "feather" else np.sqrt(norm, out=norm)


def patchwork(
    h: Real,
    height: int,
    width: int,
    *,
    grid: int = 64,
    sharpness: float = 6,
    blend: Blend = "deviation",
    reach: Reach = "all",
    tileable: bool = True,
    seed: int = 0,
    threads: int = 1,
    progress: Progress | None = None,
) -> Real:
    """Synthesize a patchwork of a sample as one array.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
        The sample, at least `microtexture.patchwork.jittered_cells.least_sample` pixels each way.
    height, width : int
        Size of the texture, in pixels.
    grid : int
        Spacing of the cells in pixels, at least 4.
    sharpness : float
        f, 1–40.
    blend : {"deviation", "feather", "sharp"}
        See `Patchwork`.
    reach : {"all", "near"}
        Whether all cells count at a pixel, or the weights end; see `microtexture.patchwork.unbounded_cells`.
    tileable : bool
        Whether opposite borders continue each other.
    seed : int
        Not negative.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between blocks of rows; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (height, width, C)
        Values may lie outside the sample's range.

    Raises
    ------
    ValueError
        If the sample does not hold the cells.

    Examples
    --------
    >>> h = np.random.default_rng(0).uniform(0, 255, (96, 96, 3)).astype(np.float32)
    >>> patchwork(h, 100, 130, grid=16, seed=7).shape
    (100, 130, 3)
    """
    cells = jittered_cells(height, width, grid=grid, sharpness=sharpness, tileable=tileable, seed=seed)
    if blend != "sharp":
        cells = cells_with_reach(cells, reach, tileable=tileable)
    joined = Patchwork(h, cells, blend=blend, seed=seed)
    texture = np.empty((height, width, h.shape[2]), np.float32)
    store = array_sink(texture)
    with Team(threads) as team:
        work = Work(team, progress or ignore_progress)
        work.run(
            "texture",
            lambda rows: store(rows[0], joined.rows(*rows, work.checkpoint)),
            row_blocks(height, band_rows(cells)),
        )
    return texture

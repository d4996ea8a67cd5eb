"""Unbounded cells, whose weights never end: the full sum of Harrison's equations (1) and (2) where f is low.

    w_i(x) = d(x, p_i)^(−f),   Σ_i over all cells.

Whether far cells count depends on f. Their patches are independent, so they add √(Σ w²) over them to what nearer ones
add: over the cells beyond the distance r that is as much as r^(1 − f). From f = 6 on, nothing of it is seen beyond
three spacings, where the weights of `microtexture.patchwork.cells` end. For f ≤ 1 it does not even converge, and the
texture depends on how many cells there are. They are:

- on a torus the n cells of the plane, each once, d being the distance on the torus: at its nearest turn. Where a cell
  changes from one turn to the next its weight goes on steadily, and what it shows jumps by the little that is left of
  it there; a torus of fewer than `SMALL` spacings to either side also counts other turns, up to that far;
- otherwise the cells of the plane and those around it that reach into it with the weights that end: to nearly three
  spacings from the border.

A cell farther away than `radius` along either axis is left out: all of them together are `LEFT_OUT` of the sample's
standard deviation.

Beyond the sample's border a patch shows its mirror image. Cells are laid out, and their sources drawn, by the weights
that end, so that both sums are of the same patches.

References
----------
P. Harrison, "Patchwork Texture Synthesis", Monash University technical report, 2002: section 3.
"""

from dataclasses import dataclass, fields
from functools import cached_property
from math import ceil, inf, pi
from typing import ClassVar, Literal

import numpy as np

from ..arrays import Ints, Real
from .cells import Cells, Part, Window

ENDS = 6.0  # f from which on no cell is seen beyond where the weights of `microtexture.patchwork.cells` end
LEFT_OUT = 1 / 100  # of the sample's deviation: half a level of 50
LEAST = 6.0  # spacings up to which all cells count, so that single values are right too
SMALL = 2.0  # spacings
UNIT, AT_CENTRE = 1e13, 1e18  # weight at one pixel, and at the centre: their squares, and far ones', are numbers
ROWS = 1 << 10  # rows of the table that are computed at once

Reach = Literal["all", "near"]


def radius(sharpness: float) -> float:
    """Compute the spacings beyond which all cells together are `LEFT_OUT`.

    That is ∫ r^(−2f) 2πr dr against the four cells of a corner.

    Examples
    --------
    >>> [round(radius(f), 1) for f in (1, 2, 3, 4)]
    [inf, 44.3, 6.0, 6.0]
    """
    if sharpness <= 1:
        return inf
    power = 2 * sharpness - 2
    corner = 4 * 2**sharpness
    return max(LEAST, float((2 * pi / (power * corner * LEFT_OUT**2)) ** (1 / power)))


def span(length: int, unit: float, sharpness: float, tileable: bool) -> tuple[int, int]:
    """Compute the pixels before and after a centre in which its cell counts, along an axis of the plane.

    Parameters
    ----------
    length : int
        Pixels of the plane along the axis.
    unit : float
        The spacing, in pixels.
    sharpness : float
        f.
    tileable : bool
        Whether the axis is circular.

    Returns
    -------
    before, after : int

    Examples
    --------
    >>> span(96, 16, 2, True), span(95, 16, 2, True), span(40, 16, 2, True), span(96, 16, 4, False)
    ((48, 47), (47, 47), (32, 32), (96, 96))
    """
    far = radius(sharpness) * unit
    if not tileable:
        most = int(min(far, length + 2 * ceil(LEAST * unit)))
        return most, most
    small = int(SMALL * unit)
    before, after = (small, small) if small > length // 2 else (length // 2, length - length // 2 - 1)
    return int(min(before, far)), int(min(after, far))


def count_terms(height: int, width: int, grid: int, sharpness: float, tileable: bool) -> int:
    """Estimate how many products of a weight and a pixel the sum has: pixels times the cells that count at each.

    Parameters
    ----------
    height, width : int
        Size of the plane, in pixels.
    grid : int
        The spacing, in pixels.
    sharpness : float
        f.
    tileable : bool

    Returns
    -------
    int

    Examples
    --------
    >>> count_terms(512, 512, 64, 2, True) == 512**2 * 64
    True
    """
    cells = 1.0
    for length in (height, width):
        most = sum(span(length, grid, sharpness, tileable)) + 1
        cells *= min(most, length if tileable else length + 6 * grid) / grid
    return ceil(height * width * max(1.0, cells))


def table_bytes(height: int, width: int, grid: float, sharpness: float, tileable: bool) -> int:
    """Compute the bytes that the table of weights takes.

    Parameters
    ----------
    height, width, grid, sharpness, tileable
        Those of `count_terms`.

    Returns
    -------
    int
    """
    down, across = (2 * max(span(length, grid, sharpness, tileable)) + 1 for length in (height, width))
    return 4 * (down * across + ROWS * across * 4)


def cells_with_reach(cells: Cells, reach: Reach, *, tileable: bool) -> Cells:
    """Make the same cells with weights that do not end; or return them, where that makes no difference.

    Parameters
    ----------
    cells : Cells
        With weights that end.
    reach : {"all", "near"}
        Whether all cells count at a pixel, or the weights end.
    tileable : bool
        Whether the cells are on a torus.

    Returns
    -------
    Cells
        Its `parts` are cheap: slices of one table, whose weights have a common factor at each pixel that is not 1.

    Examples
    --------
    >>> from microtexture.patchwork.jittered_cells import jittered_cells
    >>> cells = jittered_cells(60, 60, grid=10, sharpness=2, tileable=True, seed=1)
    >>> len(cells_with_reach(cells, "all", tileable=True).parts(Window(0, 1, 0, 1)))  # each once
    36
    """
    if reach == "near" or cells.sharpness >= ENDS:
        return cells
    size = np.array((cells.height, cells.width))
    spans = np.array([span(length, cells.unit, cells.sharpness, tileable) for length in size.tolist()])
    centres, cell = cells.centres, cells.cell
    if tileable:
        inside = np.flatnonzero(((centres >= 0) & (centres < size)).all(1))
        most = [ceil(after / length) + 1 for length, after in zip(size.tolist(), spans.max(1).tolist(), strict=True)]
        turns = np.stack(np.meshgrid(*(np.arange(-k, k + 1) for k in most), indexing="ij"), -1).reshape(-1, 1, 2)
        centres, cell = (centres[inside] + turns * size).reshape(-1, 2), np.tile(cell[inside], len(turns))
    boxes = np.empty((len(centres), 4), np.int64)
    boxes[:, ::2], boxes[:, 1::2] = centres - spans[:, 0], centres + spans[:, 1] + 1
    boxes = boxes.clip(0, np.repeat(size, 2))
    boxes[:, ::2] = np.minimum(boxes[:, ::2], size)
    kept = np.flatnonzero((boxes[:, 0] < boxes[:, 1]) & (boxes[:, 2] < boxes[:, 3]))
    same = {field.name: getattr(cells, field.name) for field in fields(cells)}
    return _Unbounded(**same | {"centres": centres[kept], "cell": cell[kept], "boxes": boxes[kept]})


@dataclass(frozen=True)
class _Unbounded(Cells):
    ends: ClassVar[bool] = False

    @cached_property
    def _reach(self) -> tuple[int, int]:
        away = np.abs(self.boxes - np.repeat(self.centres, 2, axis=1))
        return int(away[:, :2].max()), int(away[:, 2:].max())

    @cached_property
    def _weights(self) -> Real:
        """d^(−f), the centre in the middle."""
        down, across = self._reach
        rows, columns = (np.arange(-reach, reach + 1, dtype=np.float64) ** 2 for reach in (down, across))
        table = np.empty((len(rows), len(columns)), np.float32)
        for first in range(0, len(rows), ROWS):
            square = rows[first : first + ROWS, None] + columns
            np.maximum(square, 1, out=square)
            table[first : first + ROWS] = UNIT * square ** (-self.sharpness / 2)
        table[down, across] = AT_CENTRE
        return table

    def parts(self, window: Window, among: Ints | None = None) -> list[Part]:
        reaching = self.reaching(window, among)
        centres = self.centres[reaching]
        corner = np.array((window.top, window.left))
        boxes = self.boxes[reaching] - np.repeat(corner, 2)
        boxes = boxes.clip(0, [window.bottom - window.top] * 2 + [window.right - window.left] * 2)
        found = []
        for index, box, source in zip(reaching.tolist(), boxes.tolist(), (corner - centres).tolist(), strict=True):
            rows, columns = slice(*box[:2]), slice(*box[2:])
            y, x = (begin + reach for begin, reach in zip(source, self._reach, strict=True))
            weight = self._weights[y + rows.start : y + rows.stop, x + columns.start : x + columns.stop]
            found.append(Part(index, rows, columns, weight, (source[0], source[1])))
        return found

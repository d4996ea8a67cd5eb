"""Patches of random shape: Voronoi cells about the points of a jittered grid, with soft edges.

Cell i has the centre p_i and the weight of Harrison's equation (1), with a shoulder that ends it:

    w_i(x) = max(0, d(x, p_i)^(−f) − R^(−f)),   R = `REACH` spacings of the grid.

A centre lies on a whole pixel and anywhere in the middle three quarters of its square of the grid, so that every weight
is a slice of one table. The table holds logarithms: only their differences to the largest one at a pixel count, so no
f over- or underflows, and at a centre the cell alone is left.

With R = 3 the shoulder takes less from the weights than an 8-bit value shows where f ≥ 6. For smaller f it is a model
of its own: `microtexture.patchwork.unbounded_cells` has weights without end.

References
----------
P. Harrison, "Patchwork Texture Synthesis", Monash University technical report, 2002: section 3 and figure 2.
"""

from dataclasses import dataclass
from functools import cached_property
from math import inf, log
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.random import SFC64, Generator, SeedSequence

from ..arrays import Ints, Real
from .cell_shapes import log_weight

LEFT_OUT = 1 / 512  # of a pixel: a smaller part changes an 8-bit value by less than a half
LOG_LEFT_OUT = np.float32(log(LEFT_OUT))
BLEND = 1 / 16  # of a pixel: a cell's blend zone is where its part is larger
AT_CENTRE = 30.0  # logarithm of how much heavier a centre is than the pixel beside it


class Window(NamedTuple):
    """Rows ``top`` to ``bottom`` − 1 and columns ``left`` to ``right`` − 1 of the plane."""

    top: int
    bottom: int
    left: int
    right: int


class Part(NamedTuple):
    """Part of a window that one centre has.

    ``rows`` and ``columns`` are slices into the window; ``weight`` is (rows, columns) float32, as a part of the largest
    weight at each pixel; ``source`` = (y, x) is what must be added to a place of the window to be relative to the
    centre: window row r is row r + y of the patch, whose row 0 is the centre's.
    """

    centre: int
    rows: slice
    columns: slice
    weight: Real
    source: tuple[int, int]


@dataclass(frozen=True)
class Cells:
    """Cells that cover a plane, or a torus of the same size.

    All boxes are rows of four numbers: top, bottom, left, right, with ``bottom`` and ``right`` one past the last.

    Parameters
    ----------
    height, width : int
        Size of the plane, in pixels.
    sharpness : float
        f.
    unit : float
        The spacing in pixels, in which distances are measured.
    count : int
        Number of cells.
    centres : ndarray of int64, shape (N, 2)
        p_i as (y, x), N ≥ ``count``: centres outside the plane reach into it too.
    cell : ndarray of int64, shape (N,)
        The cell of each centre, 0 … count − 1. On the torus a cell has a centre at every turn, which must all have the
        same source; otherwise every centre is a cell of its own.
    boxes : ndarray of int64, shape (N, 4)
        In the plane, cut at its border: outside it a centre's part of a pixel is less than 1/512.
    zones : ndarray of int64, shape (count, 4)
        Relative to the centre: each cell's blend zone, where its part is at least 1/16.
    cores : ndarray of int64, shape (count, 4)
        Relative to the centre: what holds the Voronoi cell.
    """

    ends: ClassVar[bool] = True  # do the weights?
    height: int
    width: int
    sharpness: float
    unit: float
    count: int
    centres: Ints
    cell: Ints
    boxes: Ints
    zones: Ints
    cores: Ints

    @property
    def plane(self) -> Window:
        """The whole plane."""
        return Window(0, self.height, 0, self.width)

    @cached_property
    def _table(self) -> Real:
        """Logarithm of the weight at every distance of whole pixels, the centre in the middle."""
        reach = int(np.abs(self.boxes - np.repeat(self.centres, 2, axis=1)).max())
        square = np.arange(-reach, reach + 1, dtype=np.float64) ** 2
        d = np.sqrt(square[:, None] + square[None, :])
        d[reach, reach] = 1.0
        table = log_weight(d / self.unit, self.sharpness)
        table[reach, reach] += AT_CENTRE
        return table.astype(np.float32)

    def reaching(self, window: Window, among: Ints | None = None) -> Ints:
        """List the centres whose boxes meet a window, among all or among some."""
        boxes = self.boxes if among is None else self.boxes[among]
        top, bottom, left, right = boxes.T
        found = (top < window.bottom) & (bottom > window.top) & (left < window.right) & (right > window.left)
        indices = np.flatnonzero(found)
        return indices if among is None else among[indices]

    def parts(self, window: Window, among: Ints | None = None) -> list[Part]:
        """Compute every centre's weights in a window.

        Parameters
        ----------
        window : Window
            Inside the plane.
        among : ndarray of int64, optional
            Centres that include all that reach the window; default: all.

        Returns
        -------
        list of Part
            The sum of their weights is at least 1 at every pixel, as is the sum of the squares.
        """
        reaching = self.reaching(window, among)
        largest = np.full((window.bottom - window.top, window.right - window.left), -inf, np.float32)
        # The largest weight is the nearest centre's, and its core holds all that it is nearest to.
        cores = self.cores[self.cell[reaching]] + np.repeat(self.centres[reaching], 2, axis=1)
        for index, core in zip(reaching.tolist(), cores.tolist(), strict=True):
            rows, columns, logs = self._logs(index, core, window)
            np.maximum(largest[rows, columns], logs, out=largest[rows, columns])
        least = largest + LOG_LEFT_OUT
        parts = []
        for index, box in zip(reaching.tolist(), self.boxes[reaching].tolist(), strict=True):
            rows, columns, logs = self._logs(index, box, window)
            kept = logs > least[rows, columns]
            down, across = np.flatnonzero(kept.any(axis=1)).tolist(), np.flatnonzero(kept.any(axis=0)).tolist()
            if down:
                logs = logs[down[0] : down[-1] + 1, across[0] : across[-1] + 1]
                top, left = rows.start + down[0], columns.start + across[0]
                there = slice(top, top + logs.shape[0]), slice(left, left + logs.shape[1])
                weight = logs - largest[there]
                y, x = self.centres[index].tolist()
                parts.append(Part(index, *there, np.exp(weight, out=weight), (window.top - y, window.left - x)))
        return parts

    def _logs(self, index: int, box: list[int], window: Window) -> tuple[slice, slice, Real]:
        """Find where in a window a box lies, and the logarithms of a centre's weights there."""
        (y, x), (top, bottom, left, right) = self.centres[index].tolist(), box
        top, bottom = max(top, window.top), max(window.top, min(bottom, window.bottom))
        left, right = max(left, window.left), max(window.left, min(right, window.right))
        middle = len(self._table) // 2
        logs = self._table[middle + top - y : middle + bottom - y, middle + left - x : middle + right - x]
        return slice(top - window.top, bottom - window.top), slice(left - window.left, right - window.left), logs

    def sources(self, height: int, width: int, seed: int) -> Ints:
        """Draw a source for every cell: a place q_i of a sample such that the cell's blend zone lies inside the sample.

        The faint rest of a cell, less than 1/16 of a pixel, may reach over the border, by `margin` pixels at most.

        Parameters
        ----------
        height, width : int
            Size of the sample in pixels, each at least `least_sample`.
        seed : int
            Not negative.

        Returns
        -------
        ndarray of int64, shape (count, 2)
            (y, x); a pixel x of cell i shows the sample's pixel x − p_i + q_i.

        Raises
        ------
        ValueError
            If the sample is too small.
        """
        top, bottom, left, right = self.zones.T
        lows, highs = np.stack([-top, -left], 1), np.stack([height - bottom, width - right], 1)
        if (lows > highs).any():
            raise ValueError(f"A sample of {width} × {height} pixels does not hold the cells.")
        return random_numbers(seed, 1).integers(lows, highs, endpoint=True)

    def margin(self, sources: Ints, height: int, width: int) -> int:
        """Compute how far the boxes reach beyond a sample's border, where its mirror image is shown.

        Parameters
        ----------
        sources : ndarray of int64, shape (count, 2)
        height, width : int
            Size of the sample, in pixels.

        Returns
        -------
        int
            Pixels.
        """
        start = sources[self.cell] - self.centres
        first = self.boxes[:, ::2] + start
        last = self.boxes[:, 1::2] + start - (height, width)
        return max(0, int(-first.min()), int(last.max()))


def random_numbers(seed: int, stream: int) -> Generator:
    """Make a generator of random numbers, independent of those of other streams of the same seed."""
    return Generator(SFC64(SeedSequence(seed, spawn_key=(stream,))))

"""Patches of a sample, laid on the cells of a plane."""

import numpy as np
from numpy.typing import NDArray

from app.synthesis.cells import Cells, Part

Real = NDArray[np.float32]


class Patches:
    """What every part of a plane shows of a sample: its pixels at x − p_i + q_i.

    Parameters
    ----------
    planes : ndarray of float32, shape (C, H, W)
        The sample; beyond its border, where only the faint rest of a cell reaches, is its mirror image.
    cells : Cells
    sources : ndarray of int64, shape (cells.count, 2)
        q_i as (y, x), as `Cells.sources` gives them.
    """

    def __init__(self, planes: Real, cells: Cells, sources: NDArray[np.int64]) -> None:
        _, height, width = planes.shape
        margin = cells.margin(sources, height, width)
        self._planes = np.pad(planes, [(0, 0), (margin, margin), (margin, margin)], "symmetric")
        self._start = sources[cells.cell] + margin

    def of(self, part: Part) -> Real:
        """Pixels of a part, shape (C, rows, columns); not to be written to."""
        y, x = self._start[part.centre] + part.source
        return self._planes[:, y + part.rows.start : y + part.rows.stop, x + part.columns.start : x + part.columns.stop]

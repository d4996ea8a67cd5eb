"""Pictures of a video patchwork's cells in the colours of their sources, over space and over time.

References
----------
Harrison, "Patchwork texture synthesis", 2002, Figure 5.
"""

import numpy as np

from ..arrays import Double, Ints, Real
from .cells import Cells, Window
from .transitions import Transitions


def source_colours(places: Double | Ints, sides: tuple[int, int, int]) -> Real:
    """Colour places of a clip: red from left to right, green from top to bottom, blue from first to last frame.

    Parameters
    ----------
    places : ndarray, shape (n, 3)
        (t, y, x).
    sides : tuple of int
        Frames, height and width of the clip.

    Returns
    -------
    ndarray of float32, shape (n, 3)
        RGB, 0 to 255.

    Examples
    --------
    >>> source_colours(np.array([[0, 60, 79]]), (10, 61, 80)).tolist()
    [[255.0, 255.0, 0.0]]
    """
    parts = places[:, ::-1] / np.maximum(np.array(sides[::-1]) - 1, 1)
    colours: Real = (255 * parts.clip(0, 1)).astype(np.float32)
    return colours


class FixedCells:
    """Window of cells that are the same in every frame, each with a source that changes over time.

    Parameters
    ----------
    cells : Cells
    window : Window
        The part of the output's frames that is painted.
    sources : ndarray of int, shape (count of cells, 2)
        q_i as (y, x).
    transitions : Transitions
    sides : tuple of int
        Frames, height and width of the clip.
    """

    def __init__(
        self, cells: Cells, window: Window, sources: Ints, transitions: Transitions, sides: tuple[int, int, int]
    ) -> None:
        self._parts = cells.parts(window)
        self._cells = [int(cells.cell[part.centre]) for part in self._parts]
        self._sources, self._transitions, self._sides = sources, transitions, sides
        self._sums = np.zeros((window.bottom - window.top, window.right - window.left, 1), np.float32)
        for part in self._parts:
            self._sums[part.rows, part.columns, 0] += part.weight

    def paint(self, frame: int) -> Real:
        """Paint every cell of a frame in the colour of its source, mixed by the weights: (rows, columns, 3), 0–255."""
        places = np.column_stack([self._transitions.sources(frame), self._sources])
        colours = source_colours(places, self._sides)
        total = np.zeros((*self._sums.shape[:2], 3), np.float32)
        for part, cell in zip(self._parts, self._cells, strict=True):
            total[part.rows, part.columns] += part.weight[:, :, None] * colours[cell]
        total /= self._sums
        return total

"""What the methods that lay patches of a crop have in common."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInputError
from app.methods.model import Size
from app.synthesis.cells import Cells

Real = NDArray[np.float32]

LEAST_GRID = 4
BYTES_OF_CELL = 1000  # while cells are laid out


def refuse_small(size: Size, grid: int, needs: Callable[[int], tuple[int, int]]) -> None:
    """Refuse a crop that does not hold patches of a grid, with the largest grid that fits.

    Parameters
    ----------
    size : Size
        Of the crop.
    grid : int
    needs : callable ``(grid) -> (width, height)``
        Pixels that the crop must have.

    Raises
    ------
    InvalidInputError
        At ``parameters.grid``.
    """

    def fits(grid: int) -> bool:
        width, height = needs(grid)
        return width <= size.width and height <= size.height

    if not fits(grid):
        largest = next((smaller for smaller in range(grid - 1, LEAST_GRID - 1, -1) if fits(smaller)), None)
        width, height = needs(grid)
        raise InvalidInputError(
            f"Patches of grid {grid} need a crop of at least {width} × {height} pixels, and this one has "
            f"{size.width} × {size.height}: take "
            + (f"a grid of at most {largest}, or a larger crop." if largest else "a larger crop."),
            "parameters.grid",
        )


def cell_colours(cells: Cells, sources: NDArray[np.int64], places: Real) -> Real:
    """A colour for each cell, (count, 3): that of the middle of what it shows.

    Parameters
    ----------
    cells : Cells
    sources : ndarray of int64, shape (count, 2)
        q_i.
    places : ndarray of float32, shape (H, W, 3)
        A colour for every place of the sample. The middle of a cell that is cut off at the border may lie aside.
    """
    middle = sources + (cells.zones[:, ::2] + cells.zones[:, 1::2]) // 2
    y, x = middle.clip(0, np.array(places.shape[:2]) - 1).T
    colours: Real = places[y, x]
    return colours

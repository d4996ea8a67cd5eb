"""What the methods that lay patches of a crop have in common."""

from collections.abc import Callable

from app.errors import InvalidInputError
from app.methods.model import Size

LEAST_GRID = 4


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

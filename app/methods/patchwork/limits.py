"""Limits of the patchwork methods: crops too small for their patches, sums and searches too long, memory."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from app.errors import InvalidInputError
from app.methods.model import Size
from app.methods.params import Resolved
from app.methods.patchwork.params import LEAST_GRID, PatchParams
from app.synthesis.patchwork.cell_match import HALF
from app.synthesis.patchwork.cell_shapes import reach as near_reach
from app.synthesis.patchwork.cells import LEFT_OUT
from app.synthesis.patchwork.jittered_cells import SLACK
from app.synthesis.patchwork.unbounded_cells import ENDS, count_terms, span, table_bytes

BYTES_OF_CELL = 1000  # while cells are laid out
MOST_TERMS = 15 * 10**9  # of the sum over all cells: a minute or two on two processors
MOST_OF_A_VIDEO, MOST_OF_A_FRAME = 10**10, 5 * 10**8  # which mixes three pictures, and stops between frames only


def summed(params: PatchParams) -> bool:
    """Whether all cells count, and not only those that are near."""
    return params.reach == "all" and not _idle(params)


def idle_reach(sizes: Sequence[Size], resolved: Resolved[Any]) -> Mapping[str, str]:
    """Say of the reach that it is idle where far patches are not seen."""
    words = _idle(resolved.params)
    return {"reach": words} if words else {}


def _idle(params: PatchParams) -> str:
    if getattr(params, "blend", None) == "sharp":
        return "a sharp join shows the nearest patch alone; take another join, or leave it out."
    if params.sharpness >= ENDS:
        return f"from a sharpness of {ENDS:g} on only near patches count; take a lower sharpness, or leave it out."
    return ""


def refuse_long_sum(params: PatchParams, height: int, width: int, *, tileable: bool) -> None:
    """Refuse a plane in which too many cells count at each of too many pixels.

    Raises
    ------
    InvalidInputError
        At ``parameters.reach``.
    """
    products = count_terms(height, width, params.grid, params.sharpness, tileable)
    if summed(params) and products > MOST_TERMS:
        raise _too_long(products, f"{width} × {height} pixels", height * width)


def refuse_long_frames(products: int, height: int, width: int, frames: int) -> None:
    """Refuse the same of a video, whose frames have so many products each."""
    if products * frames > MOST_OF_A_VIDEO or products > MOST_OF_A_FRAME:
        raise _too_long(products, f"{width} × {height} pixels in each of {frames} frames", height * width)


def _too_long(products: int, counted: str, pixels: int) -> InvalidInputError:
    return InvalidInputError(
        f"About {products // pixels:,} patches count at every one of {counted}, which would take too long: let near "
        "patches alone count (reach: near), or take a larger grid, a sharpness of 6 or more, or a smaller texture.",
        "parameters.reach",
    )


@dataclass(frozen=True)
class Reached:
    """What joining patches on a plane of some height and width takes, at most."""

    params: PatchParams
    height: int
    width: int
    tileable: bool

    @property
    def all_cells(self) -> bool:
        """See `summed`."""
        return summed(self.params)

    @property
    def edge(self) -> int:
        """Pixels beyond the sample's border that patches may show."""
        unit = self.params.grid * (1 + SLACK)
        if not self.all_cells:
            return near_reach(unit, self.params.sharpness, LEFT_OUT)
        return max(
            max(span(length, unit, self.params.sharpness, self.tileable)) for length in (self.height, self.width)
        )

    @property
    def table_bytes(self) -> int:
        """Bytes of the table of weights."""
        if not self.all_cells:
            return 8 * (2 * self.edge + 1) ** 2
        unit, sharpness = self.params.grid * (1 + SLACK), self.params.sharpness
        return table_bytes(self.height, self.width, unit, sharpness, self.tileable)

    def sample_bytes(self, size: Size, channels: int) -> int:
        """Bytes of a still sample with what is around it, in single precision."""
        return 4 * channels * (size.width + 2 * self.edge) * (size.height + 2 * self.edge)


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


MOST_WORK = 10**11  # products: a few minutes on two processors
PRODUCTS_OF_A_PLACE = 16  # that comparing a patch with one of all places takes time for
SEARCHED_TEXTURE, SEARCHED_PATTERN = (8, 24), (16, 0)  # bytes for each value and for each pixel of them


def pattern_size(sizes: Sequence[Size]) -> tuple[int, int]:
    """Width and height of the pattern, which is the second input."""
    return sizes[1].width, sizes[1].height


def refuse_other_size(pattern: Size, resolved: Resolved[Any]) -> None:
    """Refuse a width or a height that is not the pattern's.

    Raises
    ------
    InvalidInputError
        At ``parameters.width`` or ``parameters.height``.
    """
    for name, length, own in (("width", resolved.width, pattern.width), ("height", resolved.height, pattern.height)):
        if length != own:
            raise InvalidInputError(
                f"The result always has the pattern's size ({pattern.width} × {pattern.height}); remove the {name} "
                f"{length}, or crop another pattern.",
                f"parameters.{name}",
            )


def refuse_long_search(texture: Size, pattern: Size, grid: int, candidates: int) -> None:
    """Refuse more comparisons than can be waited for.

    Raises
    ------
    InvalidInputError
        At ``parameters.candidates``, with how many can be compared.
    """
    cells = (pattern.width // grid + 6) * (pattern.height // grid + 6)
    products = max(texture.channels, pattern.channels) * (2 * round(HALF * grid) + 1) ** 2
    places = texture.width * texture.height
    work = cells * (places * PRODUCTS_OF_A_PLACE if candidates == 0 else min(candidates, places) * products)
    if work > MOST_WORK:
        most = MOST_WORK // (cells * products)
        raise InvalidInputError(
            f"Comparing about {cells:,} patches with {candidates or 'all'} places of a texture of {texture.width} × "
            f"{texture.height} pixels each would take too long: "
            + (f"take at most {most:,} candidates" if most else "take a smaller pattern")
            + (", or a smaller crop of the texture." if candidates == 0 else "."),
            "parameters.candidates",
        )


def search_bytes(texture: Size, pattern: Size) -> int:
    """Bytes that the search holds at its peak."""
    channels = max(texture.channels, pattern.channels)
    return sum(
        size.width * size.height * (channels * of_value + of_pixel)
        for size, (of_value, of_pixel) in ((texture, SEARCHED_TEXTURE), (pattern, SEARCHED_PATTERN))
    )

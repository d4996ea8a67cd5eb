"""What the methods that render a pattern in patches of a texture have in common."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from app.errors import InvalidInputError
from app.methods.model import Context, Fact, Picture, Size, StillParams
from app.methods.pictures import encode
from app.synthesis.cell_match import HALF
from app.synthesis.patch_match import Matches

MOST_WORK = 10**11  # products: a few minutes on two processors
PRODUCTS_OF_A_PLACE = 16  # that comparing a patch with one of all places takes time for
SEARCHED_TEXTURE, SEARCHED_PATTERN = (8, 24), (16, 0)  # bytes for each value and for each pixel of them

RESCALE: Any = Field(
    True,
    title="Rescale the pattern's colours",
    description="Give every channel of the pattern the texture's mean and range before they are compared, so that "
    "dark and light find their like. Off: the colours are compared as they are.",
)


def compared_pattern(pattern: NDArray[np.float32], rescale: bool, peak: int, context: Context) -> Picture:
    """The pattern as it was compared with the texture, whose ``peak`` it has."""
    title = "Pattern with the texture's mean and range" if rescale else "Pattern as it is compared"
    return encode("pattern", title, pattern, peak, context)


def pattern_size(sizes: Sequence[Size]) -> tuple[int, int]:
    """Width and height of the pattern, which is the second input."""
    return sizes[1].width, sizes[1].height


def match_facts(matches: Matches, channels: int, peak: int) -> tuple[Fact, ...]:
    """How well cells match the pattern, how many they are, and from how many places."""
    error = np.sqrt(matches.errors.sum() / (matches.sizes.sum() * channels)) * (255 / peak)
    return (
        Fact("error", "Difference of the patches from the pattern, root mean square", float(error), "of 255"),
        Fact("cells", "Cells", len(matches.places)),
        Fact("sources", "Different places that they were taken from", len(np.unique(matches.places, axis=0))),
    )


def refuse_other_size(pattern: Size, params: StillParams) -> None:
    """Refuse a width or a height that is not the pattern's.

    Raises
    ------
    InvalidInputError
        At ``parameters.width`` or ``parameters.height``.
    """
    for name, asked, own in (("width", params.width, pattern.width), ("height", params.height, pattern.height)):
        if asked and asked != own:
            raise InvalidInputError(
                f"A transfer is as large as its pattern, {pattern.width} × {pattern.height} pixels, and a {name} of "
                f"{asked} is asked for: leave width and height empty, or crop a larger or smaller pattern.",
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

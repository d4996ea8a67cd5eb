"""What methods of several samples have in common: they need the same range of values and the same channels."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from app.errors import InvalidInputError
from app.methods.model import Size, Slot, Source
from app.methods.params import Resolved
from app.synthesis.arrays import Real


def alike(sources: Sequence[Source]) -> list[Real]:
    """Pixels of several inputs in the first one's range, all with as many channels as the one that has most.

    A grey crop among colour ones becomes the colour image that looks the same: three equal channels.

    Examples
    --------
    >>> import numpy as np
    >>> grey, deep = np.full((2, 2, 1), 5, np.float32), np.full((1, 1, 3), 257, np.float32)
    >>> [pixels.shape for pixels in alike([Source(grey, 255), Source(deep, 65535)])]
    [(2, 2, 3), (1, 1, 3)]
    >>> float(alike([Source(grey, 255), Source(deep, 65535)])[1][0, 0, 0])
    1.0
    """
    channels = max(source.pixels.shape[2] for source in sources)
    found = []
    for source in sources:
        pixels = source.pixels
        if source.peak != sources[0].peak:
            pixels = pixels * np.float32(sources[0].peak / source.peak)
        found.append(np.repeat(pixels, channels, axis=2) if pixels.shape[2] < channels else pixels)
    return found


INPUTS = (Slot("sample", "Sample", "A photograph; crop a homogeneous region of it."),)


def refuse_other_size(size: Size, resolved: Resolved[Any]) -> None:
    """Refuse to add the smooth component of a crop to a texture of another size.

    Raises
    ------
    InvalidInputError
        At ``parameters.add_smooth``.
    """
    width, height = resolved.width, resolved.height
    if (width, height) != (size.width, size.height):
        raise InvalidInputError(
            f"The smooth component can be added only to a texture of the crop's own size, {size.width} × {size.height} "
            f"pixels, and {width} × {height} is asked for: take that size, or leave the smooth component out.",
            "parameters.add_smooth",
        )

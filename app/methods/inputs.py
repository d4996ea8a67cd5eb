"""Inputs of several samples: brought to one range of values and one number of channels."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from app.errors import InvalidInputError
from app.methods.model import Size, Slot, Source
from app.methods.params import Resolved
from app.synthesis.arrays import Real


def alike(sources: Sequence[Source]) -> list[Real]:
    """Bring the pixels of several inputs to the first one's range, and to as many channels as any of them has.

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
            f"pixels: choose that size instead of {width} × {height}, or leave the smooth component out.",
            "parameters.add_smooth",
        )

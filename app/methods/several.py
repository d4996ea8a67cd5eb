"""What methods of several samples have in common: they need the same range of values and the same channels."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.methods.model import Source

Real = NDArray[np.float32]


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

"""Array types and callback types that the numerics share.

Arrays are written (H, W, C): rows, columns, channels; or as planes (C, H, W), which are faster to work on.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float32]
"""Values of images, in the sample's own unit."""

Double = NDArray[np.float64]
"""Values of which single precision is not enough: means, sums, tables."""

Complex = NDArray[np.complex64]
"""Spectra."""

Ints = NDArray[np.int64]
"""Whole numbers: places, counts."""

Index = NDArray[np.intp]
"""Whole numbers that index an array."""

Mask = NDArray[np.bool_]
"""Which elements count."""

Bytes = NDArray[np.uint8]
"""Values of 8-bit pictures and videos."""

Pixels = NDArray[np.unsignedinteger]
"""Values of a picture of 8 or 16 bits."""

Progress = Callable[[str, float], None]
"""Called with a stage's name and the part of it that is done, 0–1; what it raises ends the work."""

PartDone = Callable[[float], None]
"""Called with the part of one stage that is done, 0–1; what it raises ends the work."""

Checkpoint = Callable[[], None]
"""Called between pieces of work; what it raises ends the work."""


def ignore_progress(stage: str, part: float) -> None:
    """Take a progress and do nothing: where nobody watches."""

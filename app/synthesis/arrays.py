"""Types of arrays and callbacks that the numerics share."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float32]
Complex = NDArray[np.complex64]
Ints = NDArray[np.int64]
Progress = Callable[[str, float], None]
"""Called with a stage's name and the part of it that is done, 0–1; what it raises ends the work."""

"""Sinks: what takes the rows of a texture as they are computed, and makes an array, a range or a picture of them.

Values outside a picture's range are cut off, or the histogram is stretched; they never wrap.
"""

import threading
from collections.abc import Callable, Iterable

import numpy as np

from .arrays import Pixels, Real

Sink = Callable[[int, Iterable[Real]], None]
Rows = Callable[[int, Pixels], None]


def array_sink(texture: Real) -> Sink:
    """Make a sink that writes all rows into an array (height, width, C)."""

    def store(first: int, planes: Iterable[Real]) -> None:
        for channel, plane in enumerate(planes):
            texture[first : first + len(plane), :, channel] = plane

    return store


class Extent:
    """A sink that measures the range of the values and keeps nothing.

    Parameters
    ----------
    peak : float
        Greatest value of the sample's range.

    Attributes
    ----------
    low, high : float
        Least and greatest value so far, and no less than 0 … ``peak``.
    """

    def __init__(self, peak: float) -> None:
        self.low, self.high = 0.0, float(peak)
        self._lock = threading.Lock()

    def __call__(self, first: int, planes: Iterable[Real]) -> None:
        for plane in planes:
            low, high = float(plane.min()), float(plane.max())
            with self._lock:
                self.low, self.high = min(self.low, low), max(self.high, high)


class Levels:
    """A sink that rounds values of [low, high] to the whole numbers 0 … peak and cuts off what lies outside.

    With [low, high] = [0, the sample's peak] values keep their place and those outside are cut off. With an
    `Extent`'s, the histogram is stretched: the same affine map for all channels takes everything into the range,
    and is the identity if nothing was outside.

    Parameters
    ----------
    rows : callable ``(first row, block)``
        Receives blocks (n, W, C), contiguous, uint8 for a peak of 255 and uint16 otherwise, valid during the call only.
    channels : int
        Planes of each call.
    low, high : float
        Values that become 0 and ``peak``.
    peak : int
        255 or 65535.
    """

    def __init__(self, rows: Rows, channels: int, low: float, high: float, peak: int) -> None:
        self._rows, self._channels = rows, channels
        self._scale = np.float32(peak / (high - low))
        self._shift = np.float32(0.5 - low * peak / (high - low))
        self._limit = np.float32(peak + 0.5).view(np.int32)
        self._type = np.uint8 if peak == 255 else np.uint16

    def __call__(self, first: int, planes: Iterable[Real]) -> None:
        pixels: Pixels | None = None
        for channel, plane in enumerate(planes):
            if self._scale != 1:
                np.multiply(plane, self._scale, out=plane)
            np.add(plane, self._shift, out=plane)
            # The bits of floats sort as whole numbers do (those below 0 too are below 0), which are faster to clip.
            bits = plane.view(np.int32)
            np.clip(bits, 0, self._limit, out=bits)
            if pixels is None:
                pixels = np.empty((*plane.shape, self._channels), self._type)
            # Rounded in the plane first: numpy is slow where it casts and strides at once.
            pixels[:, :, channel] = plane.astype(self._type)
        if pixels is not None:
            self._rows(first, pixels)

"""Power spectrum of a video, summed up while its noise is computed."""

import numpy as np

from ..arrays import Complex, Real

BAND = 2  # rows on either side of k₁ = 0 that are summed up for the slice through time


class VideoPower:
    """Sums of the squared modulus of a video's half spectrum, to be called with its rows, from several threads.

    Parameters
    ----------
    shape : tuple of int
        Frames, height and columns of the half spectrum.
    width : int
        Width of the video, in pixels.

    Attributes
    ----------
    power : ndarray of float32, shape (height, columns)
        Sum over all frequencies in time, and over the channels.
    """

    def __init__(self, shape: tuple[int, ...], width: int) -> None:
        frames, height, columns = shape
        self._values = frames * height * width
        self.power, self._still = (np.zeros((height, columns), np.float32) for _ in range(2))
        self._band = np.zeros((min(BAND, height // 2) + 1, frames, columns), np.float32)
        self._width = width

    def __call__(self, row: int, rows: list[int], block: Complex) -> None:
        """Add one channel of the rows ``rows``, k₁ = ± ``row``: ``block`` is (frames, rows, columns)."""
        squares = block.real**2 + block.imag**2
        self.power[rows] += squares.sum(0)
        self._still[rows] += squares[0]
        if row < len(self._band):
            self._band[row] += squares.sum(1)

    @property
    def in_time(self) -> Real:
        """Sum over the rows of at most `BAND` on either side of k₁ = 0, shape (frames, columns)."""
        total: Real = self._band.sum(0)
        return total

    @property
    def still(self) -> float:
        """Part of the variance that does not change with time, 0–1; 1 without any variance."""
        whole = self._sum(self.power)
        return self._sum(self._still) / whole if whole else 1.0

    @property
    def variance(self) -> float:
        """Variance of the video, the sum over its channels."""
        return self._sum(self.power) / self._values**2

    def _sum(self, power: Real) -> float:
        """Sum over the whole spectrum, of which one half is kept."""
        twice = np.full(power.shape[1], 2.0)
        twice[0] = 1
        if self._width % 2 == 0:
            twice[-1] = 1
        return float((power * twice).sum())

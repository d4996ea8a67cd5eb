"""Power spectrum of a video: what its noise keeps, measured while it is made."""

import numpy as np

from ..arrays import Complex, Real

BAND = 2  # rows of the spectrum on either side of k₁ = 0 that its slice through time is the mean of


class VideoPower:
    """Sums of the squared modulus of a video's half spectrum, which it is given row by row from several threads."""

    def __init__(self, shape: tuple[int, ...], width: int) -> None:
        frames, height, columns = shape
        self._values = frames * height * width
        self.power, self._still = (np.zeros((height, columns), np.float32) for _ in range(2))
        self._band = np.zeros((min(BAND, height // 2) + 1, frames, columns), np.float32)
        self._width = width

    def __call__(self, row: int, rows: list[int], block: Complex) -> None:
        squares = block.real**2 + block.imag**2
        self.power[rows] += squares.sum(0)
        self._still[rows] += squares[0]
        if row < len(self._band):
            self._band[row] += squares.sum(1)

    @property
    def in_time(self) -> Real:
        total: Real = self._band.sum(0)
        return total

    @property
    def still(self) -> float:
        whole = self._sum(self.power)
        return self._sum(self._still) / whole if whole else 1.0

    @property
    def variance(self) -> float:
        """Of the video, the sum over its channels."""
        return self._sum(self.power) / self._values**2

    def _sum(self, power: Real) -> float:
        """Over the whole spectrum, of which the half is kept."""
        twice = np.full(power.shape[1], 2.0)
        twice[0] = 1
        if self._width % 2 == 0:
            twice[-1] = 1
        return float((power * twice).sum())

"""The video cube: a film as a block whose vertical axis is time."""

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray
from PIL import Image

GROUND = 0x80
LONGEST = 512  # pixels of the block's width and of its height
MARGIN = 16
DEPTH = Fraction(1, 2)  # of a slanted side, for one of its front
SHADES = (0.86, 0.72)  # of the front and the right face; the top is as bright as the film


class VideoCube:
    """The block that a film's frames, stacked upwards, make; collected from one pass over the frames.

    The top face is the last frame, seen from the front; the front face is the bottom row of every frame, the right
    face the right column, over time that runs upwards.

    Parameters
    ----------
    width, height, channels, count : int
        Of the film.
    """

    def __init__(self, width: int, height: int, channels: int, count: int) -> None:
        self._front = np.zeros((count, width, channels), np.uint8)
        self._side = np.zeros((count, height, channels), np.uint8)
        self._top = np.zeros((height, width, channels), np.uint8)
        self._count = 0

    def add(self, frame: NDArray[np.uint8]) -> None:
        """Add a frame, (H, W, C) uint8."""
        self._front[self._count], self._side[self._count] = frame[-1], frame[:, -1]
        self._count += 1
        if self._count == len(self._front):
            self._top = frame.copy()

    def picture(self) -> NDArray[np.uint8]:
        """The block on mid-grey, (H, W, C) uint8."""
        count, width, channels = self._front.shape
        height = len(self._top)
        scale = min(1.0, LONGEST / max(width, count))
        across, up = max(1, round(width * scale)), max(1, round(count * scale))
        slant = max(1, round(height * scale * DEPTH))
        picture = np.full((up + slant + 2 * MARGIN, across + slant + 2 * MARGIN, channels), GROUND, np.uint8)
        front = _resized(self._front[::-1], across, up) * SHADES[0]
        picture[MARGIN + slant : MARGIN + slant + up, MARGIN : MARGIN + across] = np.rint(front)
        top = _resized(self._top, across, slant)
        side = np.rint(_resized(self._side[::-1, ::-1], slant, up) * SHADES[1])
        for step in range(slant):
            y, x = MARGIN + slant - 1 - step, MARGIN + 1 + step
            picture[y, x : x + across] = top[slant - 1 - step]
            picture[y : y + up, MARGIN + across + step] = side[:, step]
        return picture


def _resized(face: NDArray[np.uint8], width: int, height: int) -> NDArray[np.uint8]:
    image = Image.fromarray(np.ascontiguousarray(face[..., 0] if face.shape[2] == 1 else face))
    return np.asarray(image.resize((width, height), Image.Resampling.LANCZOS)).reshape(height, width, -1)

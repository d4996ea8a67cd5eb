"""The video cube: a video as a block of stacked frames, whose vertical axis is time, as in the report's figures."""

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from app.images.convert import GROUND

LONGEST = 720  # pixels of the block, slanted sides and all
MARGIN = 16
DEPTH = 0.5  # of the slanted sides, as in cabinet projection: drawn in full they look too long
HEIGHT, MOST_STRETCHED = 0.75, 4  # a short video is stretched in time to this part of its width, so often at most
FRONT, SIDE = 0.86, 0.7  # brightness of the two walls; the top has the video's own


class VideoCube:
    """The block that the frames of a video make when each is laid upon the one before.

    One looks down on the last frame. The front wall is the bottom row of every frame, the right wall the right column:
    what does not move makes upright stripes there, what moves evenly slanted ones.

    Parameters
    ----------
    width, height, channels, count : int
        Of the video.
    """

    def __init__(self, width: int, height: int, channels: int, count: int) -> None:
        layers = min(count, LONGEST)  # more cannot be told apart, and would have to be kept
        self._front = np.zeros((layers, width, channels), np.uint8)
        self._side = np.zeros((layers, height, channels), np.uint8)
        self._top = np.zeros((height, width, channels), np.uint8)
        self._count, self._added = count, 0

    def add(self, frame: NDArray[np.uint8]) -> None:
        """Lay the next frame, (H, W, C) uint8, upon the others."""
        layer = len(self._front) - 1 - self._added * len(self._front) // self._count
        self._front[layer], self._side[layer] = frame[-1], frame[:, -1]
        self._added += 1
        if self._added == self._count:
            self._top[:] = frame

    def picture(self) -> NDArray[np.uint8]:
        """The block on mid-grey, (H, W, C) uint8; one pixel for one pixel in width where that is small enough."""
        layers, width, channels = self._front.shape
        across, rise, up = self._sides(width, len(self._top), layers)
        picture = np.full((up + rise + 2 * MARGIN, across + rise + 2 * MARGIN, channels), GROUND, np.uint8)
        block = picture[MARGIN:-MARGIN, MARGIN:-MARGIN]
        block[rise:, :across] = _face(self._front, across, up, FRONT)
        top, side = _face(self._top, across, rise, 1.0), _face(self._side[:, ::-1], rise, up, SIDE)
        for step in range(rise):  # towards the back
            y = rise - 1 - step
            block[y, step + 1 : step + 1 + across] = top[y]
            block[y + 1 : y + 1 + up, across + step] = side[:, step]
        return picture

    @staticmethod
    def _sides(width: int, height: int, layers: int) -> tuple[int, int, int]:
        """Width and height of the front, and by how much the slanted edges rise, which is as far as they go right."""
        stretched = layers * min(MOST_STRETCHED, max(1, int(HEIGHT * width / layers)))
        rise = DEPTH * height
        scale = min(1.0, LONGEST / (max(width, stretched) + rise))
        across, back, up = (max(1, round(side * scale)) for side in (width, rise, stretched))
        return across, back, up


def _face(face: NDArray[np.uint8], width: int, height: int, brightness: float) -> NDArray[np.uint8]:
    image = Image.fromarray(np.ascontiguousarray(face[..., 0] if face.shape[2] == 1 else face))
    resized = np.asarray(image.resize((width, height), Image.Resampling.LANCZOS)).reshape(height, width, -1)
    return np.rint(resized * np.float32(brightness)).astype(np.uint8)

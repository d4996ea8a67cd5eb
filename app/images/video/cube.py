"""Video cube: a picture of a video as a block of stacked frames, with time as the vertical axis."""

import numpy as np
from PIL import Image

from app.images.convert import GROUND
from app.synthesis.arrays import Bytes

LONGEST = 720  # pixels of the block, slanted sides and all
MARGIN = 16
DEPTH = 0.5  # of the slanted sides, as in cabinet projection: drawn in full they look too long
HEIGHT, MOST_STRETCHED = 0.75, 4  # a short video is stretched in time to 0.75 of its width, 4 times at most
FRONT, SIDE = 0.86, 0.7  # brightness of the two walls; the top keeps the video's


class VideoCube:
    """A block of the frames of a video, each laid on the one before.

    The view is from above, on the last frame. The front wall is the bottom row of every frame, the right wall its right
    column: what stands still makes upright stripes there, what moves evenly makes slanted ones.

    Parameters
    ----------
    width, height : int
        Of a frame.
    channels : int
        1 (grey) or 3 (RGB).
    count : int
        Number of frames.
    """

    def __init__(self, width: int, height: int, channels: int, count: int) -> None:
        layers = min(count, LONGEST)  # more could not be told apart, and would take memory
        self._front = np.zeros((layers, width, channels), np.uint8)
        self._side = np.zeros((layers, height, channels), np.uint8)
        self._top = np.zeros((height, width, channels), np.uint8)
        self._count, self._added = count, 0

    def add(self, frame: Bytes) -> None:
        """Lay the next frame, (H, W, C) uint8, on the others; only its edges are kept."""
        layer = len(self._front) - 1 - self._added * len(self._front) // self._count
        self._front[layer], self._side[layer] = frame[-1], frame[:, -1]
        self._added += 1
        if self._added == self._count:
            self._top[:] = frame

    def draw(self) -> Bytes:
        """Draw the block on mid-grey, (H, W, C) uint8, no side of it above 720 pixels; a small video is not reduced."""
        layers, width, channels = self._front.shape
        across, rise, up = self._compute_sides(width, len(self._top), layers)
        picture = np.full((up + rise + 2 * MARGIN, across + rise + 2 * MARGIN, channels), GROUND, np.uint8)
        block = picture[MARGIN:-MARGIN, MARGIN:-MARGIN]
        block[rise:, :across] = _render_face(self._front, across, up, FRONT)
        top, side = _render_face(self._top, across, rise, 1.0), _render_face(self._side[:, ::-1], rise, up, SIDE)
        for step in range(rise):  # towards the back
            y = rise - 1 - step
            block[y, step + 1 : step + 1 + across] = top[y]
            block[y + 1 : y + 1 + up, across + step] = side[:, step]
        return picture

    @staticmethod
    def _compute_sides(width: int, height: int, layers: int) -> tuple[int, int, int]:
        """Compute width and height of the front, and the rise of the slanted edges, which go as far to the right."""
        stretched = layers * min(MOST_STRETCHED, max(1, int(HEIGHT * width / layers)))
        rise = DEPTH * height
        scale = min(1.0, LONGEST / (max(width, stretched) + rise))
        across, back, up = (max(1, round(side * scale)) for side in (width, rise, stretched))
        return across, back, up


def _render_face(face: Bytes, width: int, height: int, brightness: float) -> Bytes:
    image = Image.fromarray(np.ascontiguousarray(face[..., 0] if face.shape[2] == 1 else face))
    resized = np.asarray(image.resize((width, height), Image.Resampling.LANCZOS)).reshape(height, width, -1)
    return np.rint(resized * np.float32(brightness)).astype(np.uint8)

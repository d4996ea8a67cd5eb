"""Stored video: a frame stack, all frames one below the other in one PNG file.

So a crop of any frame is a rectangle of one picture, and is read without decoding the others.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.images.crop import Frames, Rectangle
from app.images.png_writer import Pixels
from app.images.read import has_transparency, read_opaque, read_rectangle


def locate_crop(crop: Rectangle, frame: int, height: int) -> Rectangle:
    """Where a frame's crop lies in the stack of frames of this height.

    Examples
    --------
    >>> locate_crop(Rectangle(5, 6, 20, 10), 2, 100)
    Rectangle(x=5, y=206, width=20, height=10)
    """
    return Rectangle(crop.x, crop.y + frame * height, crop.width, crop.height)


def read_frames(path: Path, crop: Rectangle, frames: Frames, height: int) -> NDArray[np.uint8]:
    """Cut a crop out of a range of frames.

    Parameters
    ----------
    path : Path
        The frame stack; `app.images.png_writer` has written it.
    crop : Rectangle
        Inside a frame.
    frames : Frames
    height : int
        Of a frame.

    Returns
    -------
    ndarray of uint8, shape (T, H, W, C)

    Raises
    ------
    InvalidInputError
        If the crop reaches outside the stack or holds pixels that are not opaque.
    """
    first = read_opaque(path, locate_crop(crop, frames.first, height))
    film = np.empty((frames.count, *first.shape), np.uint8)
    film[0] = first
    for index in range(1, frames.count):
        film[index] = read_opaque(path, locate_crop(crop, frames.first + index, height))
    return film


def read_frame(path: Path, frame: int, width: int, height: int) -> Pixels:
    """Cut a whole frame out of a stack: (H, W, C), with its alpha as the last channel where the stack has one."""
    colour, alpha = read_rectangle(path, locate_crop(Rectangle(0, 0, width, height), frame, height))
    return colour if alpha is None else np.dstack([colour, alpha])


def frames_have_transparency(path: Path, crop: Rectangle, frames: Frames, height: int) -> bool:
    """Whether the crop holds a pixel that is not opaque in any of the frames."""
    return any(
        has_transparency(path, locate_crop(crop, frame, height))
        for frame in range(frames.first, frames.first + frames.count)
    )

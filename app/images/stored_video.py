"""Stored video: a frame stack, all frames one below the other in one PNG file.

A crop of any frame is a rectangle of one picture, and is read without decoding the other frames.
"""

from pathlib import Path

import numpy as np

from app.images.crop import Frames, Rectangle
from app.images.png_writer import Pixels
from app.images.read import has_transparency, read_opaque, read_rectangle
from app.synthesis.arrays import Bytes


def locate_crop(crop: Rectangle, frame: int, height: int) -> Rectangle:
    """Find where the crop of a frame lies in the frame stack.

    Parameters
    ----------
    crop : Rectangle
        Inside a frame.
    frame : int
        Its number, from 0.
    height : int
        Of a frame.

    Returns
    -------
    Rectangle

    Examples
    --------
    >>> locate_crop(Rectangle(5, 6, 20, 10), 2, 100)
    Rectangle(x=5, y=206, width=20, height=10)
    """
    return Rectangle(crop.x, crop.y + frame * height, crop.width, crop.height)


def read_frames(path: Path, crop: Rectangle, frames: Frames, height: int) -> Bytes:
    """Cut a crop out of a range of frames.

    Parameters
    ----------
    path : Path
        The frame stack, written by `app.images.png_writer`.
    crop : Rectangle
        Inside a frame.
    frames : Frames
        Inside the video.
    height : int
        Of a frame.

    Returns
    -------
    ndarray of uint8, shape (T, H, W, C)
        C is 1 or 3.

    Raises
    ------
    InvalidInputError
        If the crop reaches outside the stack or holds pixels that are not opaque.
    """
    first = read_opaque(path, locate_crop(crop, frames.first, height))
    video = np.empty((frames.count, *first.shape), np.uint8)
    video[0] = first
    for index in range(1, frames.count):
        video[index] = read_opaque(path, locate_crop(crop, frames.first + index, height))
    return video


def read_frame(path: Path, frame: int, width: int, height: int) -> Pixels:
    """Cut a whole frame out of a frame stack.

    Parameters
    ----------
    path : Path
        The frame stack, written by `app.images.png_writer`.
    frame : int
        Its number, from 0.
    width, height : int
        Of a frame.

    Returns
    -------
    ndarray of uint8, shape (H, W, C)
        The alpha is the last channel, where the stack has one.

    Raises
    ------
    InvalidInputError
        If the stack has no such frame.
    """
    colour, alpha = read_rectangle(path, locate_crop(Rectangle(0, 0, width, height), frame, height))
    return colour if alpha is None else np.dstack([colour, alpha])


def frames_have_transparency(path: Path, crop: Rectangle, frames: Frames, height: int) -> bool:
    """Whether a crop holds a pixel that is not opaque in any of the frames.

    Parameters
    ----------
    path : Path
        The frame stack, written by `app.images.png_writer`.
    crop : Rectangle
        Inside a frame.
    frames : Frames
        Inside the video.
    height : int
        Of a frame.

    Raises
    ------
    InvalidInputError
        If the crop reaches outside the stack.
    """
    return any(
        has_transparency(path, locate_crop(crop, frame, height))
        for frame in range(frames.first, frames.first + frames.count)
    )

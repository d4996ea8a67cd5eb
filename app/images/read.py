"""Reading a crop of a stored picture."""

from pathlib import Path

import imagecodecs
import numpy as np
from numpy.typing import NDArray

from app.errors import InvalidInputError
from app.images.crop import Rectangle
from app.images.formats.raw import with_channels
from app.images.png import Pixels


def read_crop(path: Path, rectangle: Rectangle) -> NDArray[np.float32]:
    """Cut a rectangle out of a stored PNG file.

    Parameters
    ----------
    path : Path
        A file written by `app.images.intake`.
    rectangle : Rectangle
        It must lie within the picture.

    Returns
    -------
    ndarray, shape (H, W, C)
        float32, 0 to 255 or 0 to 65535 as the file's depth says; C is 1 or 3.

    Raises
    ------
    InvalidInputError
        If the rectangle reaches outside the picture or holds pixels that are not opaque.
    """
    colour, alpha = _cut(path, rectangle)
    if alpha is not None and _see_through(alpha):
        raise InvalidInputError(
            f"The crop {rectangle} holds transparent pixels, which have no colour to learn from: "
            "move it to where the picture is opaque, or fill the background in an image editor.",
            "crop",
        )
    return colour.astype(np.float32)


def has_transparency(path: Path, rectangle: Rectangle) -> bool:
    """Whether a rectangle of a stored PNG file holds a pixel that is not opaque."""
    alpha = _cut(path, rectangle)[1]
    return alpha is not None and _see_through(alpha)


def _cut(path: Path, rectangle: Rectangle) -> tuple[Pixels, Pixels | None]:
    array = imagecodecs.png_decode(path.read_bytes())
    height, width = array.shape[:2]
    area = rectangle.within(width, height)
    return with_channels(array[area.y : area.y + area.height, area.x : area.x + area.width])


def _see_through(alpha: Pixels) -> bool:
    return bool(alpha.min() < np.iinfo(alpha.dtype).max)

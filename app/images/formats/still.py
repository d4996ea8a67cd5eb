"""Still pictures as their decoders return them, and the checks that all decoders share."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from PIL import Image

from app.errors import BrokenFileError, TooLargeError
from app.images.png_writer import Pixels

OPAQUE = 0.99
EXIF_ORIENTATION = 0x0112
DAMAGED = "This {} file is damaged or incomplete: open it in an image editor, save it again and upload the new file."


@dataclass(frozen=True)
class Raw:
    """A still picture as its file holds it: not yet upright, not yet sRGB.

    ``pixels`` is (H, W, C), uint8 or uint16 over the whole range of its type; C is 1 (grey), 3 (RGB) or 4 (CMYK, 0 is
    no ink). ``alpha`` is (H, W) of the same type, not premultiplied, or None. ``profile`` is an ICC profile;
    ``orientation`` is EXIF's, 1 to 8.
    """

    pixels: Pixels
    alpha: Pixels | None = None
    profile: bytes | None = None
    orientation: int = 1


def check_size(width: int, height: int, max_pixels: int, name: str) -> None:
    """Refuse a picture by the size in its header, before a pixel is decoded.

    Parameters
    ----------
    width, height : int
        In pixels.
    max_pixels : int
    name : str
        Of the format, for the message.

    Raises
    ------
    BrokenFileError
        If a side is less than 1.
    TooLargeError
        If it has more than ``max_pixels``.
    """
    if width < 1 or height < 1:
        raise BrokenFileError(DAMAGED.format(name))
    if width * height > max_pixels:
        raise TooLargeError(
            f"The picture has {width} × {height} pixels ({width * height / 1e6:,.1f} megapixels); "
            f"at most {max_pixels / 1e6:,.1f} megapixels are accepted. Crop it or make it smaller, and upload it again."
        )


def split_alpha(array: Pixels) -> tuple[Pixels, Pixels | None]:
    """Split (H, W) or (H, W, 1–4) into colour (H, W, 1 or 3) and alpha (H, W), which is None if there is none."""
    if array.ndim == 2:
        return array[..., None], None
    if array.shape[2] in (2, 4):
        return array[..., :-1], array[..., -1]
    return array, None


def is_opaque(alpha: Pixels) -> bool:
    """Whether no pixel is transparent; 99 % counts as opaque, for some photographs have 254 of 255 everywhere."""
    return bool(alpha.min() >= OPAQUE * np.iinfo(alpha.dtype).max)


def read_orientation(read: Callable[[], Image.Exif]) -> int:
    """Read the EXIF orientation with ``read``; 1 (upright) if it is broken, which is no reason to refuse a picture."""
    try:
        return int(read().get(EXIF_ORIENTATION, 1))
    except Exception:  # on broken EXIF Pillow raises errors of many kinds
        return 1


def turn_upright(array: Pixels, orientation: int) -> Pixels:
    """Apply an EXIF orientation, 1 to 8, to (H, W) or (H, W, C); any other number leaves the picture as it is."""
    if orientation in (5, 6, 7, 8):
        array = array.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        array = array[:, ::-1]
    if orientation in (3, 4, 7, 8):
        array = array[::-1]
    return array

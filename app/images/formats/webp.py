"""WebP decoder, lossy and lossless, transparent or not; animations are read by `app.images.formats.animation`."""

import io

import numpy as np
from PIL import Image

from app.errors import BrokenFileError
from app.images.formats.still import DAMAGED, Raw, check_size, read_orientation, split_alpha

NAME = "WebP"


def decode(data: bytes, max_pixels: int) -> Raw:
    """Decode a WebP file.

    Raises
    ------
    BrokenFileError
        If it is truncated or damaged.
    TooLargeError
        If it has more than ``max_pixels``.
    """
    width, height = read_size(data)
    check_size(width, height, max_pixels, NAME)
    if int.from_bytes(data[4:8], "little") + 8 > len(data):
        raise BrokenFileError(DAMAGED.format(NAME))
    with Image.open(io.BytesIO(data), formats=["WEBP"]) as image:
        if image.size != (width, height):
            raise BrokenFileError(DAMAGED.format(NAME))
        profile, upright = image.info.get("icc_profile"), read_orientation(image.getexif)
        pixels, alpha = split_alpha(np.asarray(image.convert("RGBA" if image.has_transparency_data else "RGB")))
    return Raw(pixels, alpha, profile, upright)


def read_size(data: bytes) -> tuple[int, int]:
    """Read width and height from the header: a decoder would allocate the whole canvas on opening the file.

    Raises
    ------
    BrokenFileError
        If there is no such header.
    """
    kind, body = data[12:16], data[20:30]
    if len(body) == 10:
        if kind == b"VP8X":
            return 1 + int.from_bytes(body[4:7], "little"), 1 + int.from_bytes(body[7:10], "little")
        if kind == b"VP8L" and body[0] == 0x2F:
            bits = int.from_bytes(body[1:5], "little")
            return 1 + (bits & 0x3FFF), 1 + (bits >> 14 & 0x3FFF)
        if kind == b"VP8 " and body[3:6] == b"\x9d\x01\x2a":
            return int.from_bytes(body[6:8], "little") & 0x3FFF, int.from_bytes(body[8:10], "little") & 0x3FFF
    raise BrokenFileError(DAMAGED.format(NAME))

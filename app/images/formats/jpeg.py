"""JPEG decoder, 8 bits per channel: grey, colour and CMYK, baseline and progressive; the first of several pictures."""

import io

import numpy as np
from PIL import Image

from app.errors import BrokenFileError, UnsupportedFormatError
from app.images.formats.still import DAMAGED, Raw, check_size, read_orientation
from app.images.png_writer import Pixels

NAME = "JPEG"
START_OF_FRAME = {*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC}
START_OF_SCAN = 0xDA
WITHOUT_LENGTH = {0x01, *range(0xD0, 0xD9)}
EMPTY_CORNER = 8  # pixels: the smallest block that a decoder fills with mid-grey when the data end too early


def decode(data: bytes, max_pixels: int) -> Raw:
    """Decode a JPEG file.

    Raises
    ------
    BrokenFileError
        If it is truncated, damaged, or holds fewer pixels than its header says.
    UnsupportedFormatError
        If it does not have 8 bits per channel, or is lossless.
    TooLargeError
        If it has more than ``max_pixels``.
    """
    precision, height, width = _read_frame_header(data)
    check_size(width, height, max_pixels, NAME)
    if precision != 8:
        raise UnsupportedFormatError(
            f"Save this JPEG file as a 16-bit PNG or TIFF, or as an ordinary JPEG, and upload the new file: "
            f"it has {precision} bits per channel, which few programs can read."
        )
    with Image.open(io.BytesIO(data), formats=["JPEG"]) as image:
        if image.size != (width, height):
            raise BrokenFileError(DAMAGED.format(NAME))
        profile, upright = image.info.get("icc_profile"), read_orientation(image.getexif)
        pixels = np.asarray(image)
    if pixels.ndim == 2:
        pixels = pixels[..., None]
    if _ends_too_early(data, pixels):
        raise BrokenFileError(DAMAGED.format(NAME))
    return Raw(pixels, None, profile, upright)


def _read_frame_header(data: bytes) -> tuple[int, int, int]:
    """Read bits per channel, height and width from the first frame header."""
    at = 2
    while at + 9 <= len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker in START_OF_FRAME:
            height, width = data[at + 5 : at + 7], data[at + 7 : at + 9]
            return data[at + 4], int.from_bytes(height, "big"), int.from_bytes(width, "big")
        if marker == START_OF_SCAN:
            break
        if marker == 0xFF:  # fill bytes: any number of them may precede a marker
            at += 1
        elif marker in WITHOUT_LENGTH:
            at += 2
        else:
            at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    raise BrokenFileError(DAMAGED.format(NAME))


def _ends_too_early(data: bytes, pixels: Pixels) -> bool:
    """Whether the decoder ran out of data and made up the rest.

    Decoders do not report that: they fill the rest with mid-grey. Where the last corner is mid-grey, more data are put
    before the end of the file: a decoder that had enough ignores them, one that had not draws them.
    """
    corner = pixels[-EMPTY_CORNER:, -EMPTY_CORNER:]
    if np.ptp(corner.astype(np.int16)) > 2 or abs(int(corner[0, 0, 0]) - 128) > 1:
        return False
    end = data.rfind(b"\xff\xd9")
    longer = b"".join((data[:end], bytes(range(1, 255)) * 64, data[end:])) if end > 0 else data
    try:
        with Image.open(io.BytesIO(longer), formats=["JPEG"]) as image:
            again = np.asarray(image).reshape(pixels.shape)
    except OSError:
        return True
    return not np.array_equal(again, pixels)

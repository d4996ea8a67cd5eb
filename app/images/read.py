"""Crop reader: cuts a rectangle out of a stored PNG file, and decodes only the strips that hold it."""

from pathlib import Path
from typing import BinaryIO

import imagecodecs
import numpy as np

from app.errors import InvalidInputError
from app.images.crop import Rectangle
from app.images.formats.still import is_opaque, split_alpha
from app.images.png_writer import (
    COLOUR_TYPES,
    FIRST_DATA,
    HEADER,
    SIGNATURE,
    STRIP_ENTRY,
    STRIP_TABLE,
    Pixels,
    combine_adler32,
    make_chunk,
    make_last_data,
)
from app.synthesis.arrays import Real

OVERHEAD = 12  # bytes of a chunk around its content: length, name, checksum
BEFORE_TABLE = len(SIGNATURE) + OVERHEAD + HEADER.size + OVERHEAD + 1  # IHDR and sRGB
CHANNELS = {colour: channels for channels, colour in COLOUR_TYPES.items()}


def read_crop(path: Path, rectangle: Rectangle) -> Real:
    """Cut a rectangle out of a stored picture.

    Parameters
    ----------
    path : Path
        A PNG file; one that `app.images.png_writer` wrote is read in time proportional to the crop's rows.
    rectangle : Rectangle

    Returns
    -------
    ndarray, shape (H, W, C)
        float32, 0 to 255 or 0 to 65535 by the file's depth; C is 1 or 3.

    Raises
    ------
    InvalidInputError
        If the rectangle reaches outside the picture or holds pixels that are not opaque.
    """
    return read_opaque(path, rectangle).astype(np.float32)


def read_opaque(path: Path, rectangle: Rectangle) -> Pixels:
    """Cut the colours of a rectangle out as they are stored, (H, W, C) uint8 or uint16; raise as `read_crop` does."""
    colour, alpha = read_rectangle(path, rectangle)
    if alpha is not None and not is_opaque(alpha):
        raise InvalidInputError(
            f"The crop {rectangle} holds transparent pixels, which have no colour to learn from: "
            "move it to where the picture is opaque, or fill the background in an image editor.",
            "crop",
        )
    return colour


def has_transparency(path: Path, rectangle: Rectangle) -> bool:
    """Whether a rectangle of a stored picture holds a pixel that is not opaque."""
    alpha = read_rectangle(path, rectangle)[1]
    return alpha is not None and not is_opaque(alpha)


def read_rectangle(path: Path, rectangle: Rectangle) -> tuple[Pixels, Pixels | None]:
    """Cut a rectangle out of a stored picture: its colours (H, W, C) and its alpha (H, W), or None if it has none.

    Raises
    ------
    InvalidInputError
        If the rectangle reaches outside the picture.
    """
    with path.open("rb") as file:
        start = file.read(BEFORE_TABLE)
        width, height, depth, colour, *_ = HEADER.unpack_from(start, len(SIGNATURE) + 8)
        area = rectangle.check_within(width, height)
        length, name = int.from_bytes(file.read(4), "big"), file.read(4)
        if name == STRIP_TABLE:
            table = list(STRIP_ENTRY.iter_unpack(file.read(length)))
            file.read(4 + sum(map(len, FIRST_DATA)))
            png, first = _read_strips(file, table, area, (width, depth, colour))
        else:
            png, first = path.read_bytes(), 0
    array = imagecodecs.png_decode(png)
    top = area.y - first
    return split_alpha(array[top : top + area.height, area.x : area.x + area.width])


def _read_strips(
    file: BinaryIO, table: list[tuple[int, int, int]], area: Rectangle, kind: tuple[int, int, int]
) -> tuple[bytes, int]:
    """Build a PNG file of the strips that hold an area, the file standing at the first; also return its first row."""
    width, depth, colour = kind
    row_bytes = 1 + width * CHANNELS[colour] * depth // 8
    first = below = skipped = taken = 0
    adler = 1
    for rows, size, checksum in table:
        if below + rows <= area.y:
            skipped += OVERHEAD + size
            first = below + rows
        elif below < area.y + area.height:
            taken += OVERHEAD + size
            adler = combine_adler32(adler, checksum, rows * row_bytes)
        else:
            break
        below += rows
    file.seek(skipped, 1)
    header = HEADER.pack(width, below - first, depth, colour, 0, 0, 0)
    pieces = [
        SIGNATURE,
        *make_chunk(b"IHDR", header),
        *FIRST_DATA,
        file.read(taken),
        *make_last_data(adler),
        *make_chunk(b"IEND"),
    ]
    return b"".join(pieces), first

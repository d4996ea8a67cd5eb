"""PNG decoder for every kind: 1 to 16 bits, grey, palette and colour, transparent or not, interlaced or not.

Animated ones are read by `app.images.formats.animation`. The gAMA and cHRM chunks are not used.
"""

from collections.abc import Iterator
from functools import partial

import imagecodecs
from isal import isal_zlib
from PIL import Image

from app.errors import BrokenFileError
from app.images.formats.still import DAMAGED, Raw, check_size, read_orientation, split_alpha
from app.images.png_writer import HEADER, SIGNATURE, make_chunk

NAME = "PNG"
SAMPLES_PER_PIXEL = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
DEPTHS = {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}
# First column, first row, column step and row step of the seven passes of an interlaced picture.
PASSES = ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2))
PROFILE_BYTES = 16 << 20
PIECE = 1 << 20


def decode(data: bytes, max_pixels: int) -> Raw:
    """Decode a PNG file.

    Raises
    ------
    BrokenFileError
        If it is truncated, damaged, or holds more or fewer pixels than its header says.
    TooLargeError
        If it has more than ``max_pixels``.
    """
    remaining = read_chunks(data)
    name, header = next(remaining, (b"", b""))
    if name != b"IHDR" or len(header) != 13:
        raise BrokenFileError(DAMAGED.format(NAME))
    width, height, depth, colour, _, _, interlaced = HEADER.unpack(header)
    if depth not in DEPTHS.get(colour, ()) or interlaced > 1:
        raise BrokenFileError(DAMAGED.format(NAME))
    check_size(width, height, max_pixels, NAME)
    # Only what the pixels need is handed on: the rest is metadata, and not worth the risk of parsing it.
    kept = [SIGNATURE, *make_chunk(b"IHDR", header)]
    compressed: list[bytes] = []
    profile, upright, ended = None, 1, False
    for name, content in remaining:
        if name in (b"PLTE", b"tRNS", b"IDAT"):
            kept += make_chunk(name, content)
        if name == b"IDAT":
            compressed.append(content)
        elif name == b"iCCP":
            profile = _read_profile(content)
        elif name == b"eXIf":
            upright = read_orientation(partial(_read_exif, content))
        elif name == b"IEND":
            ended = True
            break
    size = _compute_inflated_size(width, height, depth * SAMPLES_PER_PIXEL[colour], interlaced)
    if not ended or not _inflates_to(compressed, size):
        raise BrokenFileError(DAMAGED.format(NAME))
    try:
        array = imagecodecs.png_decode(b"".join([*kept, *make_chunk(b"IEND")]))
    except imagecodecs.PngError:
        raise BrokenFileError(DAMAGED.format(NAME)) from None
    pixels, alpha = split_alpha(array)
    return Raw(pixels, alpha, profile, upright)


def read_chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield name and content of every complete chunk; raise `BrokenFileError` at one whose checksum is wrong."""
    at = len(SIGNATURE)
    while at + 12 <= len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        name, content = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        checksum = isal_zlib.crc32(content, isal_zlib.crc32(name)).to_bytes(4, "big")
        if data[at + 8 + length : at + 12 + length] != checksum:
            raise BrokenFileError(DAMAGED.format(NAME))
        yield name, content
        at += 12 + length


def _compute_inflated_size(width: int, height: int, bits: int, interlaced: int) -> int:
    """Count the bytes of all rows with their filter bytes."""
    size = 0
    for x, y, step_x, step_y in PASSES if interlaced else ((0, 0, 1, 1),):
        columns, rows = -((x - width) // step_x), -((y - height) // step_y)
        if columns > 0 and rows > 0:
            size += rows * (1 + (columns * bits + 7) // 8)
    return size


def _inflates_to(pieces: list[bytes], size: int) -> bool:
    """Whether a zlib stream is complete and inflates to exactly this many bytes, which are not kept."""
    inflater, total = isal_zlib.decompressobj(), 0
    try:
        for piece in pieces:
            waiting, inflated = piece, PIECE
            # A full piece may have left more behind in the inflater, even if it took all its input.
            while (waiting or inflated == PIECE) and total <= size:
                inflated = len(inflater.decompress(waiting, PIECE))
                waiting = inflater.unconsumed_tail
                total += inflated
    except isal_zlib.IsalError:  # type: ignore[misc]  # its stub declares an instance
        return False
    return bool(inflater.eof) and total == size


def _read_profile(content: bytes) -> bytes | None:
    try:
        return bytes(isal_zlib.decompressobj().decompress(content.partition(b"\0")[2][1:], PROFILE_BYTES))
    except isal_zlib.IsalError:  # type: ignore[misc]  # its stub declares an instance
        return None


def _read_exif(content: bytes) -> Image.Exif:
    exif = Image.Exif()
    exif.load(content)
    return exif

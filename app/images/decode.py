"""An uploaded file's pixels: upright, in sRGB, at full depth, without metadata."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.errors import BrokenFileError, TooLargeError, UnsupportedFormatError
from app.images.colour import to_srgb
from app.images.formats import jpeg, png, tiff, webp
from app.images.formats.raw import Raw, is_opaque
from app.images.png import SIGNATURE, Pixels, PngWriter

MEBIBYTE = 1 << 20
STRIP_ROWS, STRIP_PIXELS = 64, 1 << 16  # small strips: a crop is read by strips
FORMATS = "PNG, JPEG, WebP and TIFF"
OTHERS = {
    b"GIF8": "a GIF picture",
    b"BM": "a BMP picture",
    b"%PDF": "a PDF document",
    b"PK\3\4": "an archive or an office document",
    b"8BPS": "a Photoshop document",
    b"\0\0\1\0": "an icon",
}


@dataclass(frozen=True)
class Limits:
    """What one upload may cost: bytes of the file, pixels of a picture, seconds and bytes of memory to decode it.

    Of a video also frames, seconds that it plays, and pixels of all frames together.
    """

    bytes: int = 32 * MEBIBYTE
    pixels: int = 50_000_000
    seconds: float = 20.0
    memory: int = 2048 * MEBIBYTE
    film_frames: int = 600
    film_seconds: float = 60.0
    film_pixels: int = 1 << 28


@dataclass(frozen=True)
class Decoded:
    """A picture, upright and in sRGB.

    ``pixels`` is (H, W, C) uint8 or uint16, C 1 (grey) or 3 (RGB); ``alpha`` is (H, W) of the same type, or None if
    every pixel is opaque (`app.images.formats.raw.is_opaque`).
    """

    pixels: Pixels
    alpha: Pixels | None

    @property
    def depth(self) -> int:
        """Bits per channel, 8 or 16."""
        return self.pixels.itemsize * 8


def decode(path: Path, limits: Limits) -> Decoded:
    """Read an uploaded file. Its format is told by content, never by name.

    Nothing here bounds time or memory: `app.images.intake` runs it in a process that does.

    Raises
    ------
    UnsupportedFormatError
        If it is none of the formats that are read.
    BrokenFileError
        If it is empty, truncated, damaged or lies about its size.
    TooLargeError
        If it has more bytes or pixels than the limits allow.
    """
    size = path.stat().st_size
    if size > limits.bytes:
        raise TooLargeError(
            f"The file has {size / MEBIBYTE:,.1f} MB; at most {limits.bytes / MEBIBYTE:,.1f} MB are accepted. "
            "Make the picture smaller, or save it as JPEG, and upload it again."
        )
    data = path.read_bytes()
    reader = _reader(data)
    try:
        raw = reader(data, limits.pixels)
    except (UnsupportedFormatError, BrokenFileError, TooLargeError, MemoryError):
        raise
    except Exception as error:
        # The libraries raise dozens of kinds on broken input, IndexError and struct.error among them.
        raise BrokenFileError(
            "This file cannot be decoded; it is damaged or incomplete. "
            "Open it in an image editor, save it again and upload the new file."
        ) from error
    pixels = _upright(to_srgb(raw.pixels, raw.profile), raw.orientation)
    opaque = raw.alpha is None or is_opaque(raw.alpha)
    return Decoded(pixels, None if raw.alpha is None or opaque else _upright(raw.alpha, raw.orientation))


def to_png(picture: Decoded) -> bytes:
    """Write a picture as PNG: grey or RGB, with an alpha channel if a pixel is not opaque, and no metadata."""
    height, width, channels = picture.pixels.shape
    writer = PngWriter(width, height, channels + (picture.alpha is not None), picture.depth)
    rows = max(STRIP_ROWS, STRIP_PIXELS // width)
    for y in range(0, height, rows):
        strip = picture.pixels[y : y + rows]
        if picture.alpha is not None:
            strip = np.concatenate([strip, picture.alpha[y : y + rows, :, None]], axis=2)
        writer.write(y, strip)
    return writer.finish()


def _reader(data: bytes) -> Callable[[bytes, int], Raw]:
    if not data:
        raise BrokenFileError("The file is empty: choose it again and upload it once more.")
    if data.startswith(SIGNATURE):
        return png.decode
    if data.startswith(b"\xff\xd8\xff"):
        return jpeg.decode
    if data.startswith(b"RIFF") and data[8:12] == b"WEBP":
        return webp.decode
    if data[:4] in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"):
        return tiff.decode
    kind = next((kind for start, kind in OTHERS.items() if data.startswith(start)), None)
    if data[4:8] == b"ftyp":
        kind = "a HEIC or AVIF picture" if data[8:12] in (b"heic", b"heix", b"mif1", b"msf1", b"avif") else "a video"
    found = f"This file is {kind}, which is" if kind else "This file is"
    raise UnsupportedFormatError(f"{found} not of a format that can be read: {FORMATS} work. Save it as one of these.")


def _upright(array: Pixels, orientation: int) -> Pixels:
    """Apply EXIF's orientation, a number from 1 to 8; any other leaves the picture as it is."""
    if orientation in (5, 6, 7, 8):
        array = array.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        array = array[:, ::-1]
    if orientation in (3, 4, 7, 8):
        array = array[::-1]
    return array

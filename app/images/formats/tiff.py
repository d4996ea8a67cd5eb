"""TIFF decoder, integers of up to 16 bits: grey, palette, RGB and CMYK, in strips or tiles; the first page."""

import io
import math
from typing import Any

import numpy as np
import tifffile
from numpy.typing import NDArray
from tifffile import COMPRESSION, EXTRASAMPLE, PHOTOMETRIC, SAMPLEFORMAT, TiffPage

from app.errors import BrokenFileError, UnsupportedFormatError
from app.images.formats.still import DAMAGED, Raw, check_size
from app.images.png_writer import Pixels

NAME = "TIFF"
CHANNELS: dict[int, int] = {
    PHOTOMETRIC.MINISWHITE: 1,
    PHOTOMETRIC.MINISBLACK: 1,
    PHOTOMETRIC.RGB: 3,
    PHOTOMETRIC.PALETTE: 1,
    PHOTOMETRIC.SEPARATED: 4,
    PHOTOMETRIC.YCBCR: 3,  # inside JPEG only, which decodes to RGB
}
COMPRESSIONS = {
    COMPRESSION.NONE,
    COMPRESSION.CCITTRLE,
    COMPRESSION.CCITT_T4,
    COMPRESSION.CCITT_T6,
    COMPRESSION.LZW,
    COMPRESSION.JPEG,
    COMPRESSION.ADOBE_DEFLATE,
    COMPRESSION.DEFLATE,
    COMPRESSION.PACKBITS,
    COMPRESSION.ZSTD,
}
ADVICE = "save it as an ordinary 8- or 16-bit grey or RGB picture, PNG or TIFF, and upload that."


def decode(data: bytes, max_pixels: int) -> Raw:
    """Decode the first page of a TIFF file.

    Raises
    ------
    BrokenFileError
        If it is truncated, damaged, or holds fewer pixels than its header says.
    UnsupportedFormatError
        If its numbers, its colours or its compression are not supported.
    TooLargeError
        If it has more than ``max_pixels``.
    """
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        page = file.pages.first
        check_size(page.imagewidth, page.imagelength, max_pixels, NAME)
        _check_kind(page)
        _check_segments(page, len(data))
        array = page.asarray()
        samples = _move_samples_last(page, array)
        profile, orientation = page.tags.valueof("InterColorProfile"), page.tags.valueof("Orientation", 1)
        colour, alpha = _extract_colour(page, samples), _extract_alpha(page, samples)
        if alpha is not None and page.extrasamples[0] == EXTRASAMPLE.ASSOCALPHA:
            colour = _unpremultiply(colour, alpha)
    return Raw(colour, alpha, profile if isinstance(profile, bytes) else None, orientation)


def _check_kind(page: TiffPage) -> None:
    if page.sampleformat == SAMPLEFORMAT.IEEEFP:
        raise UnsupportedFormatError(
            f"This TIFF file holds floating-point numbers, of which black and white are not known: {ADVICE}"
        )
    if page.sampleformat != SAMPLEFORMAT.UINT or not 1 <= page.bitspersample <= 16:
        raise UnsupportedFormatError(
            f"This TIFF file has {page.bitspersample} bits per channel of a kind that is not supported: {ADVICE}"
        )
    converted = page.photometric != PHOTOMETRIC.YCBCR or page.compression == COMPRESSION.JPEG
    if page.photometric not in CHANNELS or not converted or page.samplesperpixel < CHANNELS[page.photometric]:
        raise UnsupportedFormatError(f"This TIFF file has colours of a kind that is not supported: {ADVICE}")
    if page.compression not in COMPRESSIONS:
        raise UnsupportedFormatError(f"This TIFF file is compressed in a way that is not supported: {ADVICE}")
    if page.imagedepth != 1:
        raise UnsupportedFormatError(f"This TIFF file is a volume, not a picture: {ADVICE}")


def _check_segments(page: TiffPage, size: int) -> None:
    """Refuse strips or tiles that are missing, empty or outside the file: the library would leave them black."""
    starts, lengths = page.dataoffsets, page.databytecounts
    if not len(starts) == len(lengths) == math.prod(page.chunked):
        raise BrokenFileError(DAMAGED.format(NAME))
    if any(length < 1 or start + length > size for start, length in zip(starts, lengths, strict=True)):
        raise BrokenFileError(DAMAGED.format(NAME))
    row = (page.imagewidth * page.bitspersample * page.samplesperpixel) // 8
    if page.compression == COMPRESSION.NONE and sum(lengths) < page.imagelength * row:
        raise BrokenFileError(DAMAGED.format(NAME))


def _move_samples_last(page: TiffPage, array: NDArray[Any]) -> Pixels:
    """Arrange the samples as (H, W, samples) of 8 or 16 bits, each over its whole range."""
    height, width, samples = page.imagelength, page.imagewidth, page.samplesperpixel
    if page.planarconfig == 2 and samples > 1:
        array = np.moveaxis(array.reshape(samples, height, width), 0, -1)
    array = array.reshape(height, width, samples)
    bits = page.bitspersample
    if page.photometric == PHOTOMETRIC.PALETTE or bits in (8, 16):
        return array.astype(np.uint8) if array.dtype == np.bool_ else array
    dtype = np.uint8 if bits < 8 else np.uint16
    scaled: Pixels = (array.astype(np.uint32) * np.iinfo(dtype).max // (2**bits - 1)).astype(dtype)
    return scaled


def _extract_colour(page: TiffPage, samples: Pixels) -> Pixels:
    if page.photometric == PHOTOMETRIC.PALETTE:
        entries = np.asarray(page.colormap)
        # The entries have 16 bits; some programs wrote 8 into them.
        table = (entries if entries.max() < 256 else entries >> 8).astype(np.uint8)
        return np.ascontiguousarray(np.moveaxis(table[:, samples[..., 0]], 0, -1))
    colour = samples[..., : CHANNELS[page.photometric]]
    return ~colour if page.photometric == PHOTOMETRIC.MINISWHITE else colour


def _extract_alpha(page: TiffPage, samples: Pixels) -> Pixels | None:
    """Take the first extra channel if the file declares it as opacity."""
    if page.extrasamples and page.extrasamples[0] in (EXTRASAMPLE.ASSOCALPHA, EXTRASAMPLE.UNASSALPHA):
        alpha: Pixels = samples[..., CHANNELS[page.photometric]]
        return alpha if page.photometric != PHOTOMETRIC.PALETTE else None
    return None


def _unpremultiply(colour: Pixels, alpha: Pixels) -> Pixels:
    peak = np.iinfo(colour.dtype).max
    if alpha.min() == peak:
        return colour
    divided = colour.astype(np.uint32) * peak // np.maximum(alpha, 1)[..., None]
    return np.minimum(divided, peak).astype(colour.dtype)

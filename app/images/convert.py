"""Image conversion to other formats and sizes, tagged as sRGB: downloads, renditions, thumbnails, link previews."""

import io
from functools import cache
from pathlib import Path
from typing import Literal

import imagecodecs
import numpy as np
import tifffile
from PIL import Image

from app.errors import InvalidInputError
from app.images.formats.still import split_alpha
from app.images.png_writer import Pixels, encode_png

Format = Literal["png", "jpeg", "webp", "tiff"]
DEPTH_AT = 24  # offset of the bits per channel in a PNG file
JPEG_QUALITY = 92
JPEG_LONGEST, WEBP_LONGEST = 65_500, 16_383
WEBP_QUALITY = 90
SMALL_QUALITY = 85
THUMBNAIL = 320
PREVIEW = (1200, 630)
MARGIN = 30
LARGEST_ZOOM = 4.0
GROUND = 0x80  # mid-grey, the most neutral background to judge a texture on


def convert(png: bytes | Path, file_format: Format, depth: Literal[8, 16] | None = None) -> tuple[bytes, str]:
    """Convert a PNG file to another format.

    PNG and TIFF (deflated) are lossless. JPEG has quality 92 without chroma subsampling. WebP is lossy with quality 90:
    lossless WebP takes seconds for a large texture and saves little on noise. JPEG and WebP have 8 bits per channel;
    JPEG shows transparent pixels over mid-grey, WebP keeps them transparent.

    Parameters
    ----------
    png : bytes or Path
        The file's content, or where it is: grey or RGB of 8 or 16 bits, with or without an alpha channel.
    file_format : {"png", "jpeg", "webp", "tiff"}
    depth : {8, 16}, optional
        Bits per channel of a PNG or TIFF; those of ``png`` by default.

    Returns
    -------
    bytes
        The file.
    str
        Its media type.

    Raises
    ------
    InvalidInputError
        If a side is longer than the format allows: 65,500 pixels in JPEG, 16,383 in WebP.
    """
    data = png if isinstance(png, bytes) else png.read_bytes()
    media_type = f"image/{file_format}"
    if file_format == "png" and depth in (None, data[DEPTH_AT]):
        return data, media_type
    array = imagecodecs.png_decode(data)
    if file_format == "png":
        return encode_png(_set_depth(array, depth)), media_type
    if file_format == "tiff":
        return _encode_tiff(_set_depth(array, depth)), media_type
    _check_side(array, file_format)
    quality = JPEG_QUALITY if file_format == "jpeg" else WEBP_QUALITY
    return _encode_lossy(_to_image(array), file_format, quality), media_type


def read_depth(path: Path) -> int:
    """Read the bits per channel of a PNG file, 8 or 16, from its header."""
    with path.open("rb") as file:
        return file.read(DEPTH_AT + 1)[DEPTH_AT]


def make_rendition(png_path: Path, longest_side: int | None) -> tuple[bytes, str]:
    """Make a picture for a browser: 8 bits per channel, reduced to fit, never enlarged.

    Parameters
    ----------
    png_path : Path
    longest_side : int or None
        Pixels that neither side exceeds; None keeps the size.

    Returns
    -------
    bytes
        JPEG if the picture is opaque, PNG if not.
    str
        Its media type.
    """
    image = _to_image(imagecodecs.png_decode(png_path.read_bytes()))
    if longest_side is not None:
        image.thumbnail((longest_side, longest_side), Image.Resampling.LANCZOS, reducing_gap=2.0)
    if image.mode in ("LA", "RGBA") or max(image.size) > JPEG_LONGEST:
        return encode_png(np.asarray(image)), "image/png"
    return _encode_lossy(image, "jpeg", SMALL_QUALITY), "image/jpeg"


def flatten(picture: Pixels) -> Pixels:
    """Lay a picture with an alpha channel, (H, W, 2 or 4) uint8, on mid-grey; return (H, W, 1 or 3) uint8."""
    colour, alpha = split_alpha(picture)
    if alpha is None:
        return colour
    flat = _lay_on_grey(_to_image(picture)).convert("L" if colour.shape[2] == 1 else "RGB")
    return np.asarray(flat).reshape(colour.shape)


def make_thumbnails(crop: bytes | Path | Pixels, texture: bytes | Path | Pixels) -> tuple[bytes, bytes]:
    """Make WebP thumbnails of a crop and its texture, both reduced by the same factor.

    Parameters
    ----------
    crop, texture : bytes, Path or ndarray of shape (H, W) or (H, W, C)
        PNG files or their pixels, uint8 or uint16.

    Returns
    -------
    tuple of bytes
        The crop's and the texture's file, no side longer than 320 pixels; never enlarged.
    """
    images = [_to_image(_decode(each)) for each in (crop, texture)]
    scale = min(1.0, THUMBNAIL / max(side for image in images for side in image.size))
    small = [_encode_lossy(_resize(image, scale), "webp", SMALL_QUALITY) for image in images]
    return small[0], small[1]


def make_link_preview(crop: bytes | Path | Pixels, texture: bytes | Path | Pixels) -> bytes:
    """Make a link preview: JPEG, 1200 × 630 pixels, crop and texture side by side at one scale on mid-grey.

    Small pictures are enlarged, up to four times.

    Parameters
    ----------
    crop, texture : bytes, Path or ndarray of shape (H, W) or (H, W, C)
        PNG files or their pixels, uint8 or uint16.
    """
    images = [_to_image(_decode(each)) for each in (crop, texture)]
    room = PREVIEW[0] - 3 * MARGIN, PREVIEW[1] - 2 * MARGIN
    scale = min(
        LARGEST_ZOOM,
        room[0] / sum(image.width for image in images),
        room[1] / max(image.height for image in images),
    )
    small = [_resize(image, scale).convert("RGB") for image in images]
    sheet = Image.new("RGB", PREVIEW, (GROUND, GROUND, GROUND))
    x = (PREVIEW[0] - MARGIN - sum(image.width for image in small)) // 2
    for image in small:
        sheet.paste(image, (x, (PREVIEW[1] - image.height) // 2))
        x += image.width + MARGIN
    return _encode_lossy(sheet, "jpeg", SMALL_QUALITY)


def _decode(picture: bytes | Path | Pixels) -> Pixels:
    if isinstance(picture, Path):
        picture = picture.read_bytes()
    if isinstance(picture, bytes):
        decoded: Pixels = imagecodecs.png_decode(picture)
        return decoded
    return picture


def _set_depth(array: Pixels, depth: int | None) -> Pixels:
    if depth == 8 and array.dtype == np.uint16:
        # v / 257, rounded, without a wider type: 0.2 % of the values, almost halfway, go the other way.
        narrowed = array - (array >> 8)
        narrowed += 128
        narrowed >>= 8
        return narrowed.astype(np.uint8)
    return array.astype(np.uint16) * np.uint16(257) if depth == 16 and array.dtype == np.uint8 else array


def _to_image(array: Pixels) -> Image.Image:
    """Make a Pillow image of 8 bits."""
    array = _set_depth(array, 8)
    return Image.fromarray(np.ascontiguousarray(array[..., 0] if array.ndim == 3 and array.shape[2] == 1 else array))


def _resize(image: Image.Image, scale: float) -> Image.Image:
    width, height = (max(1, round(side * scale)) for side in image.size)
    return image.resize((width, height), Image.Resampling.LANCZOS, reducing_gap=2.0)


def _lay_on_grey(image: Image.Image) -> Image.Image:
    ground = Image.new("RGBA", image.size, (GROUND, GROUND, GROUND, 255))
    return Image.alpha_composite(ground, image.convert("RGBA")).convert("RGB")


def _check_side(array: Pixels, file_format: Format) -> None:
    longest = JPEG_LONGEST if file_format == "jpeg" else WEBP_LONGEST
    if max(array.shape[:2]) > longest:
        raise InvalidInputError(
            f"Choose PNG or TIFF: no side of a {'JPEG' if file_format == 'jpeg' else 'WebP'} file can be longer than "
            f"{longest:,} pixels.",
            "format",
        )


def _encode_lossy(image: Image.Image, file_format: Format, quality: int) -> bytes:
    written = io.BytesIO()
    if file_format == "jpeg":
        if image.mode in ("LA", "RGBA"):
            image = _lay_on_grey(image)
        profile = _make_srgb_profile() if image.mode == "RGB" else None
        image.save(written, "jpeg", quality=quality, subsampling=0, icc_profile=profile)
    else:
        image.save(written, "webp", quality=quality, method=2, icc_profile=_make_srgb_profile())
    return written.getvalue()


def _encode_tiff(array: Pixels) -> bytes:
    colour, alpha = split_alpha(array)
    written = io.BytesIO()
    grey = colour.shape[2] == 1
    tifffile.imwrite(
        written,
        array,
        photometric="minisblack" if grey else "rgb",
        planarconfig=None if array.ndim == 2 else "contig",
        extrasamples=None if alpha is None else ["unassalpha"],
        compression="zlib",
        compressionargs={"level": 1},
        predictor=True,
        iccprofile=None if grey else _make_srgb_profile(),
        metadata=None,
        software=False,
    )
    return written.getvalue()


@cache
def _make_srgb_profile() -> bytes:
    """Make the profile of sRGB with a fixed date, so that the same picture gives the same file."""
    profile: bytes = imagecodecs.cms_profile("srgb")
    date = b"".join(part.to_bytes(2, "big") for part in (2000, 1, 1, 0, 0, 0))
    return profile[:24] + date + profile[36:]

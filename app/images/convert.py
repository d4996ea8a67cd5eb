"""Pictures in other formats and sizes, tagged as sRGB: downloads, renditions, thumbnails, link previews."""

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
DEPTH_AT = 24  # where a PNG file says its bits per channel
JPEG_QUALITY = 92
JPEG_LONGEST, WEBP_LONGEST = 65_500, 16_383
WEBP_QUALITY = 90
SMALL_QUALITY = 85
THUMBNAIL = 320
PREVIEW = (1200, 630)
MARGIN = 30
LARGEST_ZOOM = 4.0
GROUND = 0x80  # neutral mid-grey: no ground is more neutral to judge a texture on


def convert(png: bytes | Path, file_format: Format, depth: Literal[8, 16] | None = None) -> tuple[bytes, str]:
    """Write a PNG file's picture in another format.

    PNG and TIFF (deflated) are lossless. JPEG is of quality 92 without chroma subsampling; WebP is lossy, of quality
    90: lossless WebP takes seconds for a large texture and saves little on noise. Both have 8 bits per channel, and
    show transparent pixels over mid-grey (JPEG) or keep them (WebP).

    Parameters
    ----------
    png : bytes or Path
    file_format : {"png", "jpeg", "webp", "tiff"}
    depth : {8, 16}, optional
        Bits per channel of a PNG or TIFF; default: as they are.

    Returns
    -------
    bytes
        The file.
    str
        Its media type.

    Raises
    ------
    InvalidInputError
        If the format cannot hold so large a picture.
    """
    data = png if isinstance(png, bytes) else png.read_bytes()
    media_type = f"image/{file_format}"
    if file_format == "png" and depth in (None, data[DEPTH_AT]):
        return data, media_type
    array = imagecodecs.png_decode(data)
    if file_format == "png":
        return encode_png(_with_depth(array, depth)), media_type
    if file_format == "tiff":
        return _tiff(_with_depth(array, depth)), media_type
    _check_side(array, file_format)
    return _lossy(_image(array), file_format, JPEG_QUALITY if file_format == "jpeg" else WEBP_QUALITY), media_type


def read_depth(path: Path) -> int:
    """Bits per channel of a PNG file."""
    with path.open("rb") as file:
        return file.read(DEPTH_AT + 1)[DEPTH_AT]


def make_rendition(png_path: Path, longest_side: int | None) -> tuple[bytes, str]:
    """Make a picture for a browser: 8 bits per channel, no side longer than ``longest_side`` pixels; never enlarged.

    Returns
    -------
    bytes
        JPEG if the picture is opaque, PNG if not.
    str
        Its media type.
    """
    image = _image(imagecodecs.png_decode(png_path.read_bytes()))
    if longest_side is not None:
        image.thumbnail((longest_side, longest_side), Image.Resampling.LANCZOS, reducing_gap=2.0)
    if image.mode in ("LA", "RGBA") or max(image.size) > JPEG_LONGEST:
        return encode_png(np.asarray(image)), "image/png"
    return _lossy(image, "jpeg", SMALL_QUALITY), "image/jpeg"


def flatten(picture: Pixels) -> Pixels:
    """Lay a picture of 8 bits, (H, W, C), on mid-grey where it has an alpha channel that is not opaque."""
    colour, alpha = split_alpha(picture)
    if alpha is None:
        return colour
    return np.asarray(_on_grey(_image(picture)).convert("L" if colour.shape[2] == 1 else "RGB")).reshape(colour.shape)


def make_thumbnails(crop: bytes | Path | Pixels, texture: bytes | Path | Pixels) -> tuple[bytes, bytes]:
    """Make WebP thumbnails of a crop and its texture at one scale, no side longer than 320 pixels; never enlarged."""
    images = [_image(_decoded(each)) for each in (crop, texture)]
    scale = min(1.0, THUMBNAIL / max(side for image in images for side in image.size))
    small = [_lossy(_scaled(image, scale), "webp", SMALL_QUALITY) for image in images]
    return small[0], small[1]


def make_link_preview(crop: bytes | Path | Pixels, texture: bytes | Path | Pixels) -> bytes:
    """Make a link preview: JPEG, 1200 × 630, crop and texture side by side at one scale on mid-grey.

    Small ones are enlarged, up to four times.
    """
    images = [_image(_decoded(each)) for each in (crop, texture)]
    room = PREVIEW[0] - 3 * MARGIN, PREVIEW[1] - 2 * MARGIN
    scale = min(
        LARGEST_ZOOM,
        room[0] / sum(image.width for image in images),
        room[1] / max(image.height for image in images),
    )
    small = [_scaled(image, scale).convert("RGB") for image in images]
    sheet = Image.new("RGB", PREVIEW, (GROUND, GROUND, GROUND))
    x = (PREVIEW[0] - MARGIN - sum(image.width for image in small)) // 2
    for image in small:
        sheet.paste(image, (x, (PREVIEW[1] - image.height) // 2))
        x += image.width + MARGIN
    return _lossy(sheet, "jpeg", SMALL_QUALITY)


def _decoded(picture: bytes | Path | Pixels) -> Pixels:
    if isinstance(picture, Path):
        picture = picture.read_bytes()
    if isinstance(picture, bytes):
        decoded: Pixels = imagecodecs.png_decode(picture)
        return decoded
    return picture


def _with_depth(array: Pixels, depth: int | None) -> Pixels:
    if depth == 8 and array.dtype == np.uint16:
        # v / 257, rounded (0.2 % of the values, almost halfway, go the other way), without a wider type.
        narrowed = array - (array >> 8)
        narrowed += 128
        narrowed >>= 8
        return narrowed.astype(np.uint8)
    return array.astype(np.uint16) * np.uint16(257) if depth == 16 and array.dtype == np.uint8 else array


def _image(array: Pixels) -> Image.Image:
    """Make a Pillow image of 8 bits."""
    array = _with_depth(array, 8)
    return Image.fromarray(np.ascontiguousarray(array[..., 0] if array.ndim == 3 and array.shape[2] == 1 else array))


def _scaled(image: Image.Image, scale: float) -> Image.Image:
    width, height = (max(1, round(side * scale)) for side in image.size)
    return image.resize((width, height), Image.Resampling.LANCZOS, reducing_gap=2.0)


def _on_grey(image: Image.Image) -> Image.Image:
    ground = Image.new("RGBA", image.size, (GROUND, GROUND, GROUND, 255))
    return Image.alpha_composite(ground, image.convert("RGBA")).convert("RGB")


def _check_side(array: Pixels, file_format: Format) -> None:
    longest = JPEG_LONGEST if file_format == "jpeg" else WEBP_LONGEST
    if max(array.shape[:2]) > longest:
        raise InvalidInputError(
            f"No side of a {'JPEG' if file_format == 'jpeg' else 'WebP'} file can be longer than {longest:,} pixels: "
            "take PNG or TIFF.",
            "format",
        )


def _lossy(image: Image.Image, file_format: Format, quality: int) -> bytes:
    written = io.BytesIO()
    if file_format == "jpeg":
        if image.mode in ("LA", "RGBA"):
            image = _on_grey(image)
        profile = _srgb() if image.mode == "RGB" else None
        image.save(written, "jpeg", quality=quality, subsampling=0, icc_profile=profile)
    else:
        image.save(written, "webp", quality=quality, method=2, icc_profile=_srgb())
    return written.getvalue()


def _tiff(array: Pixels) -> bytes:
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
        iccprofile=None if grey else _srgb(),
        metadata=None,
        software=False,
    )
    return written.getvalue()


@cache
def _srgb() -> bytes:
    """Profile of sRGB, its date of making set to a fixed one so that the same picture gives the same file."""
    profile: bytes = imagecodecs.cms_profile("srgb")
    date = b"".join(part.to_bytes(2, "big") for part in (2000, 1, 1, 0, 0, 0))
    return profile[:24] + date + profile[36:]

"""Animations: GIF, animated WebP and animated PNG (APNG).

A first pass through the file finds durations and colours, a second one yields the frames. A frame that is shown k times
as long as the shortest is repeated k times (unless that would be too many frames), so that one frame rate keeps the
timing. As in browsers, a duration of ten milliseconds or less counts as a tenth of a second. Colour and transparency
follow the still pictures of the same format; a GIF is grey if every pixel is.
"""

import io
from collections.abc import Iterator
from itertools import islice

import numpy as np
from PIL import Image

from app.errors import BrokenFileError, UnsupportedFormatError
from app.images.colour import to_srgb
from app.images.formats import png, webp
from app.images.formats.clip import ClipLimits, ClipStream, TimedFrame, check_clip
from app.images.formats.still import DAMAGED, check_size, is_opaque, read_orientation, turn_upright
from app.images.png_writer import HEADER, SIGNATURE
from app.synthesis.arrays import Bytes

MEDIA_TYPES = {"GIF": "image/gif", "PNG": "image/apng", "WEBP": "image/webp"}
TOO_SHORT, DEFAULT_DURATION = 10.0, 100.0  # milliseconds
TRAILER = b";"
ANIMATED_WEBP = 0x02
GREY_MODES = ("1", "L", "LA")
CHANNELS = {1: [0], 2: [0, 3], 3: [0, 1, 2], 4: [0, 1, 2, 3]}  # indices into RGBA by the number of channels


def is_animation(data: bytes) -> bool:
    """Whether a file is a GIF, an animated WebP, or an APNG of more than one frame."""
    if data.startswith(b"GIF8"):
        return True
    if data.startswith(b"RIFF"):
        return data[12:16] == b"VP8X" and bool(data[20] & ANIMATED_WEBP)
    if data.startswith(SIGNATURE):
        for name, content in png.read_chunks(data):
            if name == b"IDAT":
                break
            if name == b"acTL":
                return int.from_bytes(content[:4], "big") > 1
    return False


def decode(data: bytes, max_pixels: int, limits: ClipLimits) -> ClipStream:
    """Decode an animation; its frames are composed while they are taken.

    Parameters
    ----------
    data : bytes
        The file, for which `is_animation` is true.
    max_pixels : int
        Of a frame.
    limits : ClipLimits

    Returns
    -------
    ClipStream

    Raises
    ------
    UnsupportedFormatError
        If it has 16 bits per channel.
    BrokenFileError
        If it is truncated or damaged; taking the frames raises it too.
    TooLargeError
        If it has more pixels, frames or seconds than the limits allow.
    """
    file_format, width, height = _read_header(data)
    check_size(width, height, max_pixels, file_format)
    grey, opaque, times = file_format != "WEBP", True, []
    for image in _compose_frames(data, file_format):
        pixels = _read_pixels(image, (width, height))
        grey = grey and (file_format == "GIF" or image.mode in GREY_MODES) and _is_grey(pixels)
        opaque = opaque and is_opaque(pixels[..., 3])
        duration = float(image.info.get("duration", 0))
        times.append(duration if duration > TOO_SHORT else DEFAULT_DURATION)
        check_clip(width, height, len(times), sum(times) / 1000, limits, more=True)
    repeats = [round(time / min(times)) for time in times]
    if sum(repeats) > min(limits.frames, limits.pixels // (width * height)):
        repeats = [1] * len(times)
    channels = (1 if grey else 3) + (not opaque)
    with Image.open(io.BytesIO(data), formats=[file_format]) as image:
        profile, turn = image.info.get("icc_profile"), read_orientation(image.getexif)
    if turn > 4:
        width, height = height, width

    def frames() -> Iterator[TimedFrame]:
        interval, shown = sum(times) / sum(repeats) / 1000, 0
        for image, repeat in zip(_compose_frames(data, file_format), repeats, strict=True):
            pixels = _read_pixels(image, image.size)[..., CHANNELS[channels]]
            colours = channels - (not opaque)
            pixels[..., :colours] = to_srgb(pixels[..., :colours], profile)
            frame = turn_upright(pixels, turn)
            for _ in range(repeat):
                yield TimedFrame(frame, shown * interval)
                shown += 1

    return ClipStream(width, height, channels, MEDIA_TYPES[file_format], frames())


def _read_header(data: bytes) -> tuple[str, int, int]:
    """Read the format's name (as Pillow's), width and height; refuse a file whose damage shows in its structure."""
    if data.startswith(b"GIF8"):
        return "GIF", int.from_bytes(data[6:8], "little"), int.from_bytes(data[8:10], "little")
    if data.startswith(b"RIFF"):
        if int.from_bytes(data[4:8], "little") + 8 > len(data):
            raise BrokenFileError(DAMAGED.format("WebP"))
        return "WEBP", *webp.read_size(data)
    chunks = png.read_chunks(data)
    header = next(chunks)[1]
    if not any(name == b"IEND" for name, _ in chunks):
        raise BrokenFileError(DAMAGED.format("PNG"))
    width, height, depth, *_ = HEADER.unpack(header)
    if depth > 8:
        raise UnsupportedFormatError(
            "Save this animated PNG with 8 bits per channel, and upload the new file: with 16 bits it cannot be read."
        )
    return "PNG", width, height


def _compose_frames(data: bytes, file_format: str) -> Iterator[Image.Image]:
    """Yield the composed frames, always the same image object."""
    file = io.BytesIO(data)
    with Image.open(file, formats=[file_format]) as image:
        yield from islice(_seek_frames(image, file), 1 if getattr(image, "default_image", False) else 0, None)


def _seek_frames(image: Image.Image, file: io.BytesIO) -> Iterator[Image.Image]:
    shown = 0
    while True:
        try:
            image.seek(shown)
        except EOFError:
            break
        yield image
        shown += 1
    # A GIF does not say how many frames it has: it ends with a trailer. The other formats do.
    if image.format == "GIF":
        whole = file.getvalue()[file.tell() - 1 : file.tell()] == TRAILER
    else:
        whole = shown == getattr(image, "n_frames", 0)
    if not whole:
        raise BrokenFileError(DAMAGED.format(image.format))


def _read_pixels(image: Image.Image, size: tuple[int, int]) -> Bytes:
    pixels = np.asarray(image.convert("RGBA"))
    if image.size != size:
        raise BrokenFileError(DAMAGED.format(image.format))
    return pixels


def _is_grey(pixels: Bytes) -> bool:
    return np.array_equal(pixels[..., 0], pixels[..., 1]) and np.array_equal(pixels[..., 0], pixels[..., 2])

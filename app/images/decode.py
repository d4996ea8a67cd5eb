"""Decoding of uploads, pictures and videos, to pixels: upright, in sRGB, at full depth, without metadata."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from app.errors import BrokenFileError, TooLargeError, UnsupportedFormatError
from app.images.colour import to_srgb
from app.images.formats import animation, jpeg, png, tiff, video, webp
from app.images.formats.clip import ClipLimits, ClipStream, TimedFrame
from app.images.formats.containers import identify_container
from app.images.formats.still import Raw, is_opaque, split_alpha, turn_upright
from app.images.media import Media
from app.images.png_writer import SIGNATURE, Pixels

if TYPE_CHECKING:
    from app.settings import Settings

MEBIBYTE = 1 << 20
FORMATS = "PNG, JPEG, WebP, TIFF and GIF pictures, and MP4 (H.264), WebM, GIF, WebP and PNG videos"
OTHERS = {
    b"FLV": "a Flash video",
    b"OggS": "an Ogg video",
    b"\0\0\1\xba": "an MPEG video",
    b"BM": "a BMP picture",
    b"%PDF": "a PDF document",
    b"PK\3\4": "an archive or an office document",
    b"8BPS": "a Photoshop document",
    b"\0\0\1\0": "an icon",
}


@dataclass(frozen=True)
class Limits:
    """Limits of one upload.

    Attributes
    ----------
    bytes : int
        Of the file.
    pixels : int
        Of a picture, or of a video's frame.
    seconds : float
        To decode it.
    memory : int
        Bytes to decode it.
    video_frames : int
        Number of frames.
    video_seconds : float
        For which a video plays.
    video_pixels : int
        Of all frames of a video together.
    """

    bytes: int = 32 * MEBIBYTE
    pixels: int = 50_000_000
    seconds: float = 20.0
    memory: int = 2048 * MEBIBYTE
    video_frames: int = 600
    video_seconds: float = 60.0
    video_pixels: int = 1 << 28

    @classmethod
    def from_settings(cls, settings: "Settings") -> "Limits":
        """Take the limits from the service's settings."""
        return cls(
            bytes=settings.max_upload_bytes,
            pixels=settings.max_upload_pixels,
            seconds=settings.decode_seconds,
            memory=settings.decode_memory,
            video_frames=settings.max_film_frames,
            video_seconds=settings.max_film_seconds,
            video_pixels=settings.max_film_pixels,
        )

    @property
    def clip(self) -> ClipLimits:
        """The limits of a video alone."""
        return ClipLimits(self.video_frames, self.video_seconds, self.video_pixels)


@dataclass(frozen=True, kw_only=True)
class Decoded(Media):
    """A picture or a video with its pixels; of a video they are its frame stack, the frames one below the other."""

    #: (H, W, C), uint8 or uint16; H counts the rows of all frames, C is `channels`.
    pixels: Pixels
    #: (H, W) of the same type; None if every pixel is opaque (`app.images.formats.still.is_opaque`).
    alpha: Pixels | None

    @classmethod
    def still(cls, pixels: Pixels, alpha: Pixels | None) -> "Decoded":
        """A still picture of these pixels."""
        height, width, channels = pixels.shape
        return cls(width, height, channels, pixels.itemsize * 8, alpha is not None, pixels=pixels, alpha=alpha)


def decode(path: Path, limits: Limits) -> Decoded:
    """Decode an uploaded file as a whole.

    Parameters
    ----------
    path : Path
    limits : Limits

    Returns
    -------
    Decoded

    Raises
    ------
    UnsupportedFormatError, BrokenFileError, TooLargeError
        As `read`.
    """
    found = read(path, limits)
    if isinstance(found, Decoded):
        return found
    strip, times = bytearray(), []  # grows in place, which a list of arrays does not
    for frame in found.frames:
        strip += frame.pixels.tobytes()
        times.append(frame.seconds)
    pixels, alpha = split_alpha(np.frombuffer(strip, np.uint8).reshape(-1, found.width, found.channels))
    return Decoded(**found.media(times).properties(), pixels=pixels, alpha=alpha)


def read(path: Path, limits: Limits) -> Decoded | ClipStream:
    """Decode an uploaded picture, or begin to decode a video.

    The format is recognised by the content, never by the name. Nothing here limits time or memory:
    `app.images.intake.client` runs it in a process that does.

    Parameters
    ----------
    path : Path
    limits : Limits

    Returns
    -------
    Decoded or ClipStream
        A still picture, or a video or animation whose frames are decoded while they are taken; taking them raises the
        same errors.

    Raises
    ------
    UnsupportedFormatError
        If the file has none of the formats that are read.
    BrokenFileError
        If it is empty, truncated, damaged or lies about its size.
    TooLargeError
        If it has more bytes, pixels, frames or seconds than the limits allow.
    """
    size = path.stat().st_size
    if size > limits.bytes:
        raise TooLargeError(
            f"The file has {size / MEBIBYTE:,.1f} MB; at most {limits.bytes / MEBIBYTE:,.1f} MB are accepted. "
            "Make the picture smaller or save it as JPEG, make the video smaller or shorter, and upload it again."
        )
    data = path.read_bytes()
    if not data:
        raise BrokenFileError("The file is empty: choose it again, and upload it once more.")
    with _translate_errors():
        if container := identify_container(data):
            clip = video.decode(data, container, limits.pixels, limits.clip)
        elif animation.is_animation(data):
            clip = animation.decode(data, limits.pixels, limits.clip)
        else:
            raw = _choose_decoder(data)(data, limits.pixels)
            pixels = turn_upright(to_srgb(raw.pixels, raw.profile), raw.orientation)
            alpha = None if raw.alpha is None or is_opaque(raw.alpha) else turn_upright(raw.alpha, raw.orientation)
            return Decoded.still(pixels, alpha)
    return replace(clip, frames=_translate_frame_errors(clip.frames))


def _translate_frame_errors(frames: Iterator[TimedFrame]) -> Iterator[TimedFrame]:
    with _translate_errors():
        yield from frames


@contextmanager
def _translate_errors() -> Iterator[None]:
    try:
        yield
    except (UnsupportedFormatError, BrokenFileError, TooLargeError, MemoryError):
        raise
    except Exception as error:
        # On broken input the libraries raise dozens of kinds, IndexError and struct.error among them.
        raise BrokenFileError(
            "This file cannot be decoded; it is damaged or incomplete. "
            "Open it in the program that made it, save it again and upload the new file."
        ) from error


def _choose_decoder(data: bytes) -> Callable[[bytes, int], Raw]:
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
        kind = "a HEIC or AVIF picture"
    elif data[8:12] == b"AVI ":
        kind = "an AVI video"
    found = f"This file is {kind}, which is" if kind else "This file is"
    raise UnsupportedFormatError(f"{found} not in a format that can be read. Save it as one of these: {FORMATS}.")

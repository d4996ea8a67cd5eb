"""Video encoders, fed frame by frame: WebM (VP9), MP4 (H.264) and animated WebP.

WebM is exact: VP9 without loss, of red, green and blue as they are (its profile 1), so that nothing is rounded between
colour spaces. A video of one channel becomes the luma, in full range, of a video without colour. Only a video of more
than `MOST_LOSSLESS` bytes is coded with some loss, with chroma for every pixel. MP4 is for players that know nothing
else: one chroma value for four pixels, which alone costs a texture of fine colours more than the coding does, and even
sides: an odd video is continued by its last column or row, see `name_repeated_edges`. (With chroma for every pixel
H.264 codes odd sides too. Browsers play that on Linux, but for 64 × 1 in Firefox; the decoders of phones, of Safari and
of Windows do not, and they are what the file is for. WebM has any size.)

The same frames give the same bytes: an encoder has as many threads on every machine, and nothing that changes from run
to run is written beside the pictures.
"""

from collections.abc import Callable, Iterable
from fractions import Fraction
from pathlib import Path
from typing import Literal, NamedTuple

import av
import numpy as np
from av.video.plane import VideoPlane
from av.video.reformatter import ColorPrimaries, ColorRange, Colorspace, ColorTrc, Interpolation
from numpy.typing import NDArray

Frame = NDArray[np.uint8]
Kind = Literal["webm", "mp4", "webp"]

MOST_LOSSLESS = 1 << 27  # bytes of all frames; of noise the file has up to 0.8 as many
LARGEST_DENOMINATOR = 1001  # of a rate, as in 24000/1001
PREVIEW_SIDE, PREVIEW_FRAMES = 256, 100  # at most
NO_CHROMA = 128
IDENTITY = 0  # the matrix of RGB; PyAV has no name for it
RGB_PLANES = (1, 2, 0)  # the channels in the order of the planes
MUXERS: dict[Kind, dict[str, str]] = {
    "webm": {"fflags": "+bitexact"},
    "mp4": {"fflags": "+bitexact", "movflags": "+faststart"},
    "webp": {"loop": "0"},  # for ever
}


def rate_as_fraction(rate: float) -> Fraction:
    """Convert frames a second to the fraction behind the rounded number, as 24000/1001 behind 23.976.

    Examples
    --------
    >>> print(rate_as_fraction(24.0), rate_as_fraction(24000 / 1001), rate_as_fraction(1 / 0.07))
    24 24000/1001 100/7
    """
    return Fraction(rate).limit_denominator(LARGEST_DENOMINATOR)


def name_repeated_edges(width: int, height: int) -> str:
    """Name the edges that the MP4 of a video of this size repeats; an empty text if both sides are even.

    Examples
    --------
    >>> [name_repeated_edges(width, height) for width in (71, 72) for height in (53, 54)]
    ['last column and last row', 'last column', 'last row', '']
    """
    return " and ".join(name for name, side in (("last column", width), ("last row", height)) if side % 2)


class VideoWriter:
    """A writer of one video file, whose memory does not grow with the number of frames.

    Parameters
    ----------
    path : Path
        The file; its name may have any suffix.
    kind : {"webm", "mp4", "webp"}
        WebP is a preview of at most 256 pixels a side and 100 frames: of a longer video it has every second, third, …
        frame, each shown two, three, … times as long.
    width, height : int
        Of the video's frames.
    channels : int
        1 (grey) or 3 (RGB).
    count : int
        Number of frames.
    rate : float
        Frames a second.

    Attributes
    ----------
    width, height, frames : int
        Of the file.
    rate : float
        Of the file.

    Notes
    -----
    Only one thread at a time may call it. Call `close` at the end, after errors too.
    """

    def __init__(
        self, path: Path, kind: Kind, *, width: int, height: int, channels: int, count: int, rate: float
    ) -> None:
        self.path = path
        self.width, self.height = _compute_size(kind, width, height)
        self._every = -(-count // PREVIEW_FRAMES) if kind == "webp" else 1
        self.frames, self.rate = -(-count // self._every), rate / self._every
        self._coding = _choose_coding(kind, channels, width * height * channels * count)
        self._taken, self._finished = 0, False
        self._container = av.open(path, "w", format=kind, options=MUXERS[kind])
        self._stream = self._container.add_stream(self._coding.codec, rate_as_fraction(rate) / self._every)
        self._stream.options = dict(self._coding.options)
        self._stream.width, self._stream.height, self._stream.pix_fmt = self.width, self.height, self._coding.pixels
        encoder = self._stream.codec_context
        encoder.thread_count = self._coding.threads
        encoder.gop_size = max(1, round(rate))  # so that a player finds any frame within a second's
        _tag(encoder, self._coding)

    def write(self, frame: Frame) -> None:
        """Encode the next frame, (H, W, C) uint8, which is not kept."""
        if self._taken % self._every == 0:
            picture = self._coding.picture(frame, self.width, self.height, self._coding)
            _tag(picture, self._coding)
            self._container.mux(self._stream.encode(picture))
        self._taken += 1

    def finish(self) -> None:
        """Flush the encoder and complete the file."""
        self._container.mux(self._stream.encode(None))
        self._container.close()
        self._finished = True

    def close(self) -> None:
        """Release the encoder, and remove an incomplete file."""
        self._container.close()
        if not self._finished:
            self.path.unlink(missing_ok=True)


def write_video(frames: Iterable[Frame], path: Path, kind: Kind, *, count: int, rate: float) -> None:
    """Write a video file, with one frame in memory at a time.

    Parameters
    ----------
    frames : iterable of ndarray of uint8, shape (H, W, C)
        At least one.
    path, kind, count, rate
        As of `VideoWriter`.

    Raises
    ------
    OSError
        If the file cannot be written; nothing is left of it.
    """
    left = iter(frames)
    first = next(left)
    height, width, channels = first.shape
    writer = VideoWriter(path, kind, width=width, height=height, channels=channels, count=count, rate=rate)
    try:
        writer.write(first)
        for frame in left:
            writer.write(frame)
        writer.finish()
    finally:
        writer.close()


def view_rows(plane: VideoPlane) -> Frame:
    """View the bytes of a frame's plane as rows, which may be longer than the picture is wide."""
    return np.frombuffer(memoryview(plane), np.uint8).reshape(-1, plane.line_size)


class _Coding(NamedTuple):
    """An encoder with its options, and the meaning of its numbers."""

    codec: Literal["libvpx-vp9", "libx264", "libwebp_anim"]
    pixels: str
    options: dict[str, str]
    picture: Callable[[Frame, int, int, "_Coding"], av.VideoFrame]
    matrix: int = Colorspace.ITU601
    range: int = ColorRange.MPEG
    threads: int = 1


def _to_rgb_planes(frame: Frame, width: int, height: int, coding: _Coding) -> av.VideoFrame:
    picture = av.VideoFrame(width, height, coding.pixels)
    for plane, channel in zip(picture.planes, RGB_PLANES, strict=True):
        view_rows(plane)[:height, :width] = frame[:, :, channel]
    return picture


def _to_luma(frame: Frame, width: int, height: int, coding: _Coding) -> av.VideoFrame:
    picture = av.VideoFrame(width, height, coding.pixels)
    view_rows(picture.planes[0])[:height, :width] = frame[:, :, 0]
    for plane in picture.planes[1:]:
        view_rows(plane)[:] = NO_CHROMA
    return picture


def _convert(frame: Frame, width: int, height: int, coding: _Coding) -> av.VideoFrame:
    below, right = max(0, height - len(frame)), max(0, width - frame.shape[1])
    rgb = np.pad(np.broadcast_to(frame, (*frame.shape[:2], 3)), ((0, below), (0, right), (0, 0)), "edge")
    return av.VideoFrame.from_ndarray(rgb, "rgb24").reformat(
        width,
        height,
        coding.pixels,
        dst_colorspace=coding.matrix,
        src_color_range=ColorRange.JPEG,
        dst_color_range=coding.range,
        interpolation=Interpolation.AREA | Interpolation.FULL_CHR_H_INP | Interpolation.ACCURATE_RND,
    )


_VP9 = {
    "deadline": "realtime",  # "good" takes five times as long and saves 1 % of noise, half of an even motion
    "cpu-used": "7",
    "row-mt": "1",
    "lag-in-frames": "0",
    "tile-columns": "2",  # up to four, of 256 pixels at least, which a player decodes at the same time
}
_LOSSLESS, _FINE = {**_VP9, "lossless": "1"}, {**_VP9, "crf": "6", "b": "0"}
# With its macroblock tree, single-threaded or not, x264's bytes differ from run to run (not without assembler code).
_H264 = {"preset": "fast", "tune": "psnr", "crf": "10", "mbtree": "0"}
_WEBP = {"quality": "75", "compression_level": "2"}

LOSSLESS = _Coding("libvpx-vp9", "gbrp", _LOSSLESS, _to_rgb_planes, IDENTITY, ColorRange.JPEG, 2)
LOSSLESS_GREY = _Coding("libvpx-vp9", "yuv420p", _LOSSLESS, _to_luma, range=ColorRange.JPEG, threads=2)
FINE = _Coding("libvpx-vp9", "yuv444p", _FINE, _convert, threads=2)
FINE_GREY = _Coding("libvpx-vp9", "yuv420p", _FINE, _to_luma, range=ColorRange.JPEG, threads=2)
MP4 = _Coding("libx264", "yuv420p", _H264, _convert)
PREVIEW = _Coding("libwebp_anim", "bgra", _WEBP, _convert, range=ColorRange.JPEG)


def _choose_coding(kind: Kind, channels: int, size: int) -> _Coding:
    if kind != "webm":
        return MP4 if kind == "mp4" else PREVIEW
    if channels == 1:
        return LOSSLESS_GREY if size <= MOST_LOSSLESS else FINE_GREY
    return LOSSLESS if size <= MOST_LOSSLESS else FINE


def _compute_size(kind: Kind, width: int, height: int) -> tuple[int, int]:
    if kind == "mp4":
        return width + width % 2, height + height % 2
    scale = min(1.0, PREVIEW_SIDE / max(width, height)) if kind == "webp" else 1.0
    return max(1, round(width * scale)), max(1, round(height * scale))


def _tag(target: av.VideoFrame | av.VideoCodecContext, coding: _Coding) -> None:
    """Tag what the numbers mean: sRGB, or luma and chroma made from it."""
    target.colorspace, target.color_range = coding.matrix, coding.range
    target.color_primaries, target.color_trc = ColorPrimaries.BT709, ColorTrc.IEC61966_2_1

"""Encoders that take one frame after the other: WebM (VP9), MP4 (H.264) and animated WebP.

The same frames give the same bytes: the threads of every encoder are counted here, not by the machine, and nothing
that changes from run to run is written beside the pictures.

WebM is lossless and exact in RGB: VP9 codes the planes green, blue and red as they are (profile 1). A film of one
channel is the luma, in full range, of a film without colour, which every VP9 decoder plays. A film too long for that
is coded in high quality, with a chroma value for every pixel. MP4 has one for four pixels, as players expect, and even
sides: an odd film is continued by its last row or column.
"""

from collections.abc import Iterable
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

MOST_LOSSLESS = 1 << 27  # bytes of all frames; a lossless file is up to 0.8 of them for noise
LARGEST_DENOMINATOR = 1001  # of a rate: 24000/1001, 100/7 (centiseconds of GIF)
PREVIEW_SIDE = 256
PREVIEW_FRAMES = 100
RGB_PLANES = (1, 2, 0)  # which channel each plane of gbrp holds


class Coding(NamedTuple):
    """An encoder with its options, and what its numbers mean."""

    codec: Literal["libvpx-vp9", "libx264", "libwebp_anim"]
    pixels: str
    options: dict[str, str]
    threads: int
    space: int
    full_range: bool


VP9 = {"deadline": "good", "cpu-used": "4", "row-mt": "1", "auto-alt-ref": "0"}
LOSSLESS = Coding("libvpx-vp9", "gbrp", {**VP9, "lossless": "1"}, 2, 0, True)
LOSSLESS_GREY = Coding("libvpx-vp9", "yuv420p", {**VP9, "lossless": "1"}, 2, Colorspace.ITU709, True)
FINE = Coding("libvpx-vp9", "yuv444p", {**VP9, "crf": "12", "b": "0"}, 2, Colorspace.ITU709, False)
FINE_GREY = Coding("libvpx-vp9", "yuv420p", {**VP9, "crf": "12", "b": "0"}, 2, Colorspace.ITU709, True)
H264 = Coding("libx264", "yuv420p", {"preset": "medium", "crf": "16", "mbtree": "0"}, 1, Colorspace.ITU709, False)
WEBP = Coding("libwebp_anim", "bgra", {"quality": "80", "compression_level": "2"}, 1, 0, True)
MUXER_OPTIONS = {
    "webm": {"fflags": "+bitexact"},
    "mp4": {"fflags": "+bitexact", "movflags": "+faststart"},
    "webp": {"loop": "0"},
}


def exact_rate(rate: float) -> Fraction:
    """Frames a second as the fraction that was meant.

    Examples
    --------
    >>> print(exact_rate(24), exact_rate(23.976023976), exact_rate(14.2857142857))
    24 24000/1001 100/7
    """
    return Fraction(rate).limit_denominator(LARGEST_DENOMINATOR)


class FilmWriter:
    """A film's file that is written frame by frame; the file is complete after `finish`.

    Parameters
    ----------
    path : Path
        Where; its name's ending does not matter.
    kind : {"webm", "mp4", "webp"}
    width, height, channels : int
        Of the frames; 1 (grey) or 3 (RGB) channels.
    count : int
        How many frames are expected: a WebM film of more than `MOST_LOSSLESS` bytes is not lossless, and of a long
        one an animated WebP shows every so manieth frame, for as much longer.
    rate : float
        Frames a second.

    Notes
    -----
    One thread at a time may call it. Leave it through `close`, which without `finish` removes the file.
    """

    def __init__(
        self, path: Path, kind: Kind, *, width: int, height: int, channels: int, count: int, rate: float
    ) -> None:
        self.path = path
        self.width, self.height = _shown_size(kind, width, height)
        self._kind = kind
        self._coding = _coding(kind, channels, width * height * channels * count)
        self._every = -(-count // PREVIEW_FRAMES) if kind == "webp" else 1
        self._taken = 0
        self._finished = False
        self._container = av.open(path, "w", format=kind, options=MUXER_OPTIONS[kind])
        self._stream = self._container.add_stream(
            self._coding.codec, exact_rate(rate) / self._every, dict(self._coding.options)
        )
        self._stream.width, self._stream.height = self.width, self.height
        self._stream.pix_fmt = self._coding.pixels
        context = self._stream.codec_context
        context.thread_count = self._coding.threads
        context.colorspace, context.color_range = self._coding.space, self._range
        context.color_primaries, context.color_trc = ColorPrimaries.BT709, ColorTrc.IEC61966_2_1

    @property
    def _range(self) -> ColorRange:
        return ColorRange.JPEG if self._coding.full_range else ColorRange.MPEG

    def write(self, frame: Frame) -> None:
        """Add a frame, (H, W, C) uint8; it is not kept."""
        if self._taken % self._every == 0:
            self._container.mux(self._stream.encode(self._picture(frame)))
        self._taken += 1

    def finish(self) -> None:
        """Write what the encoder still holds and complete the file."""
        self._container.mux(self._stream.encode(None))
        self._container.close()
        self._finished = True

    def close(self) -> None:
        """Let go of the encoder; without `finish` before, nothing stays."""
        self._container.close()
        if not self._finished:
            self.path.unlink(missing_ok=True)

    def _picture(self, frame: Frame) -> av.VideoFrame:
        height, width, channels = frame.shape
        grey = channels == 1
        if self._coding.pixels == "gbrp":
            picture = av.VideoFrame(width, height, "gbrp")
            for plane, channel in zip(picture.planes, RGB_PLANES, strict=True):
                rows(plane)[:height, :width] = frame[:, :, channel]
        elif grey and self._coding.full_range and self._kind == "webm":
            picture = av.VideoFrame(width, height, "yuv420p")
            rows(picture.planes[0])[:height, :width] = frame[:, :, 0]
            for plane in picture.planes[1:]:
                rows(plane)[:] = 128
        else:
            if self._kind == "mp4":
                frame = np.pad(frame, ((0, height % 2), (0, width % 2), (0, 0)), "edge")
            picture = av.VideoFrame.from_ndarray(np.ascontiguousarray(frame.repeat(3, 2) if grey else frame), "rgb24")
            picture = picture.reformat(
                width=self.width,
                height=self.height,
                format=self._coding.pixels,
                dst_colorspace=self._coding.space,
                src_color_range=ColorRange.JPEG,
                dst_color_range=self._range,
                interpolation=Interpolation.AREA | Interpolation.FULL_CHR_H_INP | Interpolation.ACCURATE_RND,
            )
        picture.colorspace, picture.color_range = self._coding.space, self._range
        picture.color_primaries, picture.color_trc = ColorPrimaries.BT709, ColorTrc.IEC61966_2_1
        return picture


def write_film(frames: Iterable[Frame], path: Path, kind: Kind, *, count: int, rate: float) -> None:
    """Write frames, (H, W, C) uint8 each, as one file, holding one of them at a time.

    Raises
    ------
    ValueError
        If there is no frame.
    """
    writer = None
    try:
        for frame in frames:
            if writer is None:
                height, width, channels = frame.shape
                writer = FilmWriter(path, kind, width=width, height=height, channels=channels, count=count, rate=rate)
            writer.write(frame)
        if writer is None:
            raise ValueError("a film has at least one frame")
        writer.finish()
    finally:
        if writer is not None:
            writer.close()


def _shown_size(kind: Kind, width: int, height: int) -> tuple[int, int]:
    if kind == "mp4":
        return width + width % 2, height + height % 2
    scale = min(1.0, PREVIEW_SIDE / max(width, height)) if kind == "webp" else 1.0
    return max(1, round(width * scale)), max(1, round(height * scale))


def _coding(kind: Kind, channels: int, size: int) -> Coding:
    if kind != "webm":
        return H264 if kind == "mp4" else WEBP
    if channels == 1:
        return LOSSLESS_GREY if size <= MOST_LOSSLESS else FINE_GREY
    return LOSSLESS if size <= MOST_LOSSLESS else FINE


def rows(plane: VideoPlane) -> Frame:
    """The bytes of a frame's plane, row by row, with what stands behind the last column."""
    return np.frombuffer(memoryview(plane), np.uint8).reshape(-1, plane.line_size)

"""Videos: MP4 and QuickTime with H.264, WebM and Matroska with VP8, VP9 or AV1; the picture only, never sound or text.

The numbers become RGB by the matrix and the range that the stream names (where it names none: BT.601 below 720 lines,
otherwise BT.709; limited range) and count as sRGB; more than 8 bits become 8. Frames are turned upright; pixels that
are not square are made so by enlarging one axis. The rate is the average one. What is interlaced stays so.
"""

import io
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction

import av
import numpy as np
from av.codec.context import CodecContext
from av.container import InputContainer
from av.error import FFmpegError
from av.sidedata.sidedata import SideData
from av.stream import Disposition
from av.video.codeccontext import VideoCodecContext
from av.video.frame import VideoFrame
from av.video.reformatter import ColorRange, Colorspace, ColorTrc, Interpolation, VideoReformatter
from av.video.stream import VideoStream

from app.errors import BrokenFileError, UnsupportedFormatError
from app.images.formats.clip import USUAL_RATE, Clip, ClipLimits, TimedFrame, check_clip, limit_clip
from app.images.formats.containers import Container
from app.images.formats.still import check_size, is_opaque, turn_upright

NAME = "video"
DAMAGED = (
    "This video is damaged or incomplete: see whether it plays to its end, save it again as MP4 with H.264, "
    "and upload the new file."
)
# By the name of the codec: which decoder reads the alpha channel too, where another is the better one without.
CODECS = {"h264": None, "vp8": "libvpx", "vp9": "libvpx-vp9", "av1": None}
THREADS = 2
# Without the last two, chroma is not interpolated and every channel is one or two levels of 255 too dark.
SCALING = Interpolation.BILINEAR | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INT
RGB, UNSPECIFIED = 0, 2  # of the matrix coefficients of ITU-T H.273, as are the keys
MATRICES = {
    1: Colorspace.ITU709,
    4: Colorspace.FCC,
    5: Colorspace.ITU601,
    6: Colorspace.ITU601,
    7: Colorspace.SMPTE240M,
    9: Colorspace.BT2020,
}
HD_LINES = 720
NEUTRAL = 128
HIGH_DYNAMIC_RANGE = {ColorTrc.SMPTE2084, ColorTrc.ARIB_STD_B67}
PADDING = 1 << 16  # pixels
OBLONG = 4  # pixels said to be so much wider than high, or higher than wide, are a mistake
DISPLAY_MATRIX = struct.Struct("=9i")
# By whether the axes are exchanged, then x and then y mirrored: EXIF's orientation.
ORIENTATIONS = {
    (False, False, False): 1,
    (False, True, False): 2,
    (False, True, True): 3,
    (False, False, True): 4,
    (True, False, False): 5,
    (True, True, False): 6,
    (True, True, True): 7,
    (True, False, True): 8,
}

av.logging.set_level(None)  # FFmpeg would say on standard error what is wrong with every broken file


def decode(data: bytes, container: Container, max_pixels: int, limits: ClipLimits) -> Clip:
    """Read a video; its frames are decoded while they are taken, and the errors below may come as late as that.

    Raises
    ------
    UnsupportedFormatError
        If it has no picture, or one that is not of these codecs, or is HDR.
    BrokenFileError
        If it is truncated or damaged, or its frames change their size.
    TooLargeError
        If it has more pixels, frames or seconds than the limits allow.
    """
    if not container.whole:
        raise BrokenFileError(DAMAGED)
    track = _VideoTrack(data, container, max_pixels, limits)
    channels = track.channels
    # Seldom worth another pass through the file: it has an alpha channel, or begins without colour.
    if channels == 4 and all(is_opaque(frame.pixels[..., 3]) for frame in track.frames(4)):
        channels = 3
    if channels == 1 and not track.is_grey():
        channels = 3
    return Clip(track.width, track.height, channels, container.media_type, track.frames(channels), track.rate)


class _VideoTrack:
    """A file's video track, which may be decoded several times; how its frames become pixels is told by the first."""

    def __init__(self, data: bytes, container: Container, max_pixels: int, limits: ClipLimits) -> None:
        self._data, self._demuxer, self._max_pixels, self._limits = data, container.demuxer, max_pixels, limits
        # Decoders count padded frames; this is only to keep a lie about the size from taking memory.
        self._coded_pixels = 2 * max_pixels + PADDING
        with _telling(), self._open() as opened:
            stream = _stream(opened)
            self._check(opened, stream)
            self.rate = float(stream.average_rate or USUAL_RATE)
            told = stream.codec_context.colorspace, stream.codec_context.color_range, stream.codec_context.color_trc
            decoder = self._decoder(stream)
            first = next(_decoded(opened, stream, decoder), None)
            aspect = stream.sample_aspect_ratio or decoder.sample_aspect_ratio
        if first is None:
            raise BrokenFileError(DAMAGED)
        if {first.color_trc, told[2]} & HIGH_DYNAMIC_RANGE:
            raise UnsupportedFormatError(
                "This video is HDR, whose colours a texture of ordinary range cannot hold: "
                "save it as SDR, MP4 with H.264, and upload the new file."
            )
        self._coded = first.width, first.height
        self._scaled = _squared(first.width, first.height, aspect)
        check_size(*self._scaled, max_pixels, NAME)
        coded = first.colorspace, first.color_range
        if decoder.codec.canonical_name == "vp8" and told[0] != UNSPECIFIED:
            coded = told[:2]  # VP8 itself can say nothing but BT.601; browsers record BT.709 in full range
        self._matrix = _matrix(coded[0], first.height)
        self._range = ColorRange.JPEG if coded[1] == ColorRange.JPEG else ColorRange.MPEG
        self._orientation = _orientation(first)
        self.width, self.height = self._scaled[::-1] if self._orientation > 4 else self._scaled
        self.channels = 4 if first.format.name.startswith("yuva") else 1 if _is_neutral(first) else 3

    def is_grey(self) -> bool:
        """Whether no frame has a colour."""
        with _telling(), self._open() as opened:
            stream = _stream(opened)
            return all(map(_is_neutral, _decoded(opened, stream, self._decoder(stream))))

    def frames(self, channels: int) -> Iterator[TimedFrame]:
        return limit_clip(self._frames(channels), self._limits)

    def _frames(self, channels: int) -> Iterator[TimedFrame]:
        reformatter, (width, height) = VideoReformatter(), self._scaled
        with _telling(), self._open() as opened:
            stream = _stream(opened)
            for index, frame in enumerate(_decoded(opened, stream, self._decoder(stream))):
                if (frame.width, frame.height) != self._coded:
                    raise BrokenFileError(
                        "The frames of this video change their size on the way: "
                        "save it again as MP4 with H.264, and upload the new file."
                    )
                picture = reformatter.reformat(
                    frame,
                    width,
                    height,
                    {1: "gray", 3: "rgb24", 4: "rgba"}[channels],
                    src_colorspace=self._matrix,
                    src_color_range=self._range,
                    dst_color_range=ColorRange.JPEG,
                    interpolation=SCALING,
                    threads=1,
                )
                pixels = picture.to_ndarray().reshape(height, width, channels).view(np.uint8)
                seconds = index / self.rate if frame.pts is None else float(frame.pts * (stream.time_base or 1))
                yield TimedFrame(turn_upright(pixels, self._orientation), seconds)

    def _open(self) -> InputContainer:
        # The demuxer is named and no protocol allowed: nothing but these bytes is opened, whatever they refer to.
        # No codec is allowed either: the demuxer would use it to look into every track, sound among them.
        return av.open(
            io.BytesIO(self._data),
            "r",
            format=self._demuxer,
            options={"protocol_whitelist": "", "codec_whitelist": "none"},
            metadata_errors="replace",
        )

    def _check(self, opened: InputContainer, stream: VideoStream) -> None:
        """Refuse what is too much by what the headers say, before a frame is decoded."""
        width, height = stream.width or 1, stream.height or 1
        check_size(width, height, self._max_pixels, NAME)
        if stream.duration and stream.time_base:
            seconds = float(stream.duration * stream.time_base)
        else:
            seconds = (opened.duration or 0) / av.time_base
        check_clip(width, height, round(seconds * float(stream.average_rate or 0)), seconds, self._limits)

    def _decoder(self, stream: VideoStream) -> VideoCodecContext:
        codec: CodecContext = stream.codec_context
        with_alpha = CODECS[codec.codec.canonical_name]
        if with_alpha and stream.metadata.get("alpha_mode") == "1":
            codec = CodecContext.create(with_alpha, "r")
        assert isinstance(codec, VideoCodecContext)
        codec.options = {"err_detect": "explode", "max_pixels": str(self._coded_pixels)}
        codec.thread_count, codec.thread_type = THREADS, "AUTO"
        return codec


@contextmanager
def _telling() -> Iterator[None]:
    try:
        yield
    except MemoryError:  # FFmpeg's is one of its own errors, too
        raise
    except FFmpegError as error:
        raise BrokenFileError(DAMAGED) from error


def _stream(opened: InputContainer) -> VideoStream:
    """Find the first picture that moves and can be decoded."""
    streams = [each for each in opened.streams.video if not each.disposition & Disposition.attached_pic]
    if not streams:
        raise UnsupportedFormatError("This file holds no moving picture: upload a video, or a picture as PNG or JPEG.")
    context = streams[0].codec_context
    name = context.codec.canonical_name if context else "something unknown"
    if name not in CODECS:
        raise UnsupportedFormatError(
            f"This video is coded as {name.upper()}, which is not read: "
            "save it as MP4 with H.264, and upload the new file."
        )
    return streams[0]


def _decoded(opened: InputContainer, stream: VideoStream, codec: VideoCodecContext) -> Iterator[VideoFrame]:
    packets = 0
    for packet in opened.demux(stream):
        packets += packet.size > 0
        for frame in codec.decode(packet if packet.size else None):
            if packet.is_corrupt or frame.is_corrupt:
                raise BrokenFileError(DAMAGED)
            yield frame
    if packets < len(stream.index_entries):
        raise BrokenFileError(DAMAGED)


def _is_neutral(frame: VideoFrame) -> bool:
    """Whether a frame has no chroma, or none but neutral one."""
    if frame.format.name.startswith("gray"):
        return True
    if frame.format.name not in ("yuv420p", "yuvj420p", "yuv422p", "yuvj422p", "yuv444p", "yuvj444p"):
        return False
    for plane in frame.planes[1:]:
        rows = np.frombuffer(memoryview(plane), np.uint8).reshape(-1, plane.line_size)[: plane.height, : plane.width]
        if (rows != NEUTRAL).any():
            return False
    return True


def _squared(width: int, height: int, aspect: Fraction | None) -> tuple[int, int]:
    """Size with square pixels, no axis smaller than it was."""
    if not aspect or not 1 / OBLONG <= aspect <= OBLONG:
        return width, height
    return (round(width * aspect), height) if aspect > 1 else (width, round(height / aspect))


def _matrix(coefficients: int, lines: int) -> Colorspace:
    if coefficients in (RGB, UNSPECIFIED):
        return Colorspace.ITU601 if lines < HD_LINES else Colorspace.ITU709
    if coefficients not in MATRICES:
        raise UnsupportedFormatError(
            "This video has colours of a kind that is not read: save it as MP4 with H.264, and upload the new file."
        )
    return MATRICES[coefficients]


def _orientation(frame: VideoFrame) -> int:
    """EXIF's number for what the display matrix says; ``x' = a x + c y`` and ``y' = b x + d y``."""
    matrix = frame.side_data.get("DISPLAYMATRIX")
    if not isinstance(matrix, SideData) or matrix.buffer_size != DISPLAY_MATRIX.size:
        return 1
    a, b, _, c, d, *_ = DISPLAY_MATRIX.unpack(bytes(matrix))
    exchanged = abs(b) + abs(c) > abs(a) + abs(d)
    return ORIENTATIONS[exchanged, (c if exchanged else a) < 0, (b if exchanged else d) < 0]

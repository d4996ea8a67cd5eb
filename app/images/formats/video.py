"""Video decoder: MP4 and QuickTime with H.264, WebM and Matroska with VP8, VP9 or AV1; the picture, not the sound.

YUV becomes RGB by the matrix and the range that the stream names (where it names none: BT.601 below 720 lines,
otherwise BT.709; limited range) and counts as sRGB; more than 8 bits become 8. Frames are turned upright; pixels that
are not square become square by enlarging one axis. The frame rate is the average. Interlaced frames stay interlaced.
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
from app.images.formats.clip import USUAL_RATE, ClipLimits, ClipStream, TimedFrame, check_clip, limit_clip
from app.images.formats.containers import Container
from app.images.formats.still import check_size, is_opaque, turn_upright

NAME = "video"
DAMAGED = (
    "This video is damaged or incomplete: check that it plays to its end, save it again as MP4 with H.264, "
    "and upload the new file."
)
# Decoder for an alpha channel, by the codec's name; None where the usual decoder is the one.
CODECS = {"h264": None, "vp8": "libvpx", "vp9": "libvpx-vp9", "av1": None}
THREADS = 2
# Without the last two chroma is not interpolated, and every channel is one or two of 255 levels too dark.
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
OBLONG = 4  # an aspect ratio of pixels beyond 4 : 1 or 1 : 4 is taken for a mistake
DISPLAY_MATRIX = struct.Struct("=9i")
# EXIF's orientation by (axes exchanged, x mirrored, y mirrored), in this order.
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

av.logging.set_level(None)  # FFmpeg would report every broken file on standard error


def decode(data: bytes, container: Container, max_pixels: int, limits: ClipLimits) -> ClipStream:
    """Decode a video; its frames are decoded while they are taken, and the errors below may come as late as that.

    Parameters
    ----------
    data : bytes
        The file.
    container : Container
        As recognised by `app.images.formats.containers.identify_container`.
    max_pixels : int
        Of a frame.
    limits : ClipLimits

    Returns
    -------
    ClipStream

    Raises
    ------
    UnsupportedFormatError
        If it has no picture, a codec that is not read, or is HDR.
    BrokenFileError
        If it is truncated or damaged, or its frames change their size.
    TooLargeError
        If it has more pixels, frames or seconds than the limits allow.
    """
    if not container.whole:
        raise BrokenFileError(DAMAGED)
    track = _VideoTrack(data, container, max_pixels, limits)
    channels = track.channels
    # Another pass through the file, but seldom: it has an alpha channel, or begins without colour.
    if channels == 4 and all(is_opaque(frame.pixels[..., 3]) for frame in track.frames(4)):
        channels = 3
    if channels == 1 and not track.is_grey():
        channels = 3
    return ClipStream(track.width, track.height, channels, container.media_type, track.frames(channels), track.rate)


class _VideoTrack:
    """The video track of a file, which may be decoded several times; its first frame decides how pixels are made."""

    def __init__(self, data: bytes, container: Container, max_pixels: int, limits: ClipLimits) -> None:
        self._data, self._demuxer, self._max_pixels, self._limits = data, container.demuxer, max_pixels, limits
        # Decoders count padded frames; this only keeps a wrong size in the header from taking memory.
        self._coded_pixels = 2 * max_pixels + PADDING
        with _translate_errors(), self._open() as opened:
            stream = _find_stream(opened)
            self._check_headers(opened, stream)
            self.rate = float(stream.average_rate or USUAL_RATE)
            named = stream.codec_context.colorspace, stream.codec_context.color_range, stream.codec_context.color_trc
            decoder = self._open_decoder(stream)
            first = next(_decode_frames(opened, stream, decoder), None)
            aspect = stream.sample_aspect_ratio or decoder.sample_aspect_ratio
        if first is None:
            raise BrokenFileError(DAMAGED)
        if {first.color_trc, named[2]} & HIGH_DYNAMIC_RANGE:
            raise UnsupportedFormatError(
                "Save this video as SDR, MP4 with H.264, and upload the new file: "
                "it is HDR, whose colours do not fit into a texture of ordinary range."
            )
        self._coded = first.width, first.height
        self._scaled = _square_pixels(first.width, first.height, aspect)
        check_size(*self._scaled, max_pixels, NAME)
        coded = first.colorspace, first.color_range
        if decoder.codec.canonical_name == "vp8" and named[0] != UNSPECIFIED:
            coded = named[:2]  # VP8 itself knows only BT.601; browsers record BT.709 in full range
        self._matrix = _choose_matrix(coded[0], first.height)
        self._range = ColorRange.JPEG if coded[1] == ColorRange.JPEG else ColorRange.MPEG
        self._orientation = _read_orientation(first)
        self.width, self.height = self._scaled[::-1] if self._orientation > 4 else self._scaled
        self.channels = 4 if first.format.name.startswith("yuva") else 1 if _is_neutral(first) else 3

    def is_grey(self) -> bool:
        """Whether no frame has a colour."""
        with _translate_errors(), self._open() as opened:
            stream = _find_stream(opened)
            return all(map(_is_neutral, _decode_frames(opened, stream, self._open_decoder(stream))))

    def frames(self, channels: int) -> Iterator[TimedFrame]:
        """Decode the frames to 1 (grey), 3 (RGB) or 4 (RGB and alpha) channels; raise as `decode` does."""
        return limit_clip(self._frames(channels), self._limits)

    def _frames(self, channels: int) -> Iterator[TimedFrame]:
        reformatter, (width, height) = VideoReformatter(), self._scaled
        with _translate_errors(), self._open() as opened:
            stream = _find_stream(opened)
            for index, frame in enumerate(_decode_frames(opened, stream, self._open_decoder(stream))):
                if (frame.width, frame.height) != self._coded:
                    raise BrokenFileError(
                        "Save this video again as MP4 with H.264, and upload the new file: "
                        "its frames do not all have the same size."
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
        # The demuxer is named and no protocol is allowed: nothing but these bytes is opened, whatever they refer to.
        # No codec is allowed either: the demuxer would use it to examine every track, sound among them.
        return av.open(
            io.BytesIO(self._data),
            "r",
            format=self._demuxer,
            options={"protocol_whitelist": "", "codec_whitelist": "none"},
            metadata_errors="replace",
        )

    def _check_headers(self, opened: InputContainer, stream: VideoStream) -> None:
        """Refuse a video by the size and length in its headers, before a frame is decoded."""
        width, height = stream.width or 1, stream.height or 1
        check_size(width, height, self._max_pixels, NAME)
        if stream.duration and stream.time_base:
            seconds = float(stream.duration * stream.time_base)
        else:
            seconds = (opened.duration or 0) / av.time_base
        check_clip(width, height, round(seconds * float(stream.average_rate or 0)), seconds, self._limits)

    def _open_decoder(self, stream: VideoStream) -> VideoCodecContext:
        codec: CodecContext = stream.codec_context
        with_alpha = CODECS[codec.codec.canonical_name]
        if with_alpha and stream.metadata.get("alpha_mode") == "1":
            codec = CodecContext.create(with_alpha, "r")
        assert isinstance(codec, VideoCodecContext)
        codec.options = {"err_detect": "explode", "max_pixels": str(self._coded_pixels)}
        codec.thread_count, codec.thread_type = THREADS, "AUTO"
        return codec


@contextmanager
def _translate_errors() -> Iterator[None]:
    try:
        yield
    except MemoryError:  # FFmpeg's is one of its own errors, too
        raise
    except FFmpegError as error:
        raise BrokenFileError(DAMAGED) from error


def _find_stream(opened: InputContainer) -> VideoStream:
    """Find the first video stream that is no cover picture; refuse one whose codec is not read."""
    streams = [each for each in opened.streams.video if not each.disposition & Disposition.attached_pic]
    if not streams:
        raise UnsupportedFormatError(
            "Upload a video, or a picture as PNG or JPEG: this file holds no video, only sound or a cover picture."
        )
    context = streams[0].codec_context
    name = context.codec.canonical_name if context else "something unknown"
    if name not in CODECS:
        raise UnsupportedFormatError(
            f"Save this video as MP4 with H.264, and upload the new file: its codec, {name.upper()}, is not supported."
        )
    return streams[0]


def _decode_frames(opened: InputContainer, stream: VideoStream, codec: VideoCodecContext) -> Iterator[VideoFrame]:
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


def _square_pixels(width: int, height: int, aspect: Fraction | None) -> tuple[int, int]:
    """Compute the size with square pixels; no axis becomes smaller."""
    if not aspect or not 1 / OBLONG <= aspect <= OBLONG:
        return width, height
    return (round(width * aspect), height) if aspect > 1 else (width, round(height / aspect))


def _choose_matrix(coefficients: int, lines: int) -> Colorspace:
    if coefficients in (RGB, UNSPECIFIED):
        return Colorspace.ITU601 if lines < HD_LINES else Colorspace.ITU709
    if coefficients not in MATRICES:
        raise UnsupportedFormatError(
            "Save this video as MP4 with H.264, and upload the new file: its colour matrix is not supported."
        )
    return MATRICES[coefficients]


def _read_orientation(frame: VideoFrame) -> int:
    """Read the display matrix as an EXIF orientation; ``x' = a x + c y`` and ``y' = b x + d y``."""
    matrix = frame.side_data.get("DISPLAYMATRIX")
    if not isinstance(matrix, SideData) or matrix.buffer_size != DISPLAY_MATRIX.size:
        return 1
    a, b, _, c, d, *_ = DISPLAY_MATRIX.unpack(bytes(matrix))
    exchanged = abs(b) + abs(c) > abs(a) + abs(d)
    return ORIENTATIONS[exchanged, (c if exchanged else a) < 0, (b if exchanged else d) < 0]

"""Small videos and animations for the decoders to read, made on the fly."""

import io
import os
import struct
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from typing import Any

import av
import numpy as np
from av.video.reformatter import Interpolation, VideoReformatter
from numpy.typing import NDArray
from PIL import Image

VideoArray = NDArray[np.uint8]
ACCURATE = Interpolation.BILINEAR | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INT
BT601, BT709, LIMITED, FULL = 5, 1, 1, 2

os.environ["SVT_LOG"] = "1"  # the AV1 encoder would describe itself at length


def moving(count: int = 6, height: int = 48, width: int = 64, *, seed: int = 0) -> VideoArray:
    """A smooth pattern that moves, (T, H, W, 3): no two frames alike, no side like another."""
    t, y, x = np.mgrid[0:count, 0:height, 0:width]
    phase = np.random.default_rng(seed).uniform(0, 6, 3)
    waves = [np.sin(x / (9 + i) + y / (14 - i) + t / (1 + i) + phase[i]) for i in range(3)]
    ramp = x / width - y / height
    return np.stack([128 + 60 * wave + 50 * ramp for wave in waves], axis=-1).astype(np.uint8)


@contextmanager
def same_priority() -> Iterator[None]:
    """Undo what SVT-AV1 does as root: it makes its caller a real-time thread, and so all that is started later."""
    policy, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        yield
    finally:
        os.sched_setscheduler(0, policy, parameters)


@same_priority()
def video(
    film: VideoArray,
    codec: Any = "libx264",
    pixels: str = "yuv420p",
    *,
    form: str = "mp4",
    rate: Fraction | int = 25,
    matrix: int = BT601,
    colours: int = LIMITED,
    tagged: bool = True,
    ticks: Sequence[int] | None = None,
    stream: Callable[[Any], None] | None = None,
    options: dict[str, str] | None = None,
    container: dict[str, str] | None = None,
) -> bytes:
    """A video as a file; ``ticks`` are when its frames are shown, and ``stream`` changes the stream before it is coded.

    ``film`` is (T, H, W, C), C 1, 3 or 4. ``tagged`` says whether the file names the matrix and the range.
    """
    written = io.BytesIO()
    source = {1: "gray", 3: "rgb24", 4: "rgba"}[film.shape[3]]
    with av.open(written, "w", format=form, options=container or {}) as file:
        track = file.add_stream(codec, rate=rate, options=options or {})
        track.height, track.width, track.pix_fmt = *film.shape[1:3], pixels
        if tagged and not pixels.startswith(("gbr", "rgb")):
            track.codec_context.colorspace, track.codec_context.color_range = matrix, colours
        if stream is not None:
            stream(track)
        reformatter = VideoReformatter()
        for index, frame in enumerate(film):
            coded = reformatter.reformat(
                av.VideoFrame.from_ndarray(frame.squeeze() if source == "gray" else frame, source),
                format=pixels,
                dst_colorspace=matrix,
                src_color_range=FULL,
                dst_color_range=colours,
                interpolation=ACCURATE,
            )
            coded.pts = index if ticks is None else ticks[index]
            coded.time_base = 1 / Fraction(rate)
            if not tagged:
                coded.colorspace, coded.color_range = 2, 0
            file.mux(track.encode(coded))
        file.mux(track.encode())
    return written.getvalue()


def lossless(film: VideoArray, **options: Any) -> bytes:
    """A video as WebM whose numbers are kept."""
    return video(film, "libvpx-vp9", "gbrp", form="webm", matrix=0, colours=FULL, options={"lossless": "1"}, **options)


def animation(film: VideoArray, form: str, duration: int | Sequence[int] = 40, **options: Any) -> bytes:
    """A video as GIF, PNG or WebP; GIF reduces it to 256 colours a frame."""
    images = [Image.fromarray(frame.squeeze() if frame.shape[2] == 1 else frame) for frame in film]
    if form == "GIF":
        images = [image.quantize(256) if image.mode == "RGB" else image for image in images]
    written = io.BytesIO()
    kinds = {"lossless": True, "exact": True, "minimize_size": False, "kmax": 0} if form == "WEBP" else {}
    images[0].save(
        written, form, save_all=True, append_images=images[1:], duration=duration, loop=0, **(kinds | options)
    )
    return written.getvalue()


def chunk(name: bytes, content: bytes) -> bytes:
    """A chunk of a PNG file."""
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))


def psnr(film: NDArray[Any], other: NDArray[Any]) -> float:
    error = np.mean((film.astype(np.float64) - other) ** 2)
    return float(10 * np.log10(255**2 / error)) if error else np.inf

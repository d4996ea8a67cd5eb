"""Reader of the videos that `app.images.video.writers` wrote."""

from collections.abc import Iterator
from pathlib import Path

import av
import numpy as np
from av.video.reformatter import ColorRange, Interpolation

from app.images.video.writers import Frame, view_rows

# Without these the library repeats chroma instead of interpolating it, and is a level too dark.
INTERPOLATED = Interpolation.BILINEAR | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INT


def read_video(path: Path) -> Iterator[Frame]:
    """Yield the frames, (H, W, C) uint8; C is 1 for a WebM video written from one channel, otherwise 3."""
    with av.open(path) as container:
        for frame in container.decode(video=0):
            if frame.format.name == "yuv420p" and frame.color_range == ColorRange.JPEG:
                yield view_rows(frame.planes[0])[: frame.height, : frame.width, None].copy()
            else:
                yield frame.to_ndarray(format="rgb24", interpolation=INTERPOLATED).astype(np.uint8, copy=False)


def read_first_frame(path: Path) -> Frame:
    """Read the first frame, (H, W, C) uint8, without decoding the others."""
    return next(read_video(path))

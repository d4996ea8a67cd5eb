"""Pictures and memory of the methods that join patches of a clip."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from app.errors import InvalidInputError
from app.images.png_writer import encode_png
from app.images.video.cube import VideoCube
from app.methods.context import Context
from app.methods.model import Fact, Picture, Size, Source
from app.methods.output.pictures import encode
from app.methods.output.videos import encode_texture, encoding_bytes
from app.methods.patchwork.limits import Reached
from app.synthesis.arrays import Ints, Real
from app.synthesis.patchwork.best_places import Matches
from app.synthesis.patchwork.cells import Cells, Window
from app.synthesis.patchwork.video_patchwork import frames_in_order

Painter = Callable[[Window], Callable[[int], Real]]  # of a window, then of a frame

IN_TIME = 3  # stream of random numbers; those before lay out the cells and draw or match their sources
HELD = 8  # frames at a time, in single precision: as many as threads are likely, and what each works with


def refuse_short(size: Size, frames: int, interval: int, longest: int) -> None:
    """Refuse a clip that is too short for an interval, with the longest that fits.

    Parameters
    ----------
    size : Size
        Of the clip.
    frames : int
        Of the output; an interval is never longer.
    interval, longest : int

    Raises
    ------
    InvalidInputError
        At ``parameters.interval``.
    """
    if min(interval, frames) > longest:
        raise InvalidInputError(
            f"A clip of {size.frames} frames is too short for {frames} frames with transitions every {interval}: take "
            f"an interval of at most {longest}, or a longer time range.",
            "parameters.interval",
        )


def textured(
    frame: Callable[[int], Real], shape: tuple[int, int, int], source: Source, context: Context
) -> Iterator[Picture]:
    """The files of a video texture; stages ``frames`` and ``encoding``.

    Parameters
    ----------
    frame : callable
        Makes the frame of a number, (H, W, C).
    shape : tuple of int
        Frames, height and width.
    source : Source
        The clip, whose rate and channels are the texture's.
    context : Context
    """
    frames, height, width = shape
    made = frames_in_order(frame, frames, context.threads, lambda part: context.progress("frames", part))
    yield from encode_texture(
        made,
        width=width,
        height=height,
        channels=source.size.channels,
        count=frames,
        rate=source.require_clip().rate,
        context=context,
    )


def average_picture(average: Real, context: Context) -> Picture:
    """The clip's mean over time, A(x), (H, W, C)."""
    return encode("average", "Average image of the clip", average, 255, context)


def cells_cube(painter: Painter, shape: tuple[int, int, int], context: Context) -> Picture:
    """The cells in their sources' colours, as a video cube; stage ``cells``."""
    frames, height, width = shape
    cube = VideoCube(width, height, 3, frames)
    bottom, right = painter(Window(height - 1, height, 0, width)), painter(Window(0, height, width - 1, width))
    painted = np.zeros((height, width, 3), np.uint8)
    for number in range(frames):
        context.progress("cells", number / frames)
        if number < frames - 1:
            painted[-1:], painted[:, -1:] = bottom(number), right(number)
        else:
            painted[:] = painter(Window(0, height, 0, width))(number)
        cube.add(painted)
    picture = cube.draw()
    return Picture(
        "cells", "Cells over time, coloured by source", picture.shape[1], picture.shape[0], encode_png(picture)
    )


def clip_bytes(size: Size) -> int:
    """Bytes of a clip."""
    return size.frames * size.channels * size.height * size.width


def patchwork_bytes(size: Size, joined: Reached) -> int:
    """Bytes that a two-stage synthesis holds at most, with the clip that has this size.

    The boxes of weights that end are at most 2r wide and overlap as often as that is more than a grid; sources may
    reach r over the border. Weights that do not end are slices of their table.
    """
    r, height, width = joined.edge, joined.height, joined.width
    margins = replace(size, width=size.width + 2 * r, height=size.height + 2 * r)
    average = clip_bytes(replace(margins, frames=1))
    weights = 0 if joined.all_cells else 4 * round((2 * r / joined.params.grid) ** 2 * height * width)
    held = clip_bytes(size) + clip_bytes(margins) + 16 * average + joined.table_bytes + weights
    return held + frames_bytes(size, height, width)


def frames_bytes(size: Size, height: int, width: int) -> int:
    """Bytes of what is held of frames of this size, with the channels of the clip, while they are made and encoded."""
    return HELD * 4 * size.channels * height * width + encoding_bytes(width, height, size.channels)


def cell_colours(cells: Cells, sources: Ints, places: Real) -> Real:
    """A colour for each cell, (count, 3): that of the middle of what it shows.

    Parameters
    ----------
    cells : Cells
    sources : ndarray of int64, shape (count, 2)
        q_i.
    places : ndarray of float32, shape (H, W, 3)
        A colour for every place of the sample. The middle of a cell that is cut off at the border may lie aside.
    """
    middle = sources + (cells.zones[:, ::2] + cells.zones[:, 1::2]) // 2
    y, x = middle.clip(0, np.array(places.shape[:2]) - 1).T
    colours: Real = places[y, x]
    return colours


def compared_pattern(pattern: Real, rescale: bool, peak: int, context: Context) -> Picture:
    """The pattern as it was compared with the texture, whose ``peak`` it has."""
    title = "Pattern with the texture's mean and range" if rescale else "Pattern as it is compared"
    return encode("pattern", title, pattern, peak, context)


def match_facts(matches: Matches, channels: int, peak: int) -> tuple[Fact, ...]:
    """How well cells match the pattern, how many they are, and from how many places."""
    error = np.sqrt(matches.errors.sum() / (matches.sizes.sum() * channels)) * (255 / peak)
    return (
        Fact("error", "Difference of the patches from the pattern, root mean square", float(error), "of 255"),
        Fact("cells", "Cells", len(matches.places)),
        Fact("sources", "Different places that they were taken from", len(np.unique(matches.places, axis=0))),
    )

"""`video-patchwork`: random patches of a clip, over time and over space."""

from collections.abc import Callable, Iterator, Sequence
from typing import Literal

import numpy as np
from pydantic import Field

from app.methods.context import Context
from app.methods.explanations.references import PATCHWORK
from app.methods.explanations.video_patchwork import EXPLANATION
from app.methods.model import Method, Picture, Size, Slot, Source
from app.methods.output.videos import encode_crop
from app.methods.outputs import SHOWN_CLIP, VIDEO_OUTPUTS, views
from app.methods.params import Resolved, SeamlessParams
from app.methods.patchwork.limits import (
    Reached,
    idle_reach,
    refuse_long_frames,
    refuse_small,
    summed,
)
from app.methods.patchwork.params import INTERVAL, grid_field, reach_field, sharpness_field
from app.methods.patchwork.pictures import (
    IN_TIME,
    Painter,
    average_picture,
    cells_cube,
    clip_bytes,
    frames_bytes,
    patchwork_bytes,
    refuse_short,
    textured,
)
from app.synthesis.arrays import Bytes, Real
from app.synthesis.patchwork.cells import random_numbers
from app.synthesis.patchwork.jittered_cells import jittered_cells, least_sample
from app.synthesis.patchwork.transitions import Transitions, longest_interval
from app.synthesis.patchwork.unbounded_cells import Reach, cells_with_reach, count_terms
from app.synthesis.patchwork.video_cells import FixedCells, source_colours
from app.synthesis.patchwork.video_mosaic import VideoMosaic, count_mosaic_terms, least_length, tile_bytes
from app.synthesis.patchwork.video_patchwork import PaddedClip, VideoPatchwork


class VideoPatchworkParams(SeamlessParams):
    """Parameters of the video patchwork."""

    grid: int = grid_field(
        64,
        "What is smaller than a patch is kept whole; the crop must hold a patch with its soft edges, at sharpness 6 "
        "about 3½ grids a side.",
    )
    interval: int = INTERVAL
    arrangement: Literal["fixed", "mosaic"] = Field(
        "fixed",
        title="Arrangement",
        description="'fixed': the same patches in all frames, each with transitions of its own in time, so that what "
        "stands still goes on standing still; 'mosaic': patches end in time as they do in space, so that everything "
        "comes and goes.",
    )
    sharpness: float = sharpness_field(6, advanced=True)
    reach: Reach = reach_field("all")


def check(sizes: Sequence[Size], resolved: Resolved[VideoPatchworkParams]) -> None:
    """Refuse a crop or a clip that does not hold the patches."""
    size, params, (frames, height, width) = sizes[0], resolved.params, resolved.shape
    if params.arrangement == "mosaic":
        refuse_small(size, params.grid, lambda grid: (least_length(width, grid), least_length(height, grid)))
        most = next(interval for interval in range(frames, 0, -1) if least_length(frames, interval) <= size.frames)
    else:
        refuse_small(size, params.grid, lambda grid: (least_sample(height, width, grid, params.sharpness),) * 2)
        most = longest_interval(size.frames, frames, params.loop)
    refuse_short(size, frames, params.interval, most)
    if summed(params):
        if params.arrangement == "mosaic":
            work = count_mosaic_terms((frames, height, width), params.grid, params.interval)
        else:
            work = count_terms(height, width, params.grid, params.sharpness, params.tileable)
        refuse_long_frames(work, height, width, frames)


def memory(sizes: Sequence[Size], resolved: Resolved[VideoPatchworkParams]) -> int:
    """The clip, as it came and as planes, the weights of the cells, and some frames."""
    size, params, height, width = sizes[0], resolved.params, resolved.height, resolved.width
    if params.arrangement == "fixed":
        return patchwork_bytes(size, Reached(params, height, width, params.tileable))
    return 2 * clip_bytes(size) + tile_bytes(height, width) + frames_bytes(size, height, width)


def run(sources: Sequence[Source], resolved: Resolved[VideoPatchworkParams], context: Context) -> Iterator[Picture]:
    """The video texture, its cells over time, the average image, and the crop."""
    (source,) = sources
    params, video, shape = resolved.params, source.require_clip().frames, resolved.shape
    context.progress("cells", 0)
    frame, painter = (_mosaic if params.arrangement == "mosaic" else _fixed)(video, shape, params)
    yield from textured(frame, shape, source, context)
    yield cells_cube(painter, shape, context)
    yield average_picture(video.mean(0, np.float32), context)
    yield from encode_crop(source, context)


def _fixed(
    video: Bytes, shape: tuple[int, int, int], params: VideoPatchworkParams
) -> tuple[Callable[[int], Real], Painter]:
    """The two-stage synthesis: what makes a frame, and what paints its cells."""
    frames, height, width = shape
    cells = jittered_cells(
        height, width, grid=params.grid, sharpness=params.sharpness, tileable=params.tileable, seed=params.seed
    )
    sources = cells.sources(video.shape[1], video.shape[2], params.seed)
    cells = cells_with_reach(cells, params.reach, tileable=params.tileable)
    transitions = Transitions(
        cells.count, len(video), frames, params.interval, loop=params.loop, rng=random_numbers(params.seed, IN_TIME)
    )
    clip = PaddedClip(video, cells.margin(sources, video.shape[1], video.shape[2]))
    mean = video.mean((0, 1, 2), np.float64).astype(np.float32)
    made = VideoPatchwork(clip, cells, sources, transitions, np.tile(mean, (cells.count, 1)))
    return made.frame, lambda window: FixedCells(cells, window, sources, transitions, video.shape[:3]).paint


def _mosaic(
    video: Bytes, shape: tuple[int, int, int], params: VideoPatchworkParams
) -> tuple[Callable[[int], Real], Painter]:
    """The three-dimensional mosaic: what makes a frame, and what paints its cells."""
    mosaic = VideoMosaic(
        PaddedClip(video).planes,
        shape,
        grid=params.grid,
        interval=params.interval,
        sharpness=params.sharpness,
        loop=params.loop,
        tileable=params.tileable,
        rng=random_numbers(params.seed, IN_TIME),
        reach=params.reach,
    )
    colours = source_colours(mosaic.sources, video.shape[:3])
    return mosaic.frame, lambda window: lambda number: mosaic.paint(number, window, colours)


VIDEO_PATCHWORK = Method(
    name="video-patchwork",
    title="Video patchwork",
    summary="Joins random patches of a clip, in time and in space, so that the joins keep its deviation.",
    inputs=(Slot("clip", "Clip", "The video whose texture is synthesised.", moving=True),),
    params=VideoPatchworkParams,
    references=(PATCHWORK,),
    explanation=EXPLANATION,
    check=check,
    idle=idle_reach,
    run=run,
    outputs=(*VIDEO_OUTPUTS, *views("cells", deep=False), *views("average", of=()), *SHOWN_CLIP),
    stages=lambda sizes, resolved: (("cells", 2), ("frames", 76), ("encoding", 8), ("cells", 4), ("crop", 10)),
    toroidal=lambda params: params.tileable,
    memory=memory,
)

"""`video-transfer`: a picture rendered in the patches of a clip."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from app.methods.context import Context
from app.methods.explanations.references import PATCHWORK
from app.methods.explanations.video_transfer import EXPLANATION
from app.methods.model import Method, Picture, Size, Slot, Source
from app.methods.output.pictures import encode
from app.methods.output.videos import encode_crop
from app.methods.outputs import SHOWN_CLIP, VIDEO_OUTPUTS, views
from app.methods.params import LoopParams, Resolved
from app.methods.patchwork.limits import (
    Reached,
    idle_reach,
    pattern_size,
    refuse_long_frames,
    refuse_long_search,
    refuse_other_size,
    refuse_small,
    search_bytes,
    summed,
)
from app.methods.patchwork.params import INTERVAL, RESCALE, candidates_field, grid_field, reach_field, sharpness_field
from app.methods.patchwork.pictures import (
    IN_TIME,
    average_picture,
    cells_cube,
    compared_pattern,
    patchwork_bytes,
    refuse_short,
    textured,
)
from app.methods.stages import Plan
from app.synthesis.arrays import Ints, Real
from app.synthesis.luminance import luminance
from app.synthesis.parallel import Team, Work
from app.synthesis.patchwork.cell_match import match_cells
from app.synthesis.patchwork.cells import Cells, random_numbers
from app.synthesis.patchwork.jittered_cells import jittered_cells, least_sample
from app.synthesis.patchwork.transfer import rescale
from app.synthesis.patchwork.transitions import Transitions, longest_interval
from app.synthesis.patchwork.unbounded_cells import Reach, cells_with_reach, count_terms
from app.synthesis.patchwork.video_cells import FixedCells
from app.synthesis.patchwork.video_patchwork import PaddedClip, VideoPatchwork

PEAK = 255  # of a clip's values


class VideoTransferParams(LoopParams):
    """Parameters of the video transfer."""

    grid: int = grid_field(
        16, "Smaller patches follow the pattern more closely, larger ones keep more of the clip's texture."
    )
    interval: int = INTERVAL
    candidates: int = candidates_field(
        "Among how many places of the clip, drawn at random, the one that is most like the pattern is taken for each "
        "patch; 0: among all. More follow the pattern more closely and repeat places more often."
    )
    rescale: bool = RESCALE
    sharpness: float = sharpness_field(2, advanced=True)
    reach: Reach = reach_field("near")


def check(sizes: Sequence[Size], resolved: Resolved[VideoTransferParams]) -> None:
    """Refuse a size that is not the pattern's, and a clip that does not hold the patches."""
    clip, pattern = sizes
    refuse_other_size(pattern, resolved)
    params, (frames, height, width) = resolved.params, resolved.shape
    refuse_small(clip, params.grid, lambda grid: (least_sample(height, width, grid, params.sharpness),) * 2)
    refuse_short(clip, frames, params.interval, longest_interval(clip.frames, frames, params.loop))
    refuse_long_search(clip, pattern, params.grid, params.candidates)
    if summed(params):
        refuse_long_frames(
            count_terms(height, width, params.grid, params.sharpness, tileable=False), height, width, frames
        )


def memory(sizes: Sequence[Size], resolved: Resolved[VideoTransferParams]) -> int:
    """That of the video patchwork, and the search."""
    clip, pattern = sizes
    joined = Reached(resolved.params, pattern.height, pattern.width, tileable=False)
    return patchwork_bytes(clip, joined) + search_bytes(replace(clip, frames=1), pattern)


def run(sources: Sequence[Source], resolved: Resolved[VideoTransferParams], context: Context) -> Iterator[Picture]:
    """The pattern as a video texture, its cells over time, the average image, the clip and the pattern."""
    clip, pattern = sources
    params, video, shape = resolved.params, clip.require_clip().frames, resolved.shape
    context.progress("cells", 0)
    cells = jittered_cells(*shape[1:], grid=params.grid, sharpness=params.sharpness, tileable=False, seed=params.seed)
    average = video.mean(0, np.float32)
    target = _with_channels(pattern.pixels * np.float32(PEAK / pattern.peak), average.shape[2])
    if params.rescale:
        target = rescale(target, average)
    places = _matched(average, target, cells, params, context)
    transitions = Transitions(
        cells.count, len(video), shape[0], params.interval, loop=params.loop, rng=random_numbers(params.seed, IN_TIME)
    )
    cells = cells_with_reach(cells, params.reach, tileable=False)
    margin = cells.margin(places, *video.shape[1:3])
    made = VideoPatchwork(PaddedClip(video, margin), cells, places, transitions)
    yield from textured(made.frame, shape, clip, context)
    yield cells_cube(
        lambda window: FixedCells(cells, window, places, transitions, video.shape[:3]).paint,
        shape,
        context,
    )
    yield average_picture(average, context)
    yield compared_pattern(target, params.rescale, PEAK, context)
    yield from encode_crop(clip, context)
    yield encode("crop-2", "Pattern", pattern.pixels, pattern.peak, context)


def _matched(average: Real, target: Real, cells: Cells, params: VideoTransferParams, context: Context) -> Ints:
    """The place of the clip for every cell, found in the average image."""
    with Team(context.threads) as team:
        matches = match_cells(
            average,
            target,
            cells,
            peak=PEAK,
            candidates=params.candidates,
            seed=params.seed,
            work=Work(team, context.progress),
        )
    return matches.places


def _with_channels(pixels: Real, channels: int) -> Real:
    """A pattern in grey for a clip in grey, and with equal channels for one in colour."""
    if pixels.shape[2] == channels:
        return pixels
    return luminance(pixels)[:, :, None] if channels == 1 else np.repeat(pixels, channels, axis=2)


STAGES: Plan = (("cells", 1), ("matching", 20), ("frames", 50), ("encoding", 8), ("cells", 8), ("crop", 13))

VIDEO_TRANSFER = Method(
    name="video-transfer",
    title="Video transfer",
    summary="Renders a picture in the patches of a clip whose average is most like it, moving as the clip does.",
    inputs=(
        Slot("clip", "Clip", "The video whose texture is used.", moving=True),
        Slot("pattern", "Pattern", "The picture that is rendered."),
    ),
    params=VideoTransferParams,
    references=(PATCHWORK,),
    explanation=EXPLANATION,
    check=check,
    idle=idle_reach,
    run=run,
    outputs=(
        *VIDEO_OUTPUTS,
        *views("cells", deep=False),
        *views("average", of=()),
        *views("pattern", of=("rescale",)),
        *SHOWN_CLIP,
        *views("crop-2", of=()),
    ),
    stages=lambda sizes, resolved: STAGES,
    size=pattern_size,
    toroidal=lambda params: False,
    memory=memory,
)

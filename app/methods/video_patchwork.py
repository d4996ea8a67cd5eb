"""`video-patchwork`: random patches of a clip, over time and over space."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from app.methods.announced import FILMS, SHOWN_CLIP, views
from app.methods.explanation import Exhibit, Explanation, Figure, Formula
from app.methods.films import crop_film
from app.methods.model import Context, Method, Picture, SeamlessParams, Size, Slot, Source
from app.methods.patches import LEAST_GRID, Reached, idle_reach, reach, refuse_long_frames, refuse_small, summed
from app.methods.references import PATCHWORK
from app.methods.video_patches import (
    IN_TIME,
    INTERVAL,
    Painter,
    Real,
    average_picture,
    cells_cube,
    film_bytes,
    frames_bytes,
    patchwork_bytes,
    refuse_short,
    sharpness,
    textured,
)
from app.synthesis.cells import jittered_cells, least_sample, random
from app.synthesis.transitions import Transitions, longest_interval
from app.synthesis.unbounded_cells import Reach, joined_cells, terms
from app.synthesis.video_cells import FixedCells, source_colours
from app.synthesis.video_mosaic import Mosaic, held_bytes, needed, products
from app.synthesis.video_patchwork import Clip, VideoPatchwork


class VideoPatchworkParams(SeamlessParams):
    """Parameters of the video patchwork."""

    grid: int = Field(
        64,
        ge=LEAST_GRID,
        le=1024,
        title="Grid",
        description="Pixels from one patch to the next, about. What is smaller than a patch is kept whole; the crop "
        "must hold a patch with its soft edges, at sharpness 6 about 3½ grids a side.",
    )
    interval: int = INTERVAL
    arrangement: Literal["fixed", "mosaic"] = Field(
        "fixed",
        title="Arrangement",
        description="'fixed': the same patches in all frames, each with transitions of its own in time, so that what "
        "stands still goes on standing still; 'mosaic': patches end in time as they do in space, so that everything "
        "comes and goes.",
    )
    sharpness: float = sharpness(6)
    reach: Reach = reach("all")


def check(sizes: Sequence[Size], params: VideoPatchworkParams) -> None:
    """Refuse a crop or a clip that does not hold the patches."""
    size, (frames, height, width) = sizes[0], _shape(sizes[0], params)
    if params.arrangement == "mosaic":
        refuse_small(size, params.grid, lambda grid: (needed(width, grid), needed(height, grid)))
        most = next(interval for interval in range(frames, 0, -1) if needed(frames, interval) <= size.frames)
    else:
        refuse_small(size, params.grid, lambda grid: (least_sample(height, width, grid, params.sharpness),) * 2)
        most = longest_interval(size.frames, frames, params.loop)
    refuse_short(size, frames, params.interval, most)
    if summed(params):
        if params.arrangement == "mosaic":
            work = products((frames, height, width), params.grid, params.interval)
        else:
            work = terms(height, width, params.grid, params.sharpness, params.tileable)
        refuse_long_frames(work, height, width, frames)


def memory(sizes: Sequence[Size], params: VideoPatchworkParams) -> int:
    """The clip, as it came and as planes, the weights of the cells, and some frames."""
    size, (_, height, width) = sizes[0], _shape(sizes[0], params)
    if params.arrangement == "fixed":
        return patchwork_bytes(size, Reached(params, height, width, params.tileable))
    return 2 * film_bytes(size) + held_bytes(height, width) + frames_bytes(size, height, width)


def run(sources: Sequence[Source], params: VideoPatchworkParams, context: Context) -> Iterator[Picture]:
    """The video texture, its cells over time, the average image, and the crop."""
    (source,) = sources
    check([source.size], params)
    assert source.film is not None
    film, shape = source.film.frames, _shape(source.size, params)
    context.progress("cells", 0)
    frame, painter = (_mosaic if params.arrangement == "mosaic" else _fixed)(film, shape, params)
    yield from textured(frame, shape, source, context)
    yield cells_cube(painter, shape, replace(context, progress=context.between(0.86, 0.9)))
    yield average_picture(film.mean(0, np.float32), context)
    yield from crop_film(source, replace(context, progress=context.between(0.9, 1)))
    context.progress("crop", 1)


def _shape(size: Size, params: VideoPatchworkParams) -> tuple[int, int, int]:
    return params.frames or size.frames, params.height or size.height, params.width or size.width


def _fixed(
    film: NDArray[np.uint8], shape: tuple[int, int, int], params: VideoPatchworkParams
) -> tuple[Callable[[int], Real], Painter]:
    """The two-stage synthesis: what makes a frame, and what paints its cells."""
    frames, height, width = shape
    cells = jittered_cells(
        height, width, grid=params.grid, sharpness=params.sharpness, tileable=params.tileable, seed=params.seed
    )
    sources = cells.sources(film.shape[1], film.shape[2], params.seed)
    cells = joined_cells(cells, params.reach, tileable=params.tileable)
    transitions = Transitions(
        cells.count, len(film), frames, params.interval, loop=params.loop, rng=random(params.seed, IN_TIME)
    )
    clip = Clip(film, cells.margin(sources, film.shape[1], film.shape[2]))
    mean = film.mean((0, 1, 2), np.float64).astype(np.float32)
    made = VideoPatchwork(clip, cells, sources, transitions, np.tile(mean, (cells.count, 1)))
    return made.frame, lambda window: FixedCells(cells, window, sources, transitions, film.shape[:3]).painted


def _mosaic(
    film: NDArray[np.uint8], shape: tuple[int, int, int], params: VideoPatchworkParams
) -> tuple[Callable[[int], Real], Painter]:
    """The three-dimensional mosaic: what makes a frame, and what paints its cells."""
    mosaic = Mosaic(
        Clip(film).planes,
        shape,
        grid=params.grid,
        interval=params.interval,
        sharpness=params.sharpness,
        loop=params.loop,
        tileable=params.tileable,
        rng=random(params.seed, IN_TIME),
        reach=params.reach,
    )
    colours = source_colours(mosaic.sources, film.shape[:3])
    return mosaic.frame, lambda window: lambda number: mosaic.painted(number, window, colours)


SKY = (("sky_pan", "0,0,320,320"),)
SAND = (("sand_under_water", "0,0,320,320"),)
LEAVES = (("leaves_under_water", "0,0,320,320"),)
SMOKE = (("advected_noise", "0,0,320,320"),)

EXPLANATION = Explanation(
    what=(
        "Patches of the clip are put together at random, as the method patchwork does with a photograph. Time could be "
        "one more dimension: blocks of the clip, each a patch with a beginning and an end, fill the video. But then "
        "what stands still in the clip, a stone under water, comes and goes in the video.",
        "So time is treated by itself. The same patches are there in all frames, and each shows a sequence of its own: "
        "the clip's frames in a new order. A sequence follows the clip for some frames and then passes over into "
        "another part of it; where, and into which, is drawn at random for every patch. In a loop the last transition "
        "leads back to the beginning.",
        "A cross-fade of two frames is duller than either, because their differences from the average cancel in part. "
        "In time as in space the sum of the differences is therefore divided so that the deviation of every pixel "
        "stays what it was; the average image, what stands still, is not changed by that.",
        "In the picture of the cells red and green say where in the crop a cell is taken from, blue when in the clip. "
        "Like a video cube it shows the last frame on top and time running upwards.",
    ),
    formulas=(
        Formula(
            r"N(x, t) = \frac{w_1 I(x, t - p_i + q_i) + w_2 I(x, t - p_{i+1} + q_{i+1}) - A(x)}"
            r"{\sqrt{w_1^2 + w_2^2}} + A(x)",
            r"The sequence of a cell: frames $q_i$ of the clip $I$ are put at frames $p_i$, and between $p_i$ and "
            r"$p_{i+1}$ one part of the clip passes over into the other. $A$ is the average image.",
        ),
        Formula(
            r"w_1 = \frac{1}{2} + \frac{1}{2} \cos(\pi u), \quad w_2 = \frac{1}{2} - \frac{1}{2} \cos(\pi u), \quad "
            r"u = \frac{t - p_i}{p_{i+1} - p_i}",
            r"The weights. As $w_1 + w_2 = 1$, a pixel that never changes stays as it is.",
        ),
        Formula(
            r"O(x, t) = \frac{\sum_i (N_i(x - p_i + q_i, t) - a)\, w_i(x)}{\sqrt{\sum_i w_i(x)^2}} + a, \qquad "
            r"w_i(x) = d(x, p_i)^{-f}",
            r"Then every frame is a patchwork of the sequences' frames, with the same points $p_i$ and $q_i$ of the "
            r"plane for all frames; $a$ is the mean colour of the clip and $d$ the distance. In the mosaic $d$ is a "
            r"distance in space and time, and $N_i$ the clip. All patches count, beyond the crop's border and the "
            r"clip's ends with their mirror image. With near ones alone, whose weights end (at three grids, in the "
            r"mosaic at $1.75$), a frame of the sand under water differs by 2.8 of 24 levels (root mean square) at "
            r"$f = 2$, by 0.6 at $f = 3$ and by 0.1 at $f = 4$; in the mosaic by 8.6, 3.6 and 1.6. From $f = 6$ on "
            r"near ones are what is computed.",
        ),
    ),
    fails=(
        "Patches stand still while what is in them moves, so a common movement shows them: clouds that all drift one "
        "way are born at one border of a patch and die at the other. Random phase noise in three dimensions, "
        "video-rpn, has no patches and drifts as one.",
        "What is larger than a patch is cut, and what lasts longer than an interval is faded out. Take a larger grid "
        "or a longer interval, for which the crop and the clip must be larger and longer.",
        "The deviation is kept on the assumption that patches have nothing to do with each other. In a short clip the "
        "two parts of a transition may show nearly the same frames, and then contrast rises for a moment.",
    ),
    figures=(
        Figure(
            "Clips without an end",
            "Sand and leaves under water, and the videos made of them. The sand and the leaves lie still, the light "
            "and the water play on, and the last frame continues in the first.",
            (
                Exhibit("video-patchwork", SAND, {"seed": 1}, ("crop", "texture")),
                Exhibit("video-patchwork", LEAVES, {"seed": 1}, ("crop", "texture")),
            ),
        ),
        Figure(
            "The clip's cube and the video's",
            "Water over sand, smoke and clouds, each as a block with time running upwards. What stands still makes "
            "upright lines, and goes on to do so; what drifts makes slanted ones, which end where patches do.",
            (
                Exhibit("video-patchwork", SAND, {"seed": 1}, ("crop-cube", "cube"), "Sand under water"),
                Exhibit("video-patchwork", SMOKE, {"seed": 1}, ("crop-cube", "cube"), "Advected noise"),
                Exhibit("video-patchwork", SKY, {"seed": 1}, ("crop-cube", "cube"), "Clouds that drift"),
            ),
        ),
        Figure(
            "Why patches stand still",
            "The cells of the two arrangements over time, and the sand that each makes. Fixed cells keep the sand "
            "where it is while the light plays on it; in the mosaic it changes into other sand again and again.",
            (
                Exhibit("video-patchwork", SAND, {"seed": 1}, ("cells", "cube"), "Fixed"),
                Exhibit("video-patchwork", SAND, {"seed": 1, "arrangement": "mosaic"}, ("cells", "cube"), "Mosaic"),
            ),
        ),
        Figure(
            "Patches that show",
            "Clouds drift through the crop as one. In the texture every patch drifts by itself, and its borders stand "
            "still: with smaller patches more of them.",
            (
                Exhibit("video-patchwork", SKY, {"seed": 2}, ("cube",), "Grid 64"),
                Exhibit("video-patchwork", SKY, {"seed": 2, "grid": 24}, ("cube",), "Grid 24"),
                Exhibit("video-rpn", SKY, {"seed": 2}, ("cube",), "Video RPN"),
            ),
        ),
    ),
)

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
    outputs=(*FILMS, *views("cells", deep=False), *views("average", of=()), *SHOWN_CLIP),
    toroidal=lambda params: params.tileable,
    memory=memory,
)

"""`patchwork`: random patches of the crop, joined invisibly."""

from collections.abc import Callable, Iterator, Sequence
from typing import Literal

import numpy as np
from pydantic import Field

from app.images.png_writer import PngWriter
from app.methods.context import Context, Progress
from app.methods.explanations.patchwork import EXPLANATION
from app.methods.explanations.references import PATCHWORK as REPORT
from app.methods.inputs import INPUTS
from app.methods.model import Fact, Method, Picture, Size, Source
from app.methods.output.pictures import coordinate_colours, crops, encode
from app.methods.outputs import shown_inputs, texture, views
from app.methods.params import ADVANCED, Resolved, StillParams
from app.methods.patchwork.limits import (
    BYTES_OF_CELL,
    Reached,
    idle_reach,
    refuse_long_sum,
    refuse_small,
    summed,
)
from app.methods.patchwork.params import grid_field, reach_field, sharpness_field
from app.methods.patchwork.pictures import cell_colours
from app.synthesis.arrays import Checkpoint, Ints, Real
from app.synthesis.parallel import Team, Work, row_blocks
from app.synthesis.patchwork.cells import Cells
from app.synthesis.patchwork.jittered_cells import jittered_cells, least_sample
from app.synthesis.patchwork.patchwork import BAND, TILE, Patchwork, band_rows, paint_cells
from app.synthesis.patchwork.unbounded_cells import Reach, cells_with_reach
from app.synthesis.sinks import Levels

BANDS = 4  # that are in work at once
DIMMED = np.float32(0.25)

Rows = Callable[[int, int, Checkpoint], Real]


class PatchworkParams(StillParams):
    """Parameters of patchwork."""

    grid: int = grid_field(
        64,
        "What is smaller than a patch is kept whole; a crop of many times the grid gives patches more places to come "
        "from. At sharpness 6 it must be 3½ times the grid.",
    )
    sharpness: float = sharpness_field(
        6,
        ". The higher, the more suddenly, and the less of the crop's border goes into joins; a very low one lets many "
        "patches overlap.",
    )
    blend: Literal["deviation", "feather", "sharp"] = Field(
        "deviation",
        title="Joins",
        description="'deviation' keeps the standard deviation where patches overlap, and with it the contrast; "
        "'feather' averages them, which is duller; 'sharp' cuts halfway between two centres. The last two are there to "
        "see what the first is for.",
        json_schema_extra=ADVANCED,
    )
    reach: Reach = reach_field("all")
    tileable: bool = Field(
        True,
        title="Tileable",
        description="Measure distances as on a torus, so that opposite borders meet and the texture tiles.",
    )


def check(sizes: Sequence[Size], resolved: Resolved[PatchworkParams]) -> None:
    """Refuse a crop that does not hold every cell with its blend zone, whatever the seed."""
    size, params, width, height = sizes[0], resolved.params, resolved.width, resolved.height
    refuse_small(size, params.grid, lambda grid: (least_sample(height, width, grid, params.sharpness),) * 2)
    refuse_long_sum(params, height, width, tileable=params.tileable)


def memory(sizes: Sequence[Size], resolved: Resolved[PatchworkParams]) -> int:
    """The crop three times over with its margin, the cells, their weights, what is in work, and the file."""
    size, params, width, height = sizes[0], resolved.params, resolved.width, resolved.height
    joined = Reached(params, height, width, params.tileable)
    crop = 8 * size.channels * size.width * size.height + joined.sample_bytes(size, size.channels)
    cells = BYTES_OF_CELL * (height // params.grid + 8) * (width // params.grid + 8) + joined.table_bytes
    return crop + cells + BANDS * BAND * 4 * (size.channels + 6) * (width + TILE) + 2 * size.channels * width * height


def run(sources: Sequence[Source], resolved: Resolved[PatchworkParams], context: Context) -> Iterator[Picture]:
    """The texture; then its cells, and where in the crop their sources lie."""
    source = sources[0]
    h = source.pixels
    params, height, width = resolved.params, resolved.height, resolved.width
    context.progress("cells", 0)
    cells = jittered_cells(
        height, width, grid=params.grid, sharpness=params.sharpness, tileable=params.tileable, seed=params.seed
    )
    context.progress("patches", 0)
    cells = cells_with_reach(cells, "all" if summed(params) else "near", tileable=params.tileable)
    made = Patchwork(h, cells, blend=params.blend, seed=params.seed)
    sources_of = made.sources
    with Team(context.threads) as team:

        def streamed(rows: Rows, channels: int, peak: float, progress: Progress) -> bytes:
            writer = PngWriter(width, height, channels, context.depth)
            levels = Levels(writer.write, channels, 0, peak, 2**context.depth - 1)
            work = Work(team, progress)
            blocks = row_blocks(height, band_rows(cells))
            work.run("texture", lambda block: levels(block[0], rows(*block, work.checkpoint)), blocks)
            return writer.finish()

        png = streamed(made.rows, h.shape[2], source.peak, context.progress)
        fact = Fact("cells", "Cells", cells.count)
        yield Picture("texture", "Texture", width, height, png, (fact,), kind="texture")
        del made, png
        step = context.during("views", (("cells", 3), ("pictures", 1)))
        step("cells", 0)
        places = coordinate_colours(*h.shape[:2])
        colours = cell_colours(cells, sources_of, places)
        soft = params.blend != "sharp"

        def paint(top: int, bottom: int, checkpoint: Checkpoint) -> Real:
            return paint_cells(cells, colours, top, bottom, soft=soft, checkpoint=checkpoint)

        png = streamed(paint, 3, 1, step.within("cells"))
        yield Picture("cells", "Cells, coloured by the place of their source", width, height, png)
    step("pictures", 0)
    yield _key(cells, sources_of, places, context)
    yield from crops(sources, context)


def _key(cells: Cells, sources: Ints, places: Real, context: Context) -> Picture:
    """The colours of the crop's places, dimmed where no cell shows them."""
    height, width, _ = places.shape
    top, bottom, left, right = (cells.cores + np.repeat(sources, 2, axis=1)).clip(0, [height, height, width, width]).T
    corners = np.zeros((height + 1, width + 1), np.int64)
    for y, x, sign in ((top, left, 1), (top, right, -1), (bottom, left, -1), (bottom, right, 1)):
        np.add.at(corners, (y, x), sign)
    shown = corners.cumsum(0).cumsum(1)[:-1, :-1] > 0
    picture = np.where(shown[:, :, None], places, places * DIMMED)
    fact = Fact("shown", "Part of the crop that cells show", 100 * float(shown.mean()), "%")
    title = "Colours of the crop's places, dark where no cell shows them"
    return encode("sources", title, picture, 1, context, facts=(fact,))


PATCHWORK = Method(
    name="patchwork",
    title="Patchwork (random patches)",
    summary="Lays random patches of the crop side by side, joined so that the joins cannot be seen.",
    inputs=INPUTS,
    params=PatchworkParams,
    references=(REPORT,),
    explanation=EXPLANATION,
    check=check,
    idle=idle_reach,
    run=run,
    outputs=(texture(), *views("cells", "sources"), *shown_inputs()),
    stages=lambda sizes, resolved: (("cells", 8), ("patches", 2), ("texture", 50), ("views", 40)),
    toroidal=lambda params: params.tileable,
    memory=memory,
)

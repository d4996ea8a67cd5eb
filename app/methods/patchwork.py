"""`patchwork`: random patches of the crop, joined invisibly."""

from collections.abc import Callable, Iterator, Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from app.images.png import PngWriter
from app.methods.announced import shown_inputs, texture, views
from app.methods.explanation import Exhibit, Explanation, Figure, Formula
from app.methods.model import Context, Fact, Method, Picture, Progress, Size, Source, StillParams
from app.methods.options import ADVANCED
from app.methods.patches import (
    BYTES_OF_CELL,
    LEAST_GRID,
    Reached,
    cell_colours,
    idle_reach,
    reach,
    refuse_long_sum,
    refuse_small,
    summed,
)
from app.methods.pictures import coordinate_colours, crops, encode, refuse_infinite
from app.methods.random_phase import INPUTS
from app.methods.references import PATCHWORK as REPORT
from app.synthesis.cells import Cells, jittered_cells, least_sample
from app.synthesis.field import row_blocks
from app.synthesis.levels import Levels
from app.synthesis.patchwork import BAND, TILE, Patchwork, band, painted
from app.synthesis.team import Team
from app.synthesis.unbounded_cells import Reach, joined_cells
from app.synthesis.work import Work

BANDS = 4  # that are in work at once
DIMMED = np.float32(0.25)

Real = NDArray[np.float32]
Rows = Callable[[int, int, Callable[[], None]], Real]


class PatchworkParams(StillParams):
    """Parameters of patchwork."""

    grid: int = Field(
        64,
        ge=LEAST_GRID,
        le=1024,
        title="Grid",
        description="Pixels from one patch to the next, about. What is smaller than a patch is kept whole; a crop of "
        "many times the grid gives patches more places to come from. At sharpness 6 it must be 3½ times the grid.",
    )
    sharpness: float = Field(
        6,
        ge=1,
        le=40,
        title="Sharpness f",
        description="How suddenly a patch gives way to its neighbour. The higher, the more suddenly, and the less of "
        "the crop's border goes into joins; a very low one lets many patches overlap.",
    )
    blend: Literal["deviation", "feather", "sharp"] = Field(
        "deviation",
        title="Joins",
        description="'deviation' keeps the standard deviation where patches overlap, and with it the contrast; "
        "'feather' averages them, which is duller; 'sharp' cuts halfway between two centres. The last two are there to "
        "see what the first is for.",
        json_schema_extra=ADVANCED,
    )
    reach: Reach = reach("all")
    tileable: bool = Field(
        True,
        title="Tileable",
        description="Measure distances as on a torus, so that opposite borders meet and the texture tiles.",
    )


def check(sizes: Sequence[Size], params: PatchworkParams) -> None:
    """Refuse a crop that does not hold every cell with its blend zone, whatever the seed."""
    size = sizes[0]
    width, height = params.width or size.width, params.height or size.height
    refuse_small(size, params.grid, lambda grid: (least_sample(height, width, grid, params.sharpness),) * 2)
    refuse_long_sum(params, height, width, tileable=params.tileable)


def memory(sizes: Sequence[Size], params: PatchworkParams) -> int:
    """The crop three times over with its margin, the cells, their weights, what is in work, and the file."""
    size = sizes[0]
    width, height = params.width or size.width, params.height or size.height
    joined = Reached(params, height, width, params.tileable)
    crop = 8 * size.channels * size.width * size.height + joined.sample_bytes(size, size.channels)
    cells = BYTES_OF_CELL * (height // params.grid + 8) * (width // params.grid + 8) + joined.table_bytes
    return crop + cells + BANDS * BAND * 4 * (size.channels + 6) * (width + TILE) + 2 * size.channels * width * height


def run(sources: Sequence[Source], params: PatchworkParams, context: Context) -> Iterator[Picture]:
    """The texture; then its cells, and where in the crop their sources lie."""
    source = sources[0]
    check([source.size], params)
    refuse_infinite(sources)
    h = source.pixels
    height, width = params.height or h.shape[0], params.width or h.shape[1]
    context.progress("cells", 0.0)
    cells = jittered_cells(
        height, width, grid=params.grid, sharpness=params.sharpness, tileable=params.tileable, seed=params.seed
    )
    context.progress("patches", 0.08)
    cells = joined_cells(cells, "all" if summed(params) else "near", tileable=params.tileable)
    made = Patchwork(h, cells, blend=params.blend, seed=params.seed)
    sources_of = made.sources
    with Team(context.threads) as team:

        def streamed(rows: Rows, channels: int, peak: float, progress: Progress) -> bytes:
            writer = PngWriter(width, height, channels, context.depth)
            levels = Levels(writer.write, channels, 0, peak, 2**context.depth - 1)
            work = Work(team, progress)
            blocks = row_blocks(height, band(cells))
            work.run("texture", lambda block: levels(block[0], rows(*block, work.alive)), blocks)
            return writer.finish()

        png = streamed(made.rows, h.shape[2], source.peak, context.between(0.1, 0.6))
        fact = Fact("cells", "Cells", cells.count)
        yield Picture("texture", "Texture", width, height, png, "texture", (fact,))
        del made, png
        context.progress("views", 0.6)
        places = coordinate_colours(*h.shape[:2])
        colours = cell_colours(cells, sources_of, places)
        soft = params.blend != "sharp"

        def paint(top: int, bottom: int, alive: Callable[[], None]) -> Real:
            return painted(cells, colours, top, bottom, soft=soft, alive=alive)

        png = streamed(paint, 3, 1, lambda stage, part: context.progress("views", 0.6 + 0.3 * part))
        yield Picture("cells", "Cells, coloured by the place of their source", width, height, png)
    yield _key(cells, sources_of, places, context)
    yield from crops(sources, context)
    context.progress("views", 1.0)


def _key(cells: Cells, sources: NDArray[np.int64], places: Real, context: Context) -> Picture:
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


BALLAST = (("ballast_railway", "96,96,320,320"),)
ROCK = (("rock_mountain", "0,0,512,512"),)
WALL = (("stonewall_rockwall", "0,0,512,512"),)
BRICKS = (("brick_gray", "0,0,512,512"),)
SKY = (("sky_clouds", "352,0,512,512"),)
WAVES = (("two_sinusoids", "0,0,256,256"),)
TWICE = {"width": 512, "height": 512, "seed": 1}

EXPLANATION = Explanation(
    what=(
        "Is copying random pieces of a sample all that it takes to make a texture? Harrison covers the texture with "
        "patches, each a piece of the crop from a random place, and looks for nothing: no patch is chosen to fit its "
        "neighbours. What makes it work is that the joins cannot be seen.",
        "The patches are Voronoi cells about the points of a jittered grid: irregular, because the eye finds regular "
        "patterns at once. Their edges are soft, and where two of them overlap the pixel is a weighted sum. Averaging "
        "two independent images leaves less contrast than either has, so a plain average, called feathering, shows as "
        "a dull seam. Here the sum of the deviations from the mean colour is divided by what keeps their "
        "*standard deviation* instead, and the join has the contrast of the crop.",
        "A patch may come from anywhere, as long as its blend zone (where it makes up more than a sixteenth of a "
        "pixel, by the weights of near patches) lies inside the crop. Of the faint rest, what would lie beyond the "
        "crop's border is read from the mirror image there.",
        "In the picture of the cells each wears the colour of the place that it shows, as in the key beside it; the "
        "key is dark where no cell shows the crop. At a centre the texture is the crop, pixel for pixel.",
    ),
    formulas=(
        Formula(
            r"w_i(x) = d(x, p_i)^{-f}",
            r"The weight of cell $i$ at the pixel $x$: a power of the distance to its centre $p_i$. The higher the "
            r"sharpness $f$, the harder the edge. If the texture is to tile, every cell of the plane counts once, by "
            r"the short way around the torus (on one of less than four grids a side also by other ways, up to two "
            r"grids); if not, cells up to three grids beyond the border take part as well. Left out are cells farther "
            r"away than 6 grids at $f \geq 3$, and than 44 at $f = 2$: all of them together are less than a hundredth "
            r"of the crop's standard deviation.",
        ),
        Formula(
            r"w_i(x) = \max\left(0, d(x, p_i)^{-f} - R^{-f}\right), \qquad R = 3 \text{ grids}",
            r"The same with *near* patches alone, a model of its own that takes little time at any size. From the sum "
            r"over all patches of a crop with a deviation of 36 levels it differs by 20 levels (root mean square) at "
            r"$f = 1$, by 4.5 at $f = 2$, 0.9 at $f = 3$ and 0.2 at $f = 4$; from $f = 6$ on by nothing that 8 bits "
            r"show, and it is what is computed there.",
        ),
        Formula(
            r"O(x) = \frac{\sum_i \left( I(x - p_i + q_i) - a \right) w_i(x)}{\sqrt{\sum_i w_i(x)^2}} + a",
            r"The texture: $I$ is the crop, $a$ its mean colour, and $q_i$ the random place in the crop that cell $i$ "
            r"shows. The patches are independent, so the variances of the terms add up, and the divisor gives the sum "
            r"the variance of the crop.",
        ),
        Formula(
            r"O_{\text{feather}}(x) = \frac{\sum_i I(x - p_i + q_i)\, w_i(x)}{\sum_i w_i(x)}",
            r"Feathering, for comparison: where two cells count as much as each other the deviation falls to "
            r"$1 / \sqrt{2}$ of the crop's.",
        ),
    ),
    fails=(
        "What is larger than a patch is cut: long cracks, large stones, rows of bricks. A larger grid keeps more of "
        "them, if the crop holds it; for arrangements that must fit together take Efros–Leung, which looks for what "
        "fits.",
        "Where light or colour change slowly across the crop, neighbouring patches differ as a whole and show as "
        "stains. Crop a more even region, or take random phase noise, which knows of no places.",
        "The divisor rests on patches that have nothing to do with each other. Where they happen to agree, as crests "
        "of a wave do, the sum is up to $\\sqrt{2}$ times too strong, and where they cancel too weak. For the same "
        "reason patches are better left to chance than chosen to match.",
        "A crop of hardly more than $3.5$ grids leaves few places to come from, and the same stone appears in many "
        "patches. Take a larger crop or a smaller grid.",
    ),
    figures=(
        Figure(
            "Three ways to join patches",
            "With the standard deviation kept, feathered, and cut sharply (figure 1 of the report). The first join "
            "cannot be found; feathering leaves grey mist between patches; sharp cuts break stones off.",
            tuple(
                Exhibit(
                    "patchwork",
                    BALLAST,
                    {"sharpness": 4, "blend": blend, "seed": 1},
                    ("crop", "texture") if blend == "deviation" else ("texture",),
                    label,
                )
                for blend, label in (("deviation", "deviation kept"), ("feather", "feathered"), ("sharp", "sharp"))
            ),
        ),
        Figure(
            "Shapes of patches",
            "The cells for three sharpnesses (figure 2 of the report), and what they make of the same sources.",
            tuple(
                Exhibit("patchwork", BALLAST, {"sharpness": f, "seed": 1}, ("cells", "texture"), f"f = {f}")
                for f in (2, 6, 20)
            ),
        ),
        Figure(
            "Structure that random phases lose",
            "Ledges and clefts are copied as they are, so they stay what they are, and one does not see where one "
            "piece ends and the next begins. Random phase noise keeps none of them.",
            (
                Exhibit("patchwork", ROCK, TWICE, label="patchwork"),
                Exhibit("rpn", ROCK, TWICE, ("texture",), "random phase noise"),
            ),
        ),
        Figure(
            "Three grids",
            "With a grid of 32 pixels the stones are broken up, with 128 most of them are whole; then there are few "
            "places that so large a patch can come from.",
            tuple(
                Exhibit(
                    "patchwork",
                    WALL,
                    {**TWICE, "grid": grid},
                    ("crop", "texture") if grid == 32 else ("texture",),
                    f"grid {grid}",
                )
                for grid in (32, 64, 128)
            ),
        ),
        Figure(
            "What must fit together",
            "Courses of bricks do not meet, and clouds from the bright and the dark part of the sky make stains.",
            (Exhibit("patchwork", BRICKS, TWICE), Exhibit("patchwork", SKY, TWICE)),
        ),
        Figure(
            "Patches that are not independent",
            "Two waves. Where crest meets crest a join is too strong, where crest meets trough it fades.",
            (Exhibit("patchwork", WAVES, TWICE, ("crop", "texture", "cells")),),
        ),
    ),
)

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
    toroidal=lambda params: params.tileable,
    memory=memory,
)

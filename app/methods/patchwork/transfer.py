"""`transfer`: a pattern rendered in patches of a texture."""

from collections.abc import Iterator, Sequence

import numpy as np

from app.methods.context import Context
from app.methods.explanations.references import PATCHWORK
from app.methods.explanations.transfer import EXPLANATION
from app.methods.inputs import alike
from app.methods.model import Method, Picture, Size, Slot, Source
from app.methods.output.pictures import coordinate_colours, crops, encode
from app.methods.outputs import shown_inputs, texture, views
from app.methods.params import WHOLE_IN_MEMORY, Resolved, StillParams
from app.methods.patchwork.limits import (
    BYTES_OF_CELL,
    Reached,
    idle_reach,
    pattern_size,
    refuse_long_search,
    refuse_long_sum,
    refuse_other_size,
    refuse_small,
    search_bytes,
)
from app.methods.patchwork.params import RESCALE, candidates_field, grid_field, reach_field, sharpness_field
from app.methods.patchwork.pictures import cell_colours, compared_pattern, match_facts
from app.methods.stages import Plan
from app.synthesis.parallel import Team, Work, row_blocks
from app.synthesis.patchwork.jittered_cells import jittered_cells, least_sample
from app.synthesis.patchwork.patchwork import paint_cells
from app.synthesis.patchwork.transfer import rescale, transfer
from app.synthesis.patchwork.unbounded_cells import Reach, cells_with_reach

BYTES_OF_PATTERN = 8  # for each value, beside the search
STAGES: Plan = (("cells", 5), ("matching", 65), ("averages", 8), ("texture", 12), ("cells", 6), ("views", 4))


class TransferParams(StillParams):
    """Parameters of the texture transfer."""

    grid: int = grid_field(
        16,
        "Smaller patches follow the pattern more closely, larger ones keep more of the texture. At sharpness 2 the "
        "texture must be five times the grid at least, and better twenty times.",
    )
    sharpness: float = sharpness_field(
        2, ": 2 blends them widely, as brush strokes do, 20 cuts them like the pieces of a mosaic."
    )
    candidates: int = candidates_field(
        "How many places of the texture, drawn at random, are compared with each patch of the pattern; the best is "
        "taken. More follow the pattern more closely, take longer, and repeat the same places more often. 0: all "
        "places."
    )
    rescale: bool = RESCALE
    reach: Reach = reach_field("near")


def check(sizes: Sequence[Size], resolved: Resolved[TransferParams]) -> None:
    """Refuse another size than the pattern's, a texture that does not hold the patches, and too long a search."""
    texture, pattern = sizes
    refuse_other_size(pattern, resolved)
    params, height, width = resolved.params, resolved.height, resolved.width
    refuse_small(texture, params.grid, lambda grid: (least_sample(height, width, grid, params.sharpness),) * 2)
    refuse_long_search(texture, pattern, params.grid, params.candidates)
    refuse_long_sum(params, height, width, tileable=False)


def memory(sizes: Sequence[Size], resolved: Resolved[TransferParams]) -> int:
    """Both pictures, the search and the result."""
    texture, pattern = sizes
    params = resolved.params
    channels, grid = max(texture.channels, pattern.channels), params.grid
    cells = (pattern.width // grid + 8) * (pattern.height // grid + 8)
    joined = Reached(params, pattern.height, pattern.width, tileable=False)
    rendered = BYTES_OF_PATTERN * channels * pattern.width * pattern.height
    held = search_bytes(texture, pattern) + joined.sample_bytes(texture, channels) + joined.table_bytes
    return held + rendered + BYTES_OF_CELL * cells


def run(sources: Sequence[Source], resolved: Resolved[TransferParams], context: Context) -> Iterator[Picture]:
    """The pattern in the texture, where its patches come from, their averages, and what they were compared with."""
    params = resolved.params
    texture, pattern = alike(sources)
    peak = sources[0].peak
    context.progress("cells", 0)
    height, width, channels = pattern.shape
    cells = jittered_cells(
        height, width, grid=params.grid, sharpness=params.sharpness, tileable=False, seed=params.seed
    )
    if params.rescale:
        pattern = rescale(pattern, texture)
    with Team(context.threads) as team:
        made = transfer(
            texture,
            pattern,
            cells,
            reach=params.reach,
            peak=peak,
            candidates=params.candidates,
            seed=params.seed,
            work=Work(team, context.progress),
        )
        facts = match_facts(made.matches, channels, peak)
        yield encode("texture", "Texture", made.output, peak, context, kind="texture", facts=facts)
        context.progress("cells", 0)
        colours = cell_colours(cells, made.matches.places, coordinate_colours(*texture.shape[:2]))
        picture = np.empty((height, width, 3), np.float32)
        joined = cells_with_reach(cells, params.reach, tileable=False)
        work = Work(team, context.progress)

        def paint(rows: tuple[int, int]) -> None:
            picture[slice(*rows)] = paint_cells(joined, colours, *rows, checkpoint=work.checkpoint).transpose(1, 2, 0)

        work.run("cells", paint, row_blocks(height))
    yield encode("cells", "Cells, coloured by the place of their source", picture, 1, context)
    context.progress("views", 0)
    yield encode("average", "Averages of the patches", made.average, peak, context)
    yield compared_pattern(pattern, params.rescale, peak, context)
    yield from crops(sources, context)


TRANSFER = Method(
    name="transfer",
    title="Texture transfer (patchwork)",
    summary="Renders a picture in patches of a texture, each chosen for being like the picture there.",
    inputs=(
        Slot("texture", "Texture", "What to render in: a painting, a bark, a wall. It needs lights and darks."),
        Slot("pattern", "Pattern", "The picture to render; the result has its size."),
    ),
    params=TransferParams,
    references=(PATCHWORK,),
    explanation=EXPLANATION,
    check=check,
    idle=idle_reach,
    run=run,
    outputs=(
        texture(),
        *views("cells", "average"),
        *views("pattern", of=("rescale",)),
        *shown_inputs(2, least=2),
    ),
    stages=lambda sizes, resolved: STAGES,
    size=pattern_size,
    toroidal=lambda params: False,
    most_pixels=WHOLE_IN_MEMORY,
    memory=memory,
)

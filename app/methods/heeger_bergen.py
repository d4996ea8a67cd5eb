"""`heeger-bergen`: pyramid-based texture synthesis."""

from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from app.errors import InvalidInputError
from app.methods.explanation import Exhibit, Explanation, Figure, Formula
from app.methods.model import Context, Fact, Method, Picture, Size, Source, StillParams
from app.methods.options import ADVANCED
from app.methods.pictures import crops, encode, refuse_infinite
from app.methods.random_phase import INPUTS
from app.methods.references import HEEGER_BERGEN as ARTICLE
from app.methods.references import IPOL_HEEGER_BERGEN, PERIODIC_PLUS_SMOOTH, STEERABLE_PYRAMID
from app.synthesis.heeger_bergen import Channel, Decomposition, Sample, Synthesis
from app.synthesis.pyramid import Band, SteerablePyramid
from app.synthesis.team import Team
from app.synthesis.work import Work

VIEW = 512  # pixels of a side of the views of iterations, at most
CELL = 256  # and of one sub-band's
GAP = 4  # between the sub-bands

Real = NDArray[np.float32]


class HeegerBergenParams(StillParams):
    """Parameters of Heeger and Bergen's method."""

    scales: int = Field(
        4,
        ge=1,
        le=8,
        title="Scales",
        description="How many sizes of detail are told apart, each twice as coarse as the one before. More keep "
        "larger features; S scales need a crop and a texture of at least 2^S pixels a side.",
    )
    orientations: int = Field(
        4,
        ge=1,
        le=8,
        title="Orientations",
        description="How many directions are told apart at each scale. More make the texture follow the sample's "
        "directions more closely; 1 makes it forget them.",
    )
    iterations: int = Field(
        5,
        ge=1,
        le=20,
        title="Iterations",
        description="How often the histograms of the sub-bands and of the pixels are matched in turn. Little changes "
        "after 5.",
    )
    edges: Literal["periodic", "mirror"] = Field(
        "periodic",
        title="Edges",
        description="What becomes of the crop's borders, which do not match: 'periodic' takes the crop's periodic "
        "component; 'mirror' surrounds the crop by its mirror images, and keeps slow changes of light and colour.",
        json_schema_extra=ADVANCED,
    )
    add_smooth: bool = Field(
        False,
        title="Add the smooth component",
        description="Put the slow changes of light and colour across the crop, which periodic edges take out before "
        "the synthesis, back in afterwards. Only for a texture of the crop's own size; it then no longer tiles "
        "without a seam.",
        json_schema_extra=ADVANCED,
    )


def check(sizes: Sequence[Size], params: HeegerBergenParams) -> None:
    """Refuse more scales than fit, and a smooth component that there is none of or that does not fit."""
    size = sizes[0]
    width, height = params.width or size.width, params.height or size.height
    for what, sides in (("crop", (size.width, size.height)), ("texture", (width, height))):
        if min(sides) < 2**params.scales:
            fitting = min(sides).bit_length() - 1
            raise InvalidInputError(
                f"{params.scales} scales need at least {2**params.scales} pixels a side, and the {what} has "
                f"{sides[0]} × {sides[1]}: "
                + (f"take at most {fitting} scales, or a larger {what}." if fitting else f"take a larger {what}."),
                "parameters.scales",
            )
    if params.add_smooth and params.edges != "periodic":
        raise InvalidInputError(
            "Only periodic edges take the smooth component out of the crop: take those, or do not add it.",
            "parameters.add_smooth",
        )
    if params.add_smooth and (width, height) != (size.width, size.height):
        raise InvalidInputError(
            f"The smooth component has the crop's own size, {size.width} × {size.height} pixels, and cannot be added "
            f"to a texture of {width} × {height}.",
            "parameters.add_smooth",
        )


def run(sources: Sequence[Source], params: HeegerBergenParams, context: Context) -> Iterator[Picture]:
    """The texture, how it came about, and the sub-bands of sample and texture."""
    source = sources[0]
    height, width, channels = source.pixels.shape
    check([Size(width, height, channels)], params)
    refuse_infinite(sources)
    height, width = params.height or height, params.width or width
    decomposition = Decomposition(params.scales, params.orientations, params.edges)
    pyramid = SteerablePyramid(height, width, params.scales, params.orientations)
    ends = {"sample": 0.1, "noise": 0.14}
    ends |= {_stage(number): 0.14 + 0.74 * number / params.iterations for number in range(1, params.iterations + 1)}
    begins = dict(zip(ends, (0.0, *ends.values()), strict=False))
    views = {}
    with Team(context.threads) as team:
        work = Work(team, lambda stage, part: context.between(begins[stage], ends[stage])(stage, part))
        sample = Sample(source.pixels, decomposition, pyramid, work)
        synthesis = Synthesis(sample, pyramid, params.seed, work)
        views["noise", "Noise with the crop's histogram"] = synthesis.planes(VIEW)
        for number in range(1, params.iterations + 1):
            synthesis.iterate(_stage(number))
            if number < params.iterations and number.bit_count() == 1:
                views[f"iteration-{number}", f"After iteration {number}"] = synthesis.planes(VIEW)
    texture = synthesis.planes()
    if params.add_smooth and sample.smooth is not None:
        texture += sample.smooth
    context.progress("texture", 0.88)
    yield encode("texture", "Texture", _pixels(texture), source.peak, context, kind="texture")
    del texture
    context.progress("crop", 0.92)
    yield from crops(sources, context)
    context.progress("iterations", 0.94)
    for (name, title), planes in views.items():
        yield encode(name, title, _pixels(planes), source.peak, context)
    context.progress("sub-bands", 0.96)
    bands = Channel(sample.channels[0], decomposition)
    title = "Sub-bands of the crop's first principal component"
    yield encode("crop-bands", title, _mosaic(bands, pyramid), 1, context, facts=_shares(sample))
    context.progress("sub-bands", 0.98)
    bands = Channel(synthesis.channels[0], Decomposition(params.scales, params.orientations))
    title = "Sub-bands of the texture's first principal component"
    distance = 100 * float(np.mean(list(synthesis.distances().values())))
    fact = Fact("distance", "Distance of the sub-bands' histograms, on average", distance, "% of their deviation")
    yield encode("texture-bands", title, _mosaic(bands, pyramid), 1, context, facts=(fact,))
    context.progress("sub-bands", 1.0)


def _stage(iteration: int) -> str:
    return f"iteration {iteration}"


def _pixels(planes: Real) -> Real:
    return planes.transpose(1, 2, 0)


def _shares(sample: Sample) -> tuple[Fact, ...]:
    """How the variance is shared out over the principal components."""
    variances = sample.space.variances
    shares = 100 * variances / (variances.sum() or 1)
    return tuple(
        Fact(f"component-{number}", f"Variance along principal component {number}", float(share), "%")
        for number, share in enumerate(shares, 1)
    )


def _mosaic(channel: Channel, pyramid: SteerablePyramid) -> Real:
    """The bands' upper left corners: a row for each scale, a column for each orientation, the residuals below.

    Coarse bands are enlarged to the image's scale. Mid-grey is a band's mean, black and white are three deviations
    from it.
    """
    rows = [[Band(scale, number) for number in range(pyramid.orientations)] for scale in range(pyramid.scales)]
    rows.append([pyramid.bands[0], pyramid.bands[-1]])
    size = channel.band(pyramid.bands[0]).shape
    high, wide = (min(side, CELL) + GAP for side in size)
    mosaic = np.full((len(rows) * high, max(2, pyramid.orientations) * wide), 0.5, np.float32)
    for row, bands in enumerate(rows):
        for column, band in enumerate(bands):
            values = channel.band(band)
            y, x = (np.arange(min(side, CELL)) * n // side for side, n in zip(size, values.shape, strict=True))
            cell = (values[np.ix_(y, x)] - values.mean()) / (6 * values.std() or 1) + 0.5
            mosaic[row * high :, column * wide :][: len(y), : len(x)] = cell
    return mosaic[:-GAP, :-GAP]


EXPLANATION = Explanation(
    what=("Words.",),
    formulas=(Formula("x", "x."),),
    fails=("Words.",),
    figures=(
        Figure("F", "C.", (Exhibit("heeger-bergen", (("gravel_gray", "96,96,256,256"),), {"seed": 1}),)),
        Figure("G", "C.", (Exhibit("heeger-bergen", (("tiles02", "0,0,256,256"),), {"seed": 1}),)),
    ),
)

HEEGER_BERGEN = Method(
    name="heeger-bergen",
    title="Heeger–Bergen (pyramid histograms)",
    summary="Matches the histograms of noise, and of its sub-bands by scale and orientation, to those of the crop.",
    inputs=INPUTS,
    params=HeegerBergenParams,
    references=(ARTICLE, IPOL_HEEGER_BERGEN, STEERABLE_PYRAMID, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    check=check,
    run=run,
    toroidal=lambda params: not params.add_smooth,
)

"""`heeger-bergen`: pyramid-based texture synthesis."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Literal

from pydantic import Field

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.explanations.heeger_bergen import EXPLANATION
from app.methods.explanations.references import HEEGER_BERGEN as ARTICLE
from app.methods.explanations.references import IPOL_HEEGER_BERGEN, PERIODIC_PLUS_SMOOTH, STEERABLE_PYRAMID
from app.methods.inputs import INPUTS, refuse_other_size
from app.methods.model import Fact, Method, Picture, Size, Source
from app.methods.output.pictures import crops, encode
from app.methods.outputs import OutputSpec, shown_inputs, texture, views
from app.methods.params import ADD_SMOOTH, ADVANCED, Resolved, StillParams
from app.methods.pyramid.sub_bands import mosaic
from app.methods.stages import Plan
from app.synthesis.arrays import Real
from app.synthesis.fourier.periodic import smooth_planes
from app.synthesis.parallel import Team, Work
from app.synthesis.pyramid.heeger_bergen import Decomposition, SampleStatistics, Synthesis
from app.synthesis.pyramid.pyramid import SteerablePyramid

VIEW = 512  # pixels of a side of the views of iterations, at most
MEMORY = 1_600_000_000  # bytes, so that the process stays within a worker's default of 2 GiB
TEXTURE_BYTES, CROP_BYTES, MIRROR_BYTES = 37, 27, 77  # for each value, measured at 4096² in colour


class HeegerBergenParams(StillParams):
    """Parameters of Heeger and Bergen's method."""

    scales: int = Field(
        4,
        ge=1,
        le=8,
        title="Scales",
        description="How many sizes of detail are distinguished, each twice as coarse as the one before. More keep "
        "larger features; S scales need a crop and a texture of at least 2^S pixels a side.",
    )
    orientations: int = Field(
        4,
        ge=1,
        le=8,
        title="Orientations",
        description="How many directions are distinguished at each scale. More make the texture follow the sample's "
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
        description="How the crop's borders, which do not match, are treated: 'periodic' takes the crop's periodic "
        "component; 'mirror' surrounds the crop by its mirror images, and keeps slow changes of light and colour.",
        json_schema_extra=ADVANCED,
    )
    add_smooth: bool = ADD_SMOOTH


def check(sizes: Sequence[Size], resolved: Resolved[HeegerBergenParams]) -> None:
    """Refuse more scales than fit, and a smooth component that there is none of or that does not fit."""
    size = sizes[0]
    params, width, height = resolved.params, resolved.width, resolved.height
    for what, sides in (("crop", (size.width, size.height)), ("texture", (width, height))):
        if min(sides) < 2**params.scales:
            fitting = min(sides).bit_length() - 1
            raise InvalidInputError(
                f"{params.scales} scales need at least {2**params.scales} pixels a side, and the {what} has "
                f"{sides[0]} × {sides[1]}: "
                + (f"take at most {fitting} scales, or a larger {what}." if fitting else f"take a larger {what}."),
                "parameters.scales",
            )
    _refuse_too_large(size, width * height, params)
    if params.add_smooth and params.edges != "periodic":
        raise InvalidInputError(
            "Choose periodic edges, or do not add the smooth component: no other edges take it out of the crop.",
            "parameters.add_smooth",
        )
    if params.add_smooth:
        refuse_other_size(size, resolved)


def _refuse_too_large(size: Size, pixels: int, params: HeegerBergenParams) -> None:
    of_crop = MIRROR_BYTES if params.edges == "mirror" else CROP_BYTES
    needed = size.channels * (of_crop * size.width * size.height + TEXTURE_BYTES * pixels)
    if needed > MEMORY:
        raise InvalidInputError(
            f"The sub-bands of crop and texture are held in memory, and these would take {needed / 1e9:.1f} of the "
            f"{MEMORY / 1e9:.1f} GB there are: take a smaller crop, or a smaller width and height.",
            "parameters.width",
        )


def run(sources: Sequence[Source], resolved: Resolved[HeegerBergenParams], context: Context) -> Iterator[Picture]:
    """The texture, how it came about, and the sub-bands of sample and texture."""
    source = sources[0]
    params, height, width = resolved.params, resolved.height, resolved.width
    context.progress("sample", 0)
    decomposition = Decomposition(params.scales, params.orientations, params.edges)
    pyramid = SteerablePyramid(height, width, params.scales, params.orientations)
    bands = context.during("sub-bands", (("crop", 1), ("texture", 1), ("distances", 1)))
    views = {}
    with Team(context.threads) as team:
        work = Work(team, lambda stage, part: (bands if stage == "distances" else context.progress)(stage, part))
        sample = SampleStatistics(source.pixels, decomposition, pyramid, work)
        synthesis = Synthesis(sample, pyramid, params.seed, work)
        views["noise", "Noise with the crop's histogram"] = synthesis.planes(VIEW)
        for number in range(1, params.iterations + 1):
            synthesis.iterate(_stage(number))
            if number < params.iterations and number.bit_count() == 1:
                views[f"iteration-{number}", f"After iteration {number}"] = synthesis.planes(VIEW)
        texture = synthesis.planes()
        if params.add_smooth:
            texture += smooth_planes(source.pixels, context.threads)
        context.progress("texture", 0)
        yield encode("texture", "Texture", _pixels(texture), source.peak, context, kind="texture")
        del texture
        context.progress("crop", 0)
        yield from crops(sources, context)
        context.progress("iterations", 0)
        for (name, title), planes in views.items():
            yield encode(name, title, _pixels(planes), source.peak, context)
        picture = mosaic(sample.channels[0], decomposition, bands.within("crop"))
        title = "Sub-bands of the crop's first principal component"
        yield encode("crop-bands", title, picture, 1, context, facts=_shares(sample))
        picture = mosaic(synthesis.channel(0), replace(decomposition, edges="periodic"), bands.within("texture"))
        title = "Sub-bands of the texture's first principal component"
        distances = synthesis.distances("distances")
        distance = 100 * sum(distances.values()) / len(distances)
        fact = Fact("distance", "Distance of the sub-bands' histograms, on average", distance, "% of their deviation")
        yield encode("texture-bands", title, picture, 1, context, facts=(fact,))


def stages(sizes: Sequence[Size], resolved: Resolved[HeegerBergenParams]) -> Plan:
    """One for each iteration, between preparing it and showing what came of it."""
    iterations = tuple((_stage(number), 13) for number in range(1, resolved.params.iterations + 1))
    return (
        ("sample", 10),
        ("noise", 4),
        *iterations,
        ("texture", 4),
        ("crop", 2),
        ("iterations", 2),
        ("sub-bands", 12),
    )


def _stage(iteration: int) -> str:
    return f"iteration {iteration}"


def _pixels(planes: Real) -> Real:
    return planes.transpose(1, 2, 0)


def _shares(sample: SampleStatistics) -> tuple[Fact, ...]:
    """How the variance is shared out over the principal components."""
    variances = sample.space.variances
    shares = 100 * variances / (variances.sum() or 1)
    return tuple(
        Fact(f"component-{number}", f"Variance along principal component {number}", float(share), "%")
        for number, share in enumerate(shares, 1)
    )


_MATCHED = "scales", "orientations", "edges"
_HISTORY = "iterations", *_MATCHED


def _iteration(number: int) -> OutputSpec:
    name, words = f"iteration-{number}", f"“Iterations” is more than {number}"
    return OutputSpec(name, of=_HISTORY, applies=lambda params, inputs: params.iterations > number, condition=words)


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
    outputs=(
        texture(),
        *shown_inputs(),
        *views("noise", of=("edges",)),
        *map(_iteration, (1, 2, 4, 8, 16)),
        *views("crop-bands", of=_MATCHED),
        *views("texture-bands", of=_HISTORY),
    ),
    stages=stages,
    toroidal=lambda params: not params.add_smooth,
)

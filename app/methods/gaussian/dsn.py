"""`dsn`: discrete spot noise."""

from collections.abc import Iterator, Mapping, Sequence
from math import ceil
from typing import Literal

import numpy as np
from pydantic import Field

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.explanations.dsn import EXPLANATION
from app.methods.explanations.references import IPOL_RPN, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES, SPOT_NOISE
from app.methods.gaussian.params import SpotParams, not_extended
from app.methods.inputs import INPUTS
from app.methods.model import Fact, Method, Picture, Size, Source
from app.methods.output.pictures import crops, encode
from app.methods.outputs import shown_inputs, texture, views
from app.methods.params import WHOLE_IN_MEMORY, Resolved
from app.methods.stages import Plan
from app.synthesis.arrays import Ints, Real
from app.synthesis.fourier.spot import Spot
from app.synthesis.fourier.spot_noise import sample_spot
from app.synthesis.gaussian.adsn import adsn_of_spot
from app.synthesis.gaussian.dsn import counts, dsn, excess_kurtosis, spot_shape, standard_spot

ORDERS = (10, 100, 1000, 10_000, 100_000)
DEVIATIONS = 3  # of a standard spot's noise, from mid-grey to black and to white


class DsnParams(SpotParams):
    """Parameters of the discrete spot noise."""

    order: int = Field(
        100,
        ge=1,
        le=10**9,
        title="Order n",
        description="How many copies of the spot are thrown. With few of them one sees each; with very many the "
        "texture cannot be told from its limit, the asymptotic discrete spot noise. It takes the same time for any n.",
    )
    spot: Literal["sample", "disc", "gaussian"] = Field(
        "sample",
        title="Spot",
        description="What is thrown: the crop ('sample'), or a shape that shows the model bare, in grey: a white disc "
        "('disc') or a Gaussian blot ('gaussian').",
    )
    radius: float = Field(
        8.0,
        ge=0.5,
        le=1024,
        title="Radius",
        description="Radius of the disc in pixels; the Gaussian's standard deviation is half of it. Not used when the "
        "spot is the sample.",
    )
    convergence: bool = Field(
        False,
        title="Convergence",
        description="Make a gallery besides: n = 10, 100, 1000, 10 000, 100 000, and the limit. Every picture has the "
        "points of the one before and more.",
    )


def check(sizes: Sequence[Size], resolved: Resolved[DsnParams]) -> None:
    """Refuse a shape that does not fit into the texture."""
    params, width, height = resolved.params, resolved.width, resolved.height
    if params.spot != "sample" and 2 * params.radius + 1 > min(width, height):
        raise InvalidInputError(
            f"A spot of radius {params.radius:g} does not fit into a texture of {width} × {height} pixels: choose a "
            f"smaller radius, or a texture of at least {ceil(2 * params.radius + 1)} pixels each way.",
            "parameters.radius",
        )


def run(sources: Sequence[Source], resolved: Resolved[DsnParams], context: Context) -> Iterator[Picture]:
    """Make the texture, the gallery of its convergence if that is on, and pictures of the spot and its points."""
    source = sources[0]
    params, height, width = resolved.params, resolved.height, resolved.width
    context.progress("spot", 0)
    spot = _spot(source, height, width, params, context)
    kurtosis = float(excess_kurtosis(spot).mean())

    def picture(name: str, title: str, values: Real, order: float) -> Picture:
        fact = Fact("excess-kurtosis", "Excess kurtosis of a pixel's law (0 for a Gaussian)", kurtosis / order)
        return encode(name, title, values, source.peak, context, kind="texture", facts=(fact,))

    def made(order: int) -> Real:
        return dsn(spot, order, seed=params.seed, threads=context.threads, progress=context.progress)

    yield picture("texture", "Texture", made(params.order), params.order)
    if params.convergence:
        for order in ORDERS:
            yield picture(f"dsn-{order}", f"n = {order:,}".replace(",", "\N{NO-BREAK SPACE}"), made(order), order)
        values = adsn_of_spot(spot, params.seed, context.threads, context.progress)
        yield picture("adsn", "The limit: asymptotic discrete spot noise", values, np.inf)
    context.progress("spot", 0)
    yield from crops(sources, context)
    context.progress("spot", 0.5)
    if params.spot == "sample":
        yield encode("spot", "Spot", spot.rows(0, height).transpose(1, 2, 0), source.peak, context)
    else:
        yield encode("spot", "Spot", spot_shape(params.spot, height, width, params.radius), 1, context)
    context.progress("points", 0)
    yield _points(counts(height, width, params.order, params.seed), context)


def stages(sizes: Sequence[Size], resolved: Resolved[DsnParams]) -> Plan:
    """The points of every order and the texture of them; the last texture, the limit, has no points."""
    thrown = (("points", 2), ("texture", 5))
    gallery = (*len(ORDERS) * thrown, ("texture", 5)) if resolved.params.convergence else ()
    return (("spot", 1), *thrown, *gallery, ("spot", 1), ("points", 1))


def idle(sizes: Sequence[Size], resolved: Resolved[DsnParams]) -> Mapping[str, str]:
    """The radius of a spot that is the sample, and how a sample fades out that is not the spot."""
    if resolved.params.spot == "sample":
        words = "the spot is the sample, as it is; take the disc or the Gaussian as spot, or leave it out."
        return {**not_extended(sizes, resolved), "radius": words}
    words = f"the spot is no sample, but a {resolved.params.spot}; take the sample as spot, or leave it out."
    return dict.fromkeys(("alpha", "window"), words)


def _points(drawn: Ints, context: Context) -> Picture:
    """The least count as black and the greatest as white."""
    least, greatest = int(drawn.min()), int(drawn.max())
    facts = (
        Fact("least-points", "Least number of spots on a pixel", least),
        Fact("most-points", "Greatest number of spots on a pixel", greatest),
    )
    drawn -= least
    values, peak = drawn.astype(np.float32), max(1, greatest - least)
    return encode("points", "How many spots each pixel got", values, peak, context, facts=facts)


def _spot(source: Source, height: int, width: int, params: DsnParams, context: Context) -> Spot:
    if params.spot == "sample":
        return sample_spot(source.pixels, height, width, params.alpha, params.window, context.threads)
    middle = source.peak / 2
    return standard_spot(params.spot, height, width, params.radius, middle, middle / DEVIATIONS)


_SPOT = ("spot", "radius", "alpha", "window")
OUTPUTS = (
    texture(of=("order", *_SPOT)),
    *(
        texture(name, ("convergence", *_SPOT), lambda params, inputs: params.convergence, "“Convergence” is on")
        for name in (*(f"dsn-{order}" for order in ORDERS), "adsn")
    ),
    *shown_inputs(),
    *views("spot", of=_SPOT),
    *views("points", of=("order",)),
)

DSN = Method(
    name="dsn",
    title="Discrete spot noise (DSN)",
    summary="The sum of n copies of the crop, or of a disc, at random places.",
    inputs=INPUTS,
    params=DsnParams,
    references=(RANDOM_PHASE_TEXTURES, SPOT_NOISE, IPOL_RPN, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    check=check,
    run=run,
    outputs=OUTPUTS,
    stages=stages,
    idle=idle,
    most_pixels=WHOLE_IN_MEMORY,
)

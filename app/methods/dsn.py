"""`dsn`: discrete spot noise."""

from collections.abc import Iterator, Mapping, Sequence
from math import ceil
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from app.errors import InvalidInputError
from app.methods.announced import shown_inputs, texture, views
from app.methods.explanation import Exhibit, Explanation, Figure, Formula
from app.methods.model import Context, Fact, Method, Picture, Progress, Size, Source
from app.methods.options import WHOLE_IN_MEMORY, SpotParams, not_extended
from app.methods.pictures import crops, encode, refuse_infinite
from app.methods.random_phase import INPUTS
from app.methods.references import IPOL_RPN, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES, SPOT_NOISE
from app.synthesis.dsn import Counts, counts, dsn, excess_kurtosis, shape, standard_spot
from app.synthesis.spot import Spot
from app.synthesis.spot_noise import asymptotic, sample_spot

Real = NDArray[np.float32]

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


def check(sizes: Sequence[Size], params: DsnParams) -> None:
    """Refuse a shape that does not fit into the texture."""
    width, height = params.width or sizes[0].width, params.height or sizes[0].height
    if params.spot != "sample" and 2 * params.radius + 1 > min(width, height):
        raise InvalidInputError(
            f"A spot of radius {params.radius:g} does not fit into a texture of {width} × {height} pixels: take a "
            f"smaller radius, or a texture of at least {ceil(2 * params.radius + 1)} pixels each way.",
            "parameters.radius",
        )


def run(sources: Sequence[Source], params: DsnParams, context: Context) -> Iterator[Picture]:
    """The texture, the gallery of its convergence if it is asked for, and what was thrown where."""
    source = sources[0]
    size = source.size
    check([size], params)
    refuse_infinite(sources)
    height, width = params.height or size.height, params.width or size.width
    context.progress("spot", 0.0)
    spot = _spot(source, height, width, params, context)
    kurtosis = float(excess_kurtosis(spot).mean())

    def picture(name: str, title: str, values: Real, order: float) -> Picture:
        fact = Fact("excess-kurtosis", "Excess kurtosis of a pixel's law (0 for a Gaussian)", kurtosis / order)
        return encode(name, title, values, source.peak, context, kind="texture", facts=(fact,))

    def made(order: int, progress: Progress) -> Real:
        return dsn(spot, order, seed=params.seed, threads=context.threads, progress=progress)

    end = 0.2 if params.convergence else 0.8
    yield picture("texture", "Texture", made(params.order, context.between(0.05, end)), params.order)
    if params.convergence:
        step = (0.8 - end) / (len(ORDERS) + 1)
        for order in ORDERS:
            values = made(order, context.between(end, end + step))
            yield picture(f"dsn-{order}", f"n = {order:,}".replace(",", "\N{NO-BREAK SPACE}"), values, order)
            end += step
        values = asymptotic(spot, params.seed, context.threads, context.between(end, 0.8))
        yield picture("adsn", "The limit: asymptotic discrete spot noise", values, np.inf)
    context.progress("spot", 0.8)
    yield from crops(sources, context)
    context.progress("spot", 0.85)
    if params.spot == "sample":
        yield encode("spot", "Spot", spot.rows(0, height).transpose(1, 2, 0), source.peak, context)
    else:
        yield encode("spot", "Spot", shape(params.spot, height, width, params.radius), 1, context)
    context.progress("points", 0.9)
    yield _points(counts(height, width, params.order, params.seed), context)
    context.progress("points", 1.0)


def idle(sizes: Sequence[Size], params: DsnParams) -> Mapping[str, str]:
    """The radius of a spot that is the sample, and how a sample fades out that is not the spot."""
    if params.spot == "sample":
        words = "the spot is the sample, as it is; take the disc or the Gaussian as spot, or leave it out."
        return {**not_extended(sizes, params), "radius": words}
    words = f"the spot is no sample, but a {params.spot}; take the sample as spot, or leave it out."
    return dict.fromkeys(("alpha", "window"), words)


def _points(drawn: Counts, context: Context) -> Picture:
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


EXPLANATION = Explanation(
    what=(
        "Throw $n$ copies of a spot onto a torus, each at a place drawn uniformly and independently of the others, and "
        "add them up. Less its mean and divided by $\\sqrt{n}$, the sum has the same mean and the same covariance for "
        "every $n$: what changes is only how far it is from a Gaussian texture.",
        "While there are few copies one still sees the spot. By the central limit theorem the picture tends to the "
        "asymptotic discrete spot noise (the method ADSN), in which no trace of the spot is left but its "
        "autocorrelation. How many copies that takes is told by the excess kurtosis of a pixel, which is the spot's "
        "divided by $n$: a small spot on a large canvas needs many.",
        "The copies are never drawn one by one. How many of them fall on each pixel is one multinomial variable, and "
        "the sum is its convolution with the spot, done by Fourier transforms: ten million copies take the time of "
        "ten. With the crop as spot the texture is in the crop's colours; the disc and the Gaussian are shown in "
        "grey, their mean as mid-grey, and three standard deviations below and above it as black and white, for every "
        "$n$ alike, so that the pictures of a gallery can be compared with one another and with their limit.",
    ),
    formulas=(
        Formula(
            r"f_n(x) = \sum_{k=1}^{n} h(x - X_k), \qquad X_k \text{ uniform on } \Omega",
            r"The sum of $n$ translates of the spot $h$, periodic on the domain $\Omega$ of $MN$ pixels.",
        ),
        Formula(
            r"Z_n = m + \frac{f_n - n m}{\sqrt{n}} = m + \frac{1}{\sqrt{n}}\, (h - m) * \Bigl(c - \frac{n}{MN}\Bigr)",
            r"Normalised: $m$ is the mean of $h$, and $c(x)$ counts the points $X_k$ that fall on the pixel $x$.",
        ),
        Formula(
            r"\operatorname{Cov}\bigl(Z_n(x), Z_n(y)\bigr) = \frac{1}{MN} \sum_{t} (h(t) - m)(h(t + y - x) - m), "
            r"\qquad \kappa(Z_n) = \frac{\kappa(h)}{n}",
            r"The covariance does not depend on $n$; the excess kurtosis $\kappa$ of a pixel, 0 for a Gaussian, falls "
            r"as $1/n$.",
        ),
    ),
    fails=(
        "The model has nothing for the crop that ADSN and RPN do not have: what is lost in the limit is lost. With a "
        "small $n$ whole copies of the crop shine through one another, in the same order at every place, which no "
        "photograph of a texture shows.",
        "For a small order the values are far from symmetric about their mean: a few very bright discs on an almost "
        "even ground. What passes white is cut off.",
    ),
    figures=(
        Figure(
            "From spots to a texture",
            "The discrete spot noise of a disc for growing $n$, and its limit. Each picture has the discs of the one "
            "before it.",
            (
                Exhibit(
                    "dsn",
                    (("gravel_gray", "96,96,256,256"),),
                    {"spot": "disc", "radius": 8, "convergence": True, "seed": 1},
                    ("spot", "dsn-10", "dsn-100", "dsn-1000", "dsn-10000", "dsn-100000", "adsn"),
                    "disc of radius 8",
                ),
            ),
        ),
        Figure(
            "A Gaussian spot",
            "A spot without edges: its noise is smooth, and few of them are enough.",
            (
                Exhibit(
                    "dsn",
                    (("gravel_gray", "96,96,256,256"),),
                    {"spot": "gaussian", "radius": 16, "convergence": True, "seed": 1},
                    ("spot", "dsn-10", "dsn-100", "dsn-1000", "adsn"),
                    "standard deviation 8",
                ),
            ),
        ),
        Figure(
            "A photograph as the spot",
            "Ten copies of a crop as large as the texture cannot be told from the limit: one sees none of them.",
            (
                Exhibit(
                    "dsn",
                    (("sand_desert009", "256,256,256,256"),),
                    {"convergence": True, "seed": 1},
                    ("crop", "dsn-10", "dsn-100", "adsn"),
                ),
            ),
        ),
        Figure(
            "What the limit loses",
            "Joints between bricks: with few copies one sees several walls through one another, with many none.",
            (
                Exhibit(
                    "dsn",
                    (("brick_gray", "128,128,256,256"),),
                    {"convergence": True, "order": 3, "seed": 1},
                    ("crop", "texture", "dsn-10", "dsn-1000", "adsn"),
                ),
            ),
        ),
    ),
)

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
    idle=idle,
    most_pixels=WHOLE_IN_MEMORY,
)

"""`texton`: the zero-phase texton of a sample, and the Gaussian texture that is made from it."""

from collections.abc import Iterator, Sequence
from math import sqrt

import numpy as np
from pydantic import Field

from app.methods.context import Context
from app.methods.explanations.references import PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.methods.explanations.references import TEXTON as TEXTON_ARTICLE
from app.methods.explanations.texton import EXPLANATION
from app.methods.inputs import INPUTS
from app.methods.model import Fact, Method, Picture, Source
from app.methods.output.pictures import crops, encode
from app.methods.outputs import OutputSpec, shown_inputs, texture, views
from app.methods.params import WHOLE_IN_MEMORY, Resolved, StillParams
from app.methods.stages import Plan
from app.numbers import FAR
from app.synthesis.arrays import Real
from app.synthesis.elementary import log10
from app.synthesis.fourier.spot import Spot, centre
from app.synthesis.gaussian.cut_texton import cut_texton, lag_error
from app.synthesis.gaussian.texton import extend_texton, radii, texton, texton_noise

PERCENT = (50, 90, 99)
CUT_OFF = 0.001  # part of a texton's values that its linear picture shows as black or white
DECADES = 3.0
NOISES = OutputSpec("noises", applies=lambda params, inputs: params.cut is not None, condition="the texton is cut")


class TextonParams(StillParams):
    """Parameters of the texton's synthesis."""

    cut: int | None = Field(
        None,
        ge=1,
        le=FAR,
        title="Cut to K pixels",
        description="Keep only the K × K pixels around the texton's origin, for colours one such square for each of "
        "three noises, and make up for the variance that is lost: contrast and colours stay. A smaller K is a shorter "
        "description of the texture, and loses its long-range order; empty: nothing is cut.",
    )


def run(sources: Sequence[Source], resolved: Resolved[TextonParams], context: Context) -> Iterator[Picture]:
    """The texture, the crop, and the texton that the one was made of and the other holds."""
    source = sources[0]
    params, height, width = resolved.params, resolved.height, resolved.width
    context.progress("texton", 0)
    h = centre(source.pixels, height, width)
    parts, gains = _parts(h, height, width, params.cut, context)
    values = texton_noise(h, parts, seed=params.seed, threads=context.threads, progress=context.progress)
    yield encode("texture", "Texture", values, source.peak, context, kind="texture")
    del values
    context.progress("crop", 0)
    yield from crops(sources, context)
    step = context.during("texton", (("texton", 4), ("picture", 4), ("logarithm", 2)))
    t = texton(h, context.threads, step)
    step("picture", 0)
    yield encode("texton", "Texton", _linear(t, _greatest(t)), 1, context, facts=_radii(t))
    step("logarithm", 0)
    yield encode("texton-log", "Texton, logarithmic", _logarithmic(t), 1, context)
    del t
    context.progress("extended texton", 0)
    errors = _errors(h, parts, context)
    gain = Fact("gain", "Factor r of the extended texton", gains[0])
    yield encode("spot", "Extended texton", _extended(parts[0]), 1, context, facts=(gain, *errors))
    if params.cut is not None:
        context.progress("extended texton", 0.6)
        factors = tuple(Fact(f"gain-{n}", f"Factor r of noise {n}", value) for n, value in enumerate(gains, 1))
        squares = np.concatenate([_square(spot) for spot in parts], axis=1)
        yield encode("noises", "What is left, noise by noise", squares, 1, context, facts=factors)


def _parts(
    h: Real, height: int, width: int, cut: int | None, context: Context
) -> tuple[Sequence[Spot], Sequence[float]]:
    """The extended texton, or the spots that are left of it, and the factor of each."""
    mean, progress = h.mean(axis=(0, 1), dtype=np.float64), context.progress
    if cut is not None and cut < max(h.shape[:2]):
        made = cut_texton(h, mean, height, width, cut, context.threads, progress)
        return made.spots, made.gains
    spot = extend_texton(texton(h, context.threads, progress), mean, height, width)
    return [spot], [sqrt(height * width / (h.shape[0] * h.shape[1]))]


def _errors(h: Real, parts: Sequence[Spot], context: Context) -> tuple[Fact, ...]:
    """How far the covariance of the colours is off; of the whole texton at its own size, nothing is."""
    if parts[0].planes.shape[1:] == (parts[0].height, parts[0].width):
        return ()
    error, lag = lag_error(h, parts, context.threads)
    title = "Covariance of the colours at two places, off by at most"
    return (
        Fact("lag-error", title, 100 * error, "% of that at one place"),
        Fact("lag", "Distance of the places where it is", lag, "pixels"),
    )


def _extended(spot: Spot) -> Real:
    """A spot as a picture: 0 as mid-grey, all over the texture's size."""
    picture = np.full((spot.height, spot.width, len(spot.planes)), 0.5, np.float32)
    square = _square(spot)
    picture[spot.top : spot.top + len(square), spot.left : spot.left + square.shape[1]] = square
    return picture


def _square(spot: Spot) -> Real:
    planes = spot.planes.transpose(1, 2, 0)
    return _linear(planes, _greatest(planes))


def _radii(t: Real) -> tuple[Fact, ...]:
    found = radii(t, [part / 100 for part in PERCENT])
    return tuple(
        Fact(f"radius-{part}", f"Radius that holds {part} % of the energy", radius, "pixels")
        for part, radius in zip(PERCENT, found, strict=True)
    )


def _greatest(t: Real) -> float:
    """The modulus that one value in a thousand reaches; 1 for a texton without contrast."""
    values = np.abs(t).ravel()
    rank = int(len(values) * (1 - CUT_OFF))
    values.partition(rank)
    return float(values[rank]) or 1.0


def _linear(t: Real, greatest: float) -> Real:
    """0 as mid-grey, minus and plus ``greatest`` as black and white."""
    return 0.5 + t / np.float32(2 * greatest)


def _logarithmic(t: Real) -> Real:
    """The modulus over all channels, its greatest value as white, three powers of ten below it or less as black."""
    power = np.einsum("yxc,yxc->yx", t, t)
    power /= max(float(power.max()), np.finfo(np.float32).tiny)
    decades: Real = np.asarray(log10(np.maximum(power, np.float32(10 ** (-2 * DECADES)))) / 2)
    return 1 + decades / np.float32(DECADES)


STAGES: Plan = (
    ("texton", 20),
    ("random phase", 20),
    ("texture", 40),
    ("crop", 2),
    ("texton", 10),
    ("extended texton", 8),
)

TEXTON = Method(
    name="texton",
    title="Texton",
    summary="The sample without its phase: a compact spot of the same Gaussian texture, and that texture.",
    inputs=INPUTS,
    params=TextonParams,
    references=(TEXTON_ARTICLE, RANDOM_PHASE_TEXTURES, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    run=run,
    outputs=(texture(), *shown_inputs(), *views("texton", "texton-log", of=()), *views("spot"), NOISES),
    stages=lambda sizes, resolved: STAGES,
    most_pixels=WHOLE_IN_MEMORY,
    phase=True,
)

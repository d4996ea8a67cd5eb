"""`texton`: the zero-phase texton of a sample, and the Gaussian texture that is made from it."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from app.methods.announced import shown_inputs, texture, views
from app.methods.explanation import Exhibit, Explanation, Figure, Formula
from app.methods.model import Context, Fact, Method, Picture, Size, Source, StillParams
from app.methods.options import WHOLE_IN_MEMORY
from app.methods.pictures import crops, encode, refuse_infinite
from app.methods.random_phase import INPUTS
from app.methods.references import PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.methods.references import TEXTON as TEXTON_ARTICLE
from app.numbers import FAR
from app.synthesis.spot import centre
from app.synthesis.texton import extend_texton, radii, texton, texton_noise

Real = NDArray[np.float32]

PERCENT = (50, 90, 99)
CUT_OFF = 0.001  # part of a texton's values that its linear picture shows as black or white
DECADES = 3.0


class TextonParams(StillParams):
    """Parameters of the texton's synthesis."""

    cut: int | None = Field(
        None,
        ge=1,
        le=FAR,
        title="Cut to K pixels",
        description="Keep only the K × K pixels around the texton's origin, and make up for the variance that is lost. "
        "A smaller K is a shorter description of the texture, and loses its long-range order; empty: nothing is cut.",
    )


def check(sizes: Sequence[Size], params: TextonParams) -> None:
    """Nothing is refused: a cut that is larger than the texton cuts nothing."""


def run(sources: Sequence[Source], params: TextonParams, context: Context) -> Iterator[Picture]:
    """The texture, the crop, and the texton that the one was made of and the other holds."""
    source = sources[0]
    refuse_infinite(sources)
    height, width = params.height or source.pixels.shape[0], params.width or source.pixels.shape[1]
    context.progress("texton", 0.0)
    h = centre(source.pixels, height, width)
    t = texton(h, context.threads, context.between(0, 0.2))
    context.progress("texton", 0.2)
    spot, r = extend_texton(t, h.mean(axis=(0, 1), dtype=np.float64), height, width, params.cut)
    values = texton_noise(h, spot, seed=params.seed, threads=context.threads, progress=context.between(0.2, 0.8))
    yield encode("texture", "Texture", values, source.peak, context, kind="texture")
    del values
    context.progress("crop", 0.8)
    yield from crops(sources, context)
    context.progress("texton", 0.85)
    greatest = _greatest(t)
    yield encode("texton", "Texton", _linear(t, greatest), 1, context, facts=_radii(t))
    context.progress("texton", 0.9)
    yield encode("texton-log", "Texton, logarithmic", _logarithmic(t), 1, context)
    del t
    context.progress("extended texton", 0.95)
    gain = float(r.mean())
    extended = np.full((height, width, len(r)), 0.5, np.float32)
    rows, columns = spot.planes.shape[1:]
    inside = extended[spot.top : spot.top + rows, spot.left : spot.left + columns]
    inside[:] = _linear(spot.planes.transpose(1, 2, 0), gain * greatest)
    fact = Fact("gain", "Factor r of the extended texton", gain)
    yield encode("spot", "Extended texton", extended, 1, context, facts=(fact,))
    context.progress("extended texton", 1.0)


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
    decades: Real = np.log10(np.maximum(power, np.float32(10 ** (-2 * DECADES)))) / 2
    return 1 + decades / np.float32(DECADES)


EXPLANATION = Explanation(
    what=(
        "Many spots make the same Gaussian texture: all those whose Fourier modulus is the sample's. The texton is the "
        "one among them that has no phase. All its oscillations crest at one point, its origin, so its energy gathers "
        "there, and what lies further away tells how far the texture's order reaches. The radii that hold 50, 90 and "
        "99 % of the energy are given with its picture.",
        "A photograph is one draw of its texture, so its modulus flutters about a smooth spectrum as a Rayleigh noise "
        "does. In the texton this flutter, about $1 - \\pi/4$ or a fifth of the energy, is the even noise over the "
        "whole domain: the two outer radii mostly measure the crop. A cut takes the noise off, and $r$, without which "
        "the contrast would fall by that much, is then about $\\sqrt{4/\\pi} = 1.13$ for a texture of the crop's size.",
        "The channels of a colour photograph have phases of their own, and their differences make the colours. So the "
        "phase of the luminance is taken off all channels alike: the differences stay.",
        "The synthesis is the asymptotic discrete spot noise of the extended texton: the texton, or the $K \\times K$ "
        "pixels around its origin, pasted into an image of the texture's size and multiplied by the factor $r$ that "
        "keeps the variance. Its random phase is turned so that the texture has the phase that ADSN has at the same "
        "seed. Uncut and at the crop's own size it *is* that texture; otherwise flip between the two to see what the "
        "cut or the other extension changes.",
        "The linear picture shows the texton's 0 as mid-grey, and as black and white the value that one in a thousand "
        "exceeds, the one of the extended texton $r$ times that value. The logarithmic picture shows the modulus, all "
        "channels together, from its greatest value (white) to three powers of ten below (black).",
    ),
    formulas=(
        Formula(
            r"\hat{t}_c(\xi) = \hat{p}_c(\xi)\, \frac{\overline{\hat{\ell}(\xi)}}{|\hat{\ell}(\xi)|}",
            r"The texton of a channel $p_c$ of the periodic component with luminance $\ell$; for a grey sample that "
            r"is $\hat{t} = |\hat{p}|$. Its mean is kept apart.",
        ),
        Formula(
            r"\tilde{t} = m + r\, (t - m)\, \mathbb{1}_{\Omega}",
            r"The extended texton: $m$ is the mean, $\Omega$ the texton's domain, or a square of $K \times K$ pixels, "
            r"in the larger image.",
        ),
        Formula(
            r"r^2 = \frac{M_2 N_2}{M_1 N_1} \cdot \frac{\sum (t - m)^2}{\sum u^2 - \frac{1}{M_2 N_2} (\sum u)^2}, "
            r"\qquad u = (t - m)\, \mathbb{1}_{\Omega}",
            r"The factor for a sample of $M_1 \times N_1$ and a texture of $M_2 \times N_2$ pixels. Uncut, the last "
            r"fraction is 1, and $r$ is the square root of the ratio of the areas.",
        ),
    ),
    fails=(
        "A texton is as good as the Gaussian model behind it: edges and objects are not in it.",
        "The extended texton ends where the sample did, without a window. That is harmless where the texton has died "
        "away by then; the texton of a regular fabric, or of a crop with large stains, has not, and cutting it blurs "
        "the regularity. The logarithmic picture tells, and a factor $r$ well above that of the noise alone.",
    ),
    figures=(
        Figure(
            "A compact texton",
            "A micro-texture, its texton (linear and logarithmic), and a texture of four times the area made of it.",
            (
                Exhibit(
                    "texton",
                    (("gravel_gray", "96,96,256,256"),),
                    {"width": 512, "height": 512, "seed": 1},
                    ("crop", "texton", "texton-log", "texture"),
                ),
            ),
        ),
        Figure(
            "How little of it is enough",
            "The same texture from the whole texton and from ever smaller squares around its origin, at one phase.",
            tuple(
                Exhibit(
                    "texton",
                    (("gravel_gray", "96,96,256,256"),),
                    {"seed": 1} | ({"cut": cut} if cut else {}),
                    ("texture",),
                    f"K = {cut}" if cut else "whole",
                )
                for cut in (None, 65, 31, 15, 7)
            ),
        ),
        Figure(
            "Colours",
            "Every channel keeps its displacement against the luminance, and the texture its colours.",
            (
                Exhibit(
                    "texton",
                    (("rockface_pink", "190,60,256,256"),),
                    {"width": 512, "height": 512, "seed": 1},
                    ("crop", "texton", "texton-log", "texture"),
                ),
            ),
        ),
        Figure(
            "A texton that does not die away",
            "The weave of a towel is nearly periodic: its texton has crests all over, and cut to 31 pixels it makes a "
            "less regular weave.",
            tuple(
                Exhibit("texton", (("towel_white", "96,96,256,256"),), {"seed": 1} | parameters, show, label)
                for parameters, show, label in (
                    ({}, ("crop", "texton-log", "texture"), "whole"),
                    ({"cut": 31}, ("texture",), "K = 31"),
                )
            ),
        ),
    ),
)

TEXTON = Method(
    name="texton",
    title="Texton",
    summary="The sample without its phase: a compact spot of the same Gaussian texture, and that texture.",
    inputs=INPUTS,
    params=TextonParams,
    references=(TEXTON_ARTICLE, RANDOM_PHASE_TEXTURES, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    check=check,
    run=run,
    outputs=(texture(), *shown_inputs(), *views("texton", "texton-log", of=()), *views("spot")),
    most_pixels=WHOLE_IN_MEMORY,
    phase=True,
)

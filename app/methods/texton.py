"""`texton`: the zero-phase texton of a sample, and the Gaussian texture that is made from it."""

from collections.abc import Iterator, Sequence
from math import sqrt

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from app.methods.announced import Announced, shown_inputs, texture, views
from app.methods.explanation import Exhibit, Explanation, Figure, Formula
from app.methods.model import Context, Fact, Method, Picture, Size, Source, StillParams
from app.methods.options import WHOLE_IN_MEMORY
from app.methods.pictures import crops, encode, refuse_infinite
from app.methods.random_phase import INPUTS
from app.methods.references import PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.methods.references import TEXTON as TEXTON_ARTICLE
from app.numbers import FAR
from app.synthesis.cut_texton import cut_texton, lag_error
from app.synthesis.elementary import log10
from app.synthesis.spot import Spot, centre
from app.synthesis.texton import extend_texton, radii, texton, texton_noise

Real = NDArray[np.float32]

PERCENT = (50, 90, 99)
CUT_OFF = 0.001  # part of a texton's values that its linear picture shows as black or white
DECADES = 3.0
NOISES = Announced("noises", given=lambda params, inputs: params.cut is not None, condition="the texton is cut")


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


def check(sizes: Sequence[Size], params: TextonParams) -> None:
    """Nothing is refused: a cut that is larger than the texton cuts nothing."""


def run(sources: Sequence[Source], params: TextonParams, context: Context) -> Iterator[Picture]:
    """The texture, the crop, and the texton that the one was made of and the other holds."""
    source = sources[0]
    refuse_infinite(sources)
    height, width = params.height or source.pixels.shape[0], params.width or source.pixels.shape[1]
    context.progress("texton", 0.0)
    h = centre(source.pixels, height, width)
    parts, gains = _parts(h, height, width, params.cut, context)
    context.progress("texton", 0.2)
    values = texton_noise(h, parts, seed=params.seed, threads=context.threads, progress=context.between(0.2, 0.8))
    yield encode("texture", "Texture", values, source.peak, context, kind="texture")
    del values
    context.progress("crop", 0.8)
    yield from crops(sources, context)
    t = texton(h, context.threads, context.between(0.82, 0.86))
    context.progress("texton", 0.86)
    yield encode("texton", "Texton", _linear(t, _greatest(t)), 1, context, facts=_radii(t))
    context.progress("texton", 0.9)
    yield encode("texton-log", "Texton, logarithmic", _logarithmic(t), 1, context)
    del t
    context.progress("extended texton", 0.92)
    errors = _errors(h, parts, context)
    gain = Fact("gain", "Factor r of the extended texton", gains[0])
    yield encode("spot", "Extended texton", _extended(parts[0]), 1, context, facts=(gain, *errors))
    if params.cut is not None:
        context.progress("extended texton", 0.97)
        factors = tuple(Fact(f"gain-{n}", f"Factor r of noise {n}", value) for n, value in enumerate(gains, 1))
        squares = np.concatenate([_square(spot) for spot in parts], axis=1)
        yield encode("noises", "What is left, noise by noise", squares, 1, context, facts=factors)
    context.progress("extended texton", 1.0)


def _parts(
    h: Real, height: int, width: int, cut: int | None, context: Context
) -> tuple[Sequence[Spot], Sequence[float]]:
    """The extended texton, or the spots that are left of it, and the factor of each."""
    mean, progress = h.mean(axis=(0, 1), dtype=np.float64), context.between(0, 0.2)
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


GRAVEL = (("gravel_gray", "96,96,256,256"),)
LEAVES = (("leaves_forest_floor", "256,256,256,256"),)
GRANITE = (("rockface_pink", "190,60,256,256"),)


def _cuts(inputs: tuple[tuple[str, str], ...], sizes: Sequence[int], first: tuple[str, ...]) -> Iterator[Exhibit]:
    """A texture from the whole texton, and from squares of these sizes."""
    yield Exhibit("texton", inputs, {"seed": 1}, first, "whole")
    for cut in sizes:
        yield Exhibit("texton", inputs, {"seed": 1, "cut": cut}, ("texture",), f"K = {cut}")


EXPLANATION = Explanation(
    what=(
        "Many spots make the same Gaussian texture: all those whose Fourier modulus is the sample's. The texton is the "
        "one among them that has no phase. All its oscillations crest at one point, its origin, so its energy gathers "
        "there, and what lies further away tells how far the texture's order reaches. The radii that hold 50, 90 and "
        "99 % of the energy are given with its picture.",
        "A photograph is one draw of its texture, so its modulus flutters about a smooth spectrum as a Rayleigh noise "
        "does. In the texton this flutter, about $1 - \\pi/4$ or a fifth of the energy, is the even noise over the "
        "whole domain: the two outer radii mostly measure the crop. A cut takes the noise off, and $r$, without which "
        "the contrast would fall by that much, is then about $\\sqrt{4/\\pi} = 1.13$ for a grey texture of the crop's "
        "size.",
        "The channels of a colour photograph have phases of their own, and their differences make the colours. So the "
        "phase of the luminance is taken off all channels alike: the differences stay. But they stay everywhere: only "
        "the luminance gathers at the origin, and a cut would keep it and lose the colours. A cut therefore takes the "
        "channels' spectra as a matrix, averaged over neighbouring frequencies, and its root, which has no phase: a "
        "spot for each of three independent noises. A matrix $R$ then gives back what the cut has lost, so that the "
        "covariance of the colours, contrast and hues, is exactly that of the periodic component.",
        "What a cut changes, and the other extension a little, is the covariance between the colours of *two* places: "
        "how far apart alike colours lie. How far it is off where it is off most is given with the picture of the "
        "extended texton, as a part of the covariance at one place.",
        "The synthesis is the asymptotic discrete spot noise of the extended texton: the texton, or the $K \\times K$ "
        "pixels around its origin, pasted into an image of the texture's size and multiplied by the factor $r$ that "
        "keeps the variance. Its random phase is turned so that the texture's luminance has the phase that ADSN has at "
        "the same seed. Uncut and at the crop's own size it *is* that texture, in all channels; otherwise flip between "
        "the two to see what the cut or the other extension changes. Of a cut only light and dark lie where ADSN has "
        "them: what its colours do beside that comes from noises of their own.",
        "The linear pictures show 0 as mid-grey, and as black and white the value that one in a thousand exceeds in "
        "them. Of a cut colour texton the squares stand side by side, one for each noise, each on a scale of its own: "
        "the first makes most of the contrast, the others the colours. The logarithmic picture shows the modulus of "
        "the texton, all channels together, from its greatest value (white) to three powers of ten below (black).",
    ),
    formulas=(
        Formula(
            r"\hat{t}_c(\xi) = \hat{p}_c(\xi)\, \frac{\overline{\hat{\ell}(\xi)}}{|\hat{\ell}(\xi)|}",
            r"The texton of a channel $p_c$ of the periodic component with luminance $\ell$; for a grey sample that "
            r"is $\hat{t} = |\hat{p}|$. Its mean is kept apart.",
        ),
        Formula(
            r"\tilde{t} = m + r\, (t - m)\, \mathbb{1}_{\Omega}",
            r"The extended texton: $m$ is the mean, $\Omega$ the texton's domain in the larger image. For a sample of "
            r"$M_1 \times N_1$ and a texture of $M_2 \times N_2$ pixels, $r$ is $\sqrt{M_2 N_2 / (M_1 N_1)}$.",
        ),
        Formula(
            r"\hat{t}(\xi) = \bigl( \hat{w} * \hat{p}\, \hat{p}^* \bigr)(\xi)^{1/2}, "
            r"\qquad \tilde{t} = m + R\, t\, \mathbb{1}_{\Omega}",
            r"A colour texton to be cut: $\hat{p}$ is the column of the channels' spectra, so $t$ is a matrix of as "
            r"many rows and columns, and column $j$ the spot of noise $j$. $\Omega$ is a square of $K \times K$ "
            r"pixels, and $w$ falls with the lag, linearly, to 0 at $4 K N / (N - K)$ of the crop's $N$ pixels along "
            r"each axis. A grey texton is cut as it is.",
        ),
        Formula(
            r"R = B^{-1/2} \bigl( B^{1/2}\, C\, B^{1/2} \bigr)^{1/2} B^{-1/2}",
            r"The symmetric matrix with $R B R^T = C$, in grey a factor: $C$ is the covariance of the crop's colours, "
            r"$B$ that of the colours that $t\, \mathbb{1}_{\Omega}$ makes in a texture of $M_2 \times N_2$ pixels.",
        ),
    ),
    fails=(
        "A texton is as good as the Gaussian model behind it: edges and objects are not in it.",
        "The extended texton ends where the sample did, without a window. That is harmless where the texton has died "
        "away by then; the texton of a regular fabric, or of a crop with large stains, has not, and cutting it blurs "
        "the regularity. The logarithmic picture tells, and a factor $r$ well above that of the noise alone.",
        "A cut keeps every colour, but not how far it reaches: at $K = 15$ stains that are larger than that come back "
        "as a grain of the same colours. On leaves the covariance is off by 18, 23, 39 and 66 % of that at one "
        "place for $K = 65$, 31, 15 and 7, on granite, whose grain is fine, by 5, 8, 10 and 14 %.",
    ),
    figures=(
        Figure(
            "A compact texton",
            "Gravel and granite, their textons (linear and logarithmic), and textures of four times the area made of "
            "them. In colour every channel keeps its displacement against the luminance.",
            tuple(
                Exhibit(
                    "texton",
                    photo,
                    {"width": 512, "height": 512, "seed": 1},
                    ("crop", "texton", "texton-log", "texture"),
                )
                for photo in (GRAVEL, GRANITE)
            ),
        ),
        Figure(
            "How little of it is enough",
            "The same texture from the whole texton and from ever smaller squares around its origin, at one phase.",
            tuple(_cuts(GRAVEL, (65, 31, 15, 7), ("texture",))),
        ),
        Figure(
            "Colours of a cut",
            "Leaves and granite, from the whole texton and from ever smaller squares: the stains shrink to what a "
            "square can hold, the colours and the contrast stay.",
            tuple(each for photo in (LEAVES, GRANITE) for each in _cuts(photo, (65, 15), ("crop", "texture"))),
        ),
        Figure(
            "What a cut colour texton is",
            "Granite, and the squares of 31 pixels that make its texture, one for each noise: light and dark, and two "
            "of colours.",
            (
                Exhibit(
                    "texton",
                    (("rockface_pink", "190,60,96,96"),),
                    {"seed": 1, "cut": 31},
                    ("crop", "noises", "texture"),
                    "K = 31",
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
    outputs=(texture(), *shown_inputs(), *views("texton", "texton-log", of=()), *views("spot"), NOISES),
    most_pixels=WHOLE_IN_MEMORY,
    phase=True,
)

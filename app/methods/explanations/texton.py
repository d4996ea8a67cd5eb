"""Explanation of `texton`: prose, formulas and figures of its page."""

from collections.abc import Iterator, Sequence

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

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

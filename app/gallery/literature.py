"""Figures of the literature as experiments, on photographs of our own, and what to see on them."""

from dataclasses import dataclass

from app.methods.explanations.model import Exhibit, Figure, Reference
from app.methods.explanations.references import RANDOM_PHASE_TEXTURES

GRAVEL = (("gravel_gray", "96,96,256,256"),)
SMALL_GRAVEL = (("gravel_gray", "96,96,80,80"),)
GRANITE = (("rockface_pink", "190,60,256,256"),)
SMALL_GRANITE = (("rockface_pink", "190,60,192,192"),)
SINUSOIDS = (("two_sinusoids", "0,0,256,256"),)
PLASTER = (("lit_plaster", "0,0,256,256"),)
TEXTURE = ("texture",)
PAIR = ("crop", "texture")


@dataclass(frozen=True)
class LiteratureFigure:
    """A figure of an article made anew; ``name`` is its anchor, ``number`` the article's."""

    name: str
    number: int
    figure: Figure
    article: Reference = RANDOM_PHASE_TEXTURES


FIGURES = (
    LiteratureFigure(
        "orders",
        4,
        Figure(
            "Discrete spot noise of growing order",
            "A disc is thrown $n$ times at random. With ten one counts them; with a hundred thousand there is a "
            "texture, which cannot be told from the limit, the ADSN, on the right.",
            (
                Exhibit(
                    "dsn",
                    GRAVEL,
                    {"spot": "disc", "radius": 8, "convergence": True, "seed": 1},
                    ("dsn-10", "dsn-100", "dsn-1000", "dsn-10000", "dsn-100000", "adsn"),
                ),
            ),
        ),
    ),
    LiteratureFigure(
        "sinusoids",
        6,
        Figure(
            "RPN and ADSN differ on two sinusoids",
            "With two frequencies alone a random phase does no more than shift the drawing. ADSN multiplies both by "
            "Rayleigh numbers besides, and may favour one of them: compare the two seeds. On a photograph, with "
            "thousands of frequencies, one does not see that. The drawing repeats without a jump, so the periodic "
            "component is not taken: it would add a trace of other frequencies.",
            (
                Exhibit("rpn", SINUSOIDS, {"seed": 1, "periodic": False}, PAIR),
                *(
                    Exhibit("adsn", SINUSOIDS, {"seed": seed, "periodic": False}, TEXTURE, f"ADSN, seed {seed}")
                    for seed in (5, 15)
                ),
            ),
        ),
    ),
    LiteratureFigure(
        "wrong-rpn",
        7,
        Figure(
            "The wrong RPN: one phase for all colours",
            "Added to the phases of the channels, the same random phase keeps their differences, and so the colours. "
            "Put in their place it makes all channels oscillate together: colours appear that the photograph does not "
            "have, and those that it has are gone.",
            tuple(
                Exhibit("rpn", ((sample, crop),), {"seed": 1, "phase": phase}, show, label)
                for sample, crop in (("leaves_forest_floor", "256,256,256,256"), *GRANITE)
                for phase, show, label in (("add", PAIR, "RPN"), ("replace", TEXTURE, "Wrong RPN"))
            ),
        ),
    ),
    LiteratureFigure(
        "periodic-component",
        8,
        Figure(
            "What the periodic component is for",
            "Plaster under a light from the right (a drawing): opposite borders do not fit together, and for the "
            "Fourier transform, which sees the crop repeated, that is an edge. Randomised, it comes back as stripes "
            "all over. In the periodic component the jump is gone, taken up by the smooth component.",
            (
                Exhibit(
                    "rpn",
                    PLASTER,
                    {"seed": 1},
                    ("crop", "periodic", "smooth", "texture"),
                    "RPN of the periodic component",
                ),
                Exhibit("rpn", PLASTER, {"seed": 1, "periodic": False}, TEXTURE, "RPN of the crop itself"),
            ),
        ),
    ),
    LiteratureFigure(
        "extension",
        10,
        Figure(
            "From a spot to any size",
            "The crop and its RPN; then the extended spot (the periodic component of the crop, pasted into a larger "
            "image under the window of the article, $\\alpha = 0.2$) and the RPN of that spot, on four times the area. "
            "The grain is the same.",
            (
                Exhibit("rpn", SMALL_GRANITE, {"seed": 1}, PAIR),
                Exhibit(
                    "rpn",
                    SMALL_GRANITE,
                    {"width": 384, "height": 384, "alpha": 0.2, "window": "gaussian", "seed": 1},
                    ("spot", "texture"),
                    "RPN of the extended spot",
                ),
            ),
        ),
    ),
    LiteratureFigure(
        "same-phase",
        11,
        Figure(
            "RPN and ADSN at one phase",
            "Every sample has one random phase for both. Their moduli differ by a factor that is random at every "
            "frequency, but one has to look for the difference: the two models are one class of texture to the eye.",
            tuple(
                Exhibit(method, ((sample, crop),), {"seed": 1}, show, label)
                for sample, crop in (
                    ("rockface_pink", "190,60,256,256"),
                    ("towel_red", "96,96,256,256"),
                    ("concrete_img_0572", "128,64,256,256"),
                )
                for method, show, label in (("rpn", PAIR, "RPN"), ("adsn", TEXTURE, "ADSN"))
            ),
        ),
    ),
    LiteratureFigure(
        "windows",
        14,
        Figure(
            "Growing a texture pixel by pixel, with three windows",
            "Efros–Leung with windows of 9, 15 and 21 pixels, and RPN. Copied stones keep their contours, which RPN "
            "dissolves; but small windows grow garbage, and large ones repeat the crop word by word: open one of them "
            "to see its copy map. RPN does the same thing every time.",
            (
                Exhibit(
                    "efros-leung",
                    SMALL_GRAVEL,
                    {"width": 128, "height": 128, "half_patch": 4, "seed": 1},
                    PAIR,
                    "Window of 9",
                ),
                *(
                    Exhibit(
                        "efros-leung",
                        SMALL_GRAVEL,
                        {"width": 128, "height": 128, "half_patch": half, "seed": 1},
                        TEXTURE,
                        f"Window of {2 * half + 1}",
                    )
                    for half in (7, 10)
                ),
                Exhibit("rpn", SMALL_GRAVEL, {"width": 128, "height": 128, "seed": 1}, TEXTURE),
            ),
        ),
    ),
    LiteratureFigure(
        "nine-draws",
        15,
        Figure(
            "Nine draws of one sample",
            "Nine seeds. No two agree anywhere, and all are the same stone: whoever needs a texture may take the first "
            "one, without looking.",
            (
                Exhibit("rpn", GRANITE, {"seed": 1}, PAIR, "Seed 1"),
                *(Exhibit("rpn", GRANITE, {"seed": seed}, TEXTURE, f"Seed {seed}") for seed in range(2, 10)),
            ),
        ),
    ),
    LiteratureFigure(
        "rayleigh",
        16,
        Figure(
            "Who bears a Rayleigh noise on the modulus",
            "Each photograph, and the same with its Fourier modulus multiplied by white Rayleigh noise, its phase "
            "kept. A haze of stripes covers the scene and the paving; the granite bears it.",
            tuple(
                Exhibit("rayleigh", ((sample, crop),), {"seed": 1})
                for sample, crop in (
                    ("scene_china", "0,0,512,384"),
                    ("crazy_paving001", "80,80,256,256"),
                    ("rockface_pink", "190,60,256,256"),
                )
            ),
        ),
    ),
)

"""`rpn`: random phase noise."""

from functools import partial

from app.methods.explanation import Exhibit, Explanation, Figure, Formula
from app.methods.model import Method
from app.methods.random_phase import INPUTS, RandomPhaseParams, check, run, toroidal
from app.methods.references import IPOL_RPN, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES

LEAVES = (("leaves_forest_floor", "256,256,256,256"),)
PLASTER = (("lit_plaster", "0,0,256,256"),)

EXPLANATION = Explanation(
    what=(
        "Every image is its Fourier modulus, which says how much of each oscillation it holds, and its phase, which "
        "says where the crests lie. A micro-texture is one for which only the modulus matters: random phase noise "
        "keeps it and draws the phase anew, uniformly and independently at every frequency.",
        "The colours stay right because the *same* random phase is added to all channels, which keeps the "
        "differences between their phases. The crop is replaced by its periodic component first, so that the jump "
        "between its opposite borders does not come back as a cross of streaks, and for a larger texture by its "
        "extended spot.",
        "That is all: two Fourier transforms, whatever the sample. There is nothing to converge and nothing to go "
        "wrong, every seed gives another texture of the same kind, and each of them tiles without a seam.",
    ),
    formulas=(
        Formula(
            r"\hat{Z}(\xi) = \hat{h}(\xi)\, e^{i\theta(\xi)}, \qquad \theta(-\xi) = -\theta(\xi)",
            r"$h$ is the crop, or its extended spot; $\theta$ is uniform on $]-\pi, \pi]$, the same for every channel, "
            r"and zero at the origin, so that the mean stays.",
        ),
        Formula(
            r"\tilde{h} = m + \sqrt{\frac{M_2 N_2}{M_1 N_1}}\, \varphi_\alpha \, (p - m)",
            r"The extended spot: the periodic component $p$ of the $M_1 \times N_1$ crop, with its mean $m$, pasted "
            r"into an image of $M_2 \times N_2$ pixels under a window $\varphi_\alpha$ of mean square 1.",
        ),
    ),
    fails=(
        "Edges, and all that stands out from its surroundings, are alignments of phases: they are lost. Bricks, "
        "tiles, leaves and letters become a cloud of the right colours and grain. The structure meter says so "
        "beforehand; Heeger–Bergen keeps a little more, Efros–Leung copies such things.",
        "A texture has no places: a crop whose grain or light changes from one to another comes back as a mixture of "
        "all, or with large stains. A steady slope of light is taken out with the smooth component; of other changes "
        "crop a smaller, homogeneous region.",
    ),
    figures=(
        Figure(
            "A micro-texture, on four times the area",
            "Rippled sand. The ripples keep their direction, their distance and their light; the texture tiles without "
            "a seam.",
            (Exhibit("rpn", (("sand_desert009", "128,64,256,256"),), {"width": 512, "height": 512, "seed": 1}),),
        ),
        Figure(
            "Step by step",
            "The crop; its periodic component, which fits together at opposite borders, and the smooth rest; the "
            "logarithm of the Fourier modulus, zero frequency in the middle, which is the same before and after; and "
            "what a random phase makes of it.",
            (
                Exhibit(
                    "rpn",
                    (("rockface_pink", "190,60,256,256"),),
                    {"seed": 1},
                    ("crop", "periodic", "smooth", "input-spectrum", "output-spectrum", "texture"),
                ),
            ),
        ),
        Figure(
            "The same phase added to all colours",
            "The same random phase, added to the phases of all channels, and put in their place: the second makes red, "
            "green and blue oscillate together, and the colours are others.",
            (
                Exhibit("rpn", LEAVES, {"seed": 1}, label="Added"),
                Exhibit("rpn", LEAVES, {"seed": 1, "phase": "replace"}, ("texture",), "In their place"),
            ),
        ),
        Figure(
            "A light from one side",
            "A drawing of plaster. The change of light belongs to no texture; it is taken out with the smooth "
            "component, and can be put back.",
            (
                Exhibit("rpn", PLASTER, {"seed": 1}, ("crop", "smooth", "texture")),
                Exhibit("rpn", PLASTER, {"seed": 1, "add_smooth": True}, ("texture",), "With the smooth component"),
            ),
        ),
        Figure(
            "What it cannot do",
            "The joints of paving and bricks are alignments of phases: the random phase dissolves them. Their period "
            "and direction, which the modulus knows, stay.",
            (
                Exhibit("rpn", (("tiles02", "0,0,256,256"),), {"seed": 1}),
                Exhibit("rpn", (("brick_gray", "128,128,256,256"),), {"seed": 1}),
            ),
        ),
    ),
)

RPN = Method(
    name="rpn",
    title="Random phase noise (RPN)",
    summary="Keeps the Fourier modulus of the crop and draws its phase at random.",
    inputs=INPUTS,
    params=RandomPhaseParams,
    references=(IPOL_RPN, RANDOM_PHASE_TEXTURES, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    check=check,
    run=partial(run, rayleigh=False),
    toroidal=toroidal,
    phase=True,
)

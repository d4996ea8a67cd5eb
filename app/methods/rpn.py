"""`rpn`: random phase noise."""

from functools import partial

from app.methods.explanation import Exhibit, Explanation, Figure, Formula
from app.methods.model import Method
from app.methods.random_phase import INPUTS, RandomPhaseParams, check, run, toroidal
from app.methods.references import IPOL_RPN, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES

EXPLANATION = Explanation(
    what=(
        "Every image is its Fourier modulus, which says how much of each oscillation it holds, and its phase, which "
        "says where the crests lie. A micro-texture is one for which only the modulus matters: random phase noise "
        "keeps it and draws the phase anew, uniformly and independently at every frequency.",
        "The colours stay right because the *same* random phase is added to all channels, which keeps the "
        "differences between their phases. The crop is replaced by its periodic component first, so that the jump "
        "between its opposite borders does not come back as a cross of streaks, and for a larger texture by its "
        "extended spot.",
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
        "A crop that changes from one side to the other (light, perspective) gives a texture with large stains: crop "
        "a smaller, homogeneous region.",
    ),
    figures=(
        Figure(
            "A micro-texture, twice as large",
            "The crop and its random phase noise on four times the area.",
            (Exhibit("rpn", (("gravel_gray", "96,96,256,256"),), {"width": 512, "height": 512, "seed": 1}),),
        ),
        Figure(
            "What it cannot do",
            "The joints of the paving are alignments of phases: the random phase dissolves them.",
            (Exhibit("rpn", (("tiles02", "0,0,256,256"),), {"seed": 1}),),
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

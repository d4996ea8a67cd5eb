"""Explanation of `rpn`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

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
        "That is all: of every channel two Fourier transforms of the texture's size, there and back, and for a larger "
        "texture one more of the crop's size, for its periodic component. There is nothing to converge and nothing to "
        "go wrong, every seed gives another texture of the same kind, and each of them tiles without a seam.",
    ),
    formulas=(
        Formula(
            r"\hat{Z}(\xi) = \hat{h}(\xi)\, e^{i\theta(\xi)}, \qquad \theta(-\xi) = -\theta(\xi)",
            r"$h$ is the crop, or its extended spot; $\theta$ is uniform on $]-\pi, \pi]$, the same for every channel, "
            r"and zero at the origin, so that the mean stays.",
        ),
        Formula(
            r"\tilde{h} = m + g\, \varphi_\alpha \, (p - m), \qquad g \approx \sqrt{\frac{M_2 N_2}{M_1 N_1}}",
            r"The extended spot: the periodic component $p$ of the $M_1 \times N_1$ crop, with its mean $m$, pasted "
            r"into an image of $M_2 \times N_2$ pixels under a window $\varphi_\alpha$ of mean square 1.",
        ),
        Formula(
            r"g^2 = \frac{\sum_c \operatorname{Var}(p_c)}{\sum_c \operatorname{Var}(\varphi_\alpha\, (p_c - m_c))}",
            r"The articles take the root of the ratio of the areas for $g$, which keeps the variance on average over "
            r"all places of the window. This $g$ keeps that of the crop at hand: the variance of the texture, the mean "
            r"over its channels $c$, is that of $p$ exactly. (The variances are over the crop above, and below over "
            r"the whole texture, which is 0 around the window.)",
        ),
    ),
    fails=(
        "Edges, and all that stands out from its surroundings, are alignments of phases: they are lost. Bricks, "
        "tiles, leaves and letters become a cloud of the right colours and grain. The structure meter says so "
        "beforehand; Heeger–Bergen keeps a little more, Efros–Leung copies such things.",
        "A texture has no places: a crop whose grain or light changes from one to another comes back as a mixture of "
        "all, or with large stains. A steady slope of light is taken out with the smooth component; of other changes "
        "crop a smaller, homogeneous region.",
        "For a larger texture the window makes the middle of the crop count more than its border. One factor for all "
        "channels sets the contrast right; how the channels compare stays as the crop has it under the window. In "
        "the suggested crops of the bundled photographs the variance of a single channel is off by 3 % at most at the "
        "default, and by 21 % where the window is narrowest ($\\alpha = 0.5$, “gaussian”); in crops of 80 × 64 pixels "
        "by 5 % and 37 %, both of wooden boards, and the colours are a little others. A larger crop or a smaller "
        "$\\alpha$ helps.",
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

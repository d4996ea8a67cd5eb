"""Explanation of `transfer`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

LEAVES, SCENE = ("leaves_forest_floor", "0,0,512,512"), ("scene_china", "60,20,400,400")
ROCK, LICHEN, PLANKS = ((name, "0,0,512,512") for name in ("rock_mountain", "lichen_rock_gray", "planks_wood"))
SAND, PAVING = ("sand_desert009", "256,256,512,512"), ("crazy_paving001", "40,40,400,400")
WHOLE_LICHEN, CUT_LICHEN = ("lichen_rock_gray", "0,0,256,256"), ("lichen_rock_gray", "32,32,192,192")
EXACT = {"candidates": 0, "rescale": False, "seed": 1}

EXPLANATION = Explanation(
    what=(
        "Two pictures: a texture to paint with, and a pattern to paint. The pattern is covered by patches, as in "
        "patchwork, but a patch no longer comes from anywhere: a number of places of the texture are drawn at random, "
        "and the one that differs least from the pattern is taken.",
        "Taking the very best place of all follows the pattern most closely, and shows the same bit of the texture "
        "again and again. Few candidates give variety, and are quicker. The candidates of a seed are the first ones of "
        "a row, so more of them never match worse.",
        "What is compared is a square about the patch's centre, with sides of one and a half grids: the patch, and "
        "where it blends most with its neighbours. Pixels are compared in sixteenths of a grey level, in which all "
        "sums are exact. The pattern is given the mean and the range of the texture first, channel by channel, or its "
        "lights and darks might find nothing like them.",
        "In the joins the patches' deviations from their own averages are put together so that their standard "
        "deviation is kept, and the averages are blended plainly. They are shown below, with the pattern as it was "
        "compared, and with the cells, which wear the colour of their source: red grows to the right of the texture, "
        "green downwards. A patch whose blend zone is seen only beyond the border is read from the texture's mirror "
        "image where it leaves it.",
    ),
    formulas=(
        Formula(
            r"q_i = \underset{q \in Q_i}{\operatorname{argmin}} \sum_{x \in B_i} "
            r"\lVert P(x) - I(x - p_i + q) \rVert^2",
            r"The source of the patch about $p_i$: $P$ is the pattern, $I$ the texture, $B_i$ the square about $p_i$ "
            r"(what of it lies in the pattern), and $Q_i$ are the candidates, drawn where the blend zone lies inside "
            r"the texture.",
        ),
        Formula(
            r"O(x) = \frac{\sum_i \left( I(x - p_i + q_i) - a_i \right) w_i(x)}{\sqrt{\sum_i w_i(x)^2}} + "
            r"\frac{\sum_i a_i w_i(x)}{\sum_i w_i(x)}",
            r"The result. It differs from patchwork in the averages $a_i$, one for each patch, as there is no longer "
            r"one for all. The weights $w_i(x)$ are patchwork's: those of near patches, which end three grids from a "
            r"centre, or of all. What leaves the range is cut off.",
        ),
        Formula(
            r"a_i = \frac{\sum_x s_i(x)\, I(x - p_i + q_i)}{\sum_x s_i(x)}, \qquad "
            r"s_i(x) = \frac{w_i(x)}{\sum_j w_j(x)}",
            r"Each pixel counts in an average by the share that the patch has of it. So the deviations, blended "
            r"plainly, have the mean 0.",
        ),
        Formula(
            r"P'_c(x) = \left( P_c(x) - \overline{P_c} \right) \frac{\max I_c - \min I_c}{\max P_c - \min P_c} + "
            r"\overline{I_c}",
            r"The pattern's rescaled colours, for each channel $c$.",
        ),
    ),
    fails=(
        "With *all* patches and a low sharpness, as the article has it, many patches count far from where they were "
        "chosen to be, and draw the result away from the pattern: the pavilion in leaves below differs from it by "
        "43.6 levels (root mean square) at $f = 2$, and by 38.7 with *near* patches, which are therefore what you get "
        "if you do not ask. The two results differ by 10.9 of 48 levels at $f = 2$, 4.2 at $f = 3$, 1.1 at $f = 4$ and "
        "not at all from $f = 6$ on.",
        "A texture that is alike everywhere has no lights and darks to paint with: fine sand or a plain wall shows the "
        "pattern faintly or not at all. What it has is used up soon, and the rest of the pattern's contrast is lost.",
        "Detail that is smaller than the grid is lost as well. A smaller grid shows it, and loses the texture instead: "
        "its strokes, leaves or stones are cut into pieces.",
        "The joins keep the deviation of patches that have nothing to do with each other. Patches chosen for one and "
        "the same pattern are alike, and where they blend they are over-emphasised: contours get too strong, and "
        "light patches can stand out from a net of darker joins, the more candidates there are. A higher sharpness "
        "makes the joins narrow.",
    ),
    figures=(
        Figure(
            "A pavilion in leaves",
            "The texture, the pattern and the result.",
            (Exhibit("transfer", (LEAVES, SCENE), {"seed": 1}, ("crop", "crop-2", "texture")),),
        ),
        Figure(
            "In rock, lichen and planks",
            "The same pattern in other textures. Each lends it its own grain, and its own colours.",
            tuple(Exhibit("transfer", (texture, SCENE), {"seed": 1}) for texture in (ROCK, LICHEN, PLANKS)),
        ),
        Figure(
            "How many candidates",
            "With one candidate this is patchwork, and there is no pattern. Each ten times more follow the pattern "
            "more closely and repeat themselves more: look at the sky.",
            tuple(
                Exhibit("transfer", (LEAVES, SCENE), {"candidates": count, "seed": 1}, ("texture",), f"{count}")
                for count in (1, 20, 200, 2000)
            ),
        ),
        Figure(
            "Three grids",
            "Small patches draw the pattern, large ones show the leaves.",
            tuple(
                Exhibit("transfer", (LEAVES, PAVING), {"grid": grid, "seed": 1}, ("texture",), f"grid {grid}")
                for grid in (8, 16, 32)
            ),
        ),
        Figure(
            "Brush or mosaic",
            "The sharpness turns strokes that run into each other into chips.",
            tuple(
                Exhibit("transfer", (LEAVES, SCENE), {"sharpness": f, "seed": 1}, ("texture",), f"f = {f}")
                for f in (2, 6, 20)
            ),
        ),
        Figure(
            "Near patches and all",
            "At $f = 2$ patches that were chosen for other places leave their stains on the sky.",
            tuple(
                Exhibit("transfer", (LEAVES, SCENE), {"reach": reach, "seed": 1}, ("texture",), reach)
                for reach in ("near", "all")
            ),
        ),
        Figure(
            "What is put together",
            "The pattern in the leaves' colours, where its patches come from, their averages, and the result.",
            (Exhibit("transfer", (LEAVES, SCENE), {"seed": 1}, ("pattern", "cells", "average", "texture")),),
        ),
        Figure(
            "Nothing to paint with",
            "Rippled sand is lit alike everywhere: the pavilion is a breath of shade.",
            (Exhibit("transfer", (SAND, SCENE), {"seed": 1}),),
        ),
        Figure(
            "Patches that agree too well",
            "The pattern is a piece of the texture, and every patch finds its own place there. At the centres the "
            "result is the pattern, pixel for pixel; between them it is too strong, as the patches are the same "
            "image and not independent ones.",
            (Exhibit("transfer", (WHOLE_LICHEN, CUT_LICHEN), EXACT, ("crop-2", "texture")),),
        ),
    ),
)

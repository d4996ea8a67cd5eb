"""Explanation of `patchwork`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

BALLAST = (("ballast_railway", "96,96,320,320"),)
ROCK = (("rock_mountain", "0,0,512,512"),)
WALL = (("stonewall_rockwall", "0,0,512,512"),)
BRICKS = (("brick_gray", "0,0,512,512"),)
SKY = (("sky_clouds", "352,0,512,512"),)
WAVES = (("two_sinusoids", "0,0,256,256"),)
TWICE = {"width": 512, "height": 512, "seed": 1}

EXPLANATION = Explanation(
    what=(
        "Is copying random pieces of a sample all that it takes to make a texture? Harrison covers the texture with "
        "patches, each a piece of the crop from a random place, and looks for nothing: no patch is chosen to fit its "
        "neighbours. What makes it work is that the joins cannot be seen.",
        "The patches are Voronoi cells about the points of a jittered grid: irregular, because the eye finds regular "
        "patterns at once. Their edges are soft, and where two of them overlap the pixel is a weighted sum. Averaging "
        "two independent images leaves less contrast than either has, so a plain average, called feathering, shows as "
        "a dull seam. Here the sum of the deviations from the mean colour is divided by what keeps their "
        "*standard deviation* instead, and the join has the contrast of the crop.",
        "A patch may come from anywhere, as long as its blend zone (where it makes up more than a sixteenth of a "
        "pixel, by the weights of near patches) lies inside the crop. Of the faint rest, what would lie beyond the "
        "crop's border is read from the mirror image there.",
        "In the picture of the cells each wears the colour of the place that it shows, as in the key beside it; the "
        "key is dark where no cell shows the crop. At a centre the texture is the crop, pixel for pixel.",
    ),
    formulas=(
        Formula(
            r"w_i(x) = d(x, p_i)^{-f}",
            r"The weight of cell $i$ at the pixel $x$: a power of the distance to its centre $p_i$. The higher the "
            r"sharpness $f$, the harder the edge. If the texture is to tile, every cell of the plane counts once, by "
            r"the short way around the torus (on one of less than four grids a side also by other ways, up to two "
            r"grids); if not, cells up to three grids beyond the border take part as well. Left out are cells farther "
            r"away than 6 grids at $f \geq 3$, and than 44 at $f = 2$: all of them together are less than a hundredth "
            r"of the crop's standard deviation.",
        ),
        Formula(
            r"w_i(x) = \max\left(0, d(x, p_i)^{-f} - R^{-f}\right), \qquad R = 3 \text{ grids}",
            r"The same with *near* patches alone, a model of its own that takes little time at any size. From the sum "
            r"over all patches of a crop with a deviation of 36 levels it differs by 20 levels (root mean square) at "
            r"$f = 1$, by 4.5 at $f = 2$, 0.9 at $f = 3$ and 0.2 at $f = 4$; from $f = 6$ on by nothing that 8 bits "
            r"show, and it is what is computed there.",
        ),
        Formula(
            r"O(x) = \frac{\sum_i \left( I(x - p_i + q_i) - a \right) w_i(x)}{\sqrt{\sum_i w_i(x)^2}} + a",
            r"The texture: $I$ is the crop, $a$ its mean colour, and $q_i$ the random place in the crop that cell $i$ "
            r"shows. The patches are independent, so the variances of the terms add up, and the divisor gives the sum "
            r"the variance of the crop.",
        ),
        Formula(
            r"O_{\text{feather}}(x) = \frac{\sum_i I(x - p_i + q_i)\, w_i(x)}{\sum_i w_i(x)}",
            r"Feathering, for comparison: where two cells count as much as each other the deviation falls to "
            r"$1 / \sqrt{2}$ of the crop's.",
        ),
    ),
    fails=(
        "What is larger than a patch is cut: long cracks, large stones, rows of bricks. A larger grid keeps more of "
        "them, if the crop holds it; for arrangements that must fit together take Efros–Leung, which looks for what "
        "fits.",
        "Where light or colour change slowly across the crop, neighbouring patches differ as a whole and show as "
        "stains. Crop a more even region, or take random phase noise, which knows of no places.",
        "The divisor rests on patches that have nothing to do with each other. Where they happen to agree, as crests "
        "of a wave do, the sum is up to $\\sqrt{2}$ times too strong, and where they cancel too weak. For the same "
        "reason patches are better left to chance than chosen to match.",
        "A crop of hardly more than $3.5$ grids leaves few places to come from, and the same stone appears in many "
        "patches. Take a larger crop or a smaller grid.",
    ),
    figures=(
        Figure(
            "Three ways to join patches",
            "With the standard deviation kept, feathered, and cut sharply (figure 1 of the report). The first join "
            "cannot be found; feathering leaves grey mist between patches; sharp cuts break stones off.",
            tuple(
                Exhibit(
                    "patchwork",
                    BALLAST,
                    {"sharpness": 4, "blend": blend, "seed": 1},
                    ("crop", "texture") if blend == "deviation" else ("texture",),
                    label,
                )
                for blend, label in (("deviation", "deviation kept"), ("feather", "feathered"), ("sharp", "sharp"))
            ),
        ),
        Figure(
            "Shapes of patches",
            "The cells for three sharpnesses (figure 2 of the report), and what they make of the same sources.",
            tuple(
                Exhibit("patchwork", BALLAST, {"sharpness": f, "seed": 1}, ("cells", "texture"), f"f = {f}")
                for f in (2, 6, 20)
            ),
        ),
        Figure(
            "Structure that random phases lose",
            "Ledges and clefts are copied as they are, so they stay what they are, and one does not see where one "
            "piece ends and the next begins. Random phase noise keeps none of them.",
            (
                Exhibit("patchwork", ROCK, TWICE, label="patchwork"),
                Exhibit("rpn", ROCK, TWICE, ("texture",), "random phase noise"),
            ),
        ),
        Figure(
            "Three grids",
            "With a grid of 32 pixels the stones are broken up, with 128 most of them are whole; then there are few "
            "places that so large a patch can come from.",
            tuple(
                Exhibit(
                    "patchwork",
                    WALL,
                    {**TWICE, "grid": grid},
                    ("crop", "texture") if grid == 32 else ("texture",),
                    f"grid {grid}",
                )
                for grid in (32, 64, 128)
            ),
        ),
        Figure(
            "What must fit together",
            "Courses of bricks do not meet, and clouds from the bright and the dark part of the sky make stains.",
            (Exhibit("patchwork", BRICKS, TWICE), Exhibit("patchwork", SKY, TWICE)),
        ),
        Figure(
            "Patches that are not independent",
            "Two waves. Where crest meets crest a join is too strong, where crest meets trough it fades.",
            (Exhibit("patchwork", WAVES, TWICE, ("crop", "texture", "cells")),),
        ),
    ),
)

"""Explanation of `video-patchwork`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

SKY = (("sky_pan", "0,0,320,320"),)
SAND = (("sand_under_water", "0,0,320,320"),)
LEAVES = (("leaves_under_water", "0,0,320,320"),)
SMOKE = (("advected_noise", "0,0,320,320"),)

EXPLANATION = Explanation(
    what=(
        "Patches of the clip are put together at random, as the method patchwork does with a photograph. Time could be "
        "one more dimension: blocks of the clip, each a patch with a beginning and an end, fill the video. But then "
        "what stands still in the clip, a stone under water, comes and goes in the video.",
        "So time is treated by itself. The same patches are there in all frames, and each shows a sequence of its own: "
        "the clip's frames in a new order. A sequence follows the clip for some frames and then passes over into "
        "another part of it; where, and into which, is drawn at random for every patch. In a loop the last transition "
        "leads back to the beginning.",
        "A cross-fade of two frames is duller than either, because their differences from the average cancel in part. "
        "In time as in space the sum of the differences is therefore divided so that the deviation of every pixel "
        "stays what it was; the average image, what stands still, is not changed by that.",
        "In the picture of the cells red and green say where in the crop a cell is taken from, blue when in the clip. "
        "Like a video cube it shows the last frame on top and time running upwards.",
    ),
    formulas=(
        Formula(
            r"N(x, t) = \frac{w_1 I(x, t - p_i + q_i) + w_2 I(x, t - p_{i+1} + q_{i+1}) - A(x)}"
            r"{\sqrt{w_1^2 + w_2^2}} + A(x)",
            r"The sequence of a cell: frames $q_i$ of the clip $I$ are put at frames $p_i$, and between $p_i$ and "
            r"$p_{i+1}$ one part of the clip passes over into the other. $A$ is the average image.",
        ),
        Formula(
            r"w_1 = \frac{1}{2} + \frac{1}{2} \cos(\pi u), \quad w_2 = \frac{1}{2} - \frac{1}{2} \cos(\pi u), \quad "
            r"u = \frac{t - p_i}{p_{i+1} - p_i}",
            r"The weights. As $w_1 + w_2 = 1$, a pixel that never changes stays as it is.",
        ),
        Formula(
            r"O(x, t) = \frac{\sum_i (N_i(x - p_i + q_i, t) - a)\, w_i(x)}{\sqrt{\sum_i w_i(x)^2}} + a, \qquad "
            r"w_i(x) = d(x, p_i)^{-f}",
            r"Then every frame is a patchwork of the sequences' frames, with the same points $p_i$ and $q_i$ of the "
            r"plane for all frames; $a$ is the mean colour of the clip and $d$ the distance. In the mosaic $d$ is a "
            r"distance in space and time, and $N_i$ the clip. All patches count, beyond the crop's border and the "
            r"clip's ends with their mirror image. With near ones alone, whose weights end (at three grids, in the "
            r"mosaic at $1.75$), a frame of the sand under water differs by 2.8 of 24 levels (root mean square) at "
            r"$f = 2$, by 0.6 at $f = 3$ and by 0.1 at $f = 4$; in the mosaic by 8.6, 3.6 and 1.6. From $f = 6$ on "
            r"near ones are what is computed.",
        ),
    ),
    fails=(
        "Patches stand still while what is in them moves, so a common movement shows them: clouds that all drift one "
        "way are born at one border of a patch and die at the other. Random phase noise in three dimensions, "
        "video-rpn, has no patches and drifts as one.",
        "What is larger than a patch is cut, and what lasts longer than an interval is faded out. Take a larger grid "
        "or a longer interval, for which the crop and the clip must be larger and longer.",
        "The deviation is kept on the assumption that patches have nothing to do with each other. In a short clip the "
        "two parts of a transition may show nearly the same frames, and then contrast rises for a moment.",
    ),
    figures=(
        Figure(
            "Clips without an end",
            "Sand and leaves under water, and the videos made of them. The sand and the leaves lie still, the light "
            "and the water play on, and the last frame continues in the first.",
            (
                Exhibit("video-patchwork", SAND, {"seed": 1}, ("crop", "texture")),
                Exhibit("video-patchwork", LEAVES, {"seed": 1}, ("crop", "texture")),
            ),
        ),
        Figure(
            "The clip's cube and the video's",
            "Water over sand, smoke and clouds, each as a block with time running upwards. What stands still makes "
            "upright lines, and goes on to do so; what drifts makes slanted ones, which end where patches do.",
            (
                Exhibit("video-patchwork", SAND, {"seed": 1}, ("crop-cube", "cube"), "Sand under water"),
                Exhibit("video-patchwork", SMOKE, {"seed": 1}, ("crop-cube", "cube"), "Advected noise"),
                Exhibit("video-patchwork", SKY, {"seed": 1}, ("crop-cube", "cube"), "Clouds that drift"),
            ),
        ),
        Figure(
            "Why patches stand still",
            "The cells of the two arrangements over time, and the sand that each makes. Fixed cells keep the sand "
            "where it is while the light plays on it; in the mosaic it changes into other sand again and again.",
            (
                Exhibit("video-patchwork", SAND, {"seed": 1}, ("cells", "cube"), "Fixed"),
                Exhibit("video-patchwork", SAND, {"seed": 1, "arrangement": "mosaic"}, ("cells", "cube"), "Mosaic"),
            ),
        ),
        Figure(
            "Patches that show",
            "Clouds drift through the crop as one. In the texture every patch drifts by itself, and its borders stand "
            "still: with smaller patches more of them.",
            (
                Exhibit("video-patchwork", SKY, {"seed": 2}, ("cube",), "Grid 64"),
                Exhibit("video-patchwork", SKY, {"seed": 2, "grid": 24}, ("cube",), "Grid 24"),
                Exhibit("video-rpn", SKY, {"seed": 2}, ("cube",), "Video RPN"),
            ),
        ),
    ),
)

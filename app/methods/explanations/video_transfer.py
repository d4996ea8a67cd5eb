"""Explanation of `video-transfer`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

SCENE = ("scene_china", "60,20,400,400")

LEAVES, SMOKE, SKY, SAND = (
    (name, "0,0,320,320") for name in ("leaves_under_water", "advected_noise", "sky_pan", "sand_under_water")
)

EXPLANATION = Explanation(
    what=(
        "A picture, the pattern, is rendered in the texture of a clip, and moves as the clip does. The pattern is "
        "first given the mean and the range of the clip's average image, channel by channel; without rescaling it is "
        "compared as it is. Then, as in transfer, every patch is taken from the place of the average image that is "
        "most like the pattern there, among a few places drawn at random.",
        "From there on it is the video patchwork: every patch shows the clip at its place, with transitions in time of "
        "its own, and joins its neighbours. The mean is now a local one, that of each patch in the average image.",
    ),
    formulas=(
        Formula(
            r"q_i = \operatorname*{argmin}_{q \in Q_i} \sum_{x \in V_i} \left| P(x) - A(x - p_i + q) \right|^2",
            r"The source of cell $V_i$: among a random set $Q_i$ of places of the average image $A$ the one where the "
            r"sum of squared differences from the pattern $P$ is least.",
        ),
        Formula(
            r"O(x, t) = \frac{\sum_i (N_i(x - p_i + q_i, t) - a_i)\, w_i(x)}{\sqrt{\sum_i w_i(x)^2}} + "
            r"\frac{\sum_i a_i w_i(x)}{\sum_i w_i(x)}",
            r"Every frame is a transfer of the sequences' frames $N_i$ (see video patchwork): what differs from the "
            r"patches' means $a_i$ keeps its deviation, and the means pass over smoothly. As in transfer near patches "
            r"count if you do not ask for all: these take some eight times as long, and at $f = 2$ a frame of the "
            r"sand under water differs by 3.4 of 21 levels (root mean square), at $f = 3$ by 0.8 and at $f = 4$ by "
            r"0.2.",
        ),
    ),
    fails=(
        "Only what the average image shows can follow the pattern. A clip whose average is even, because everything in "
        "it moves, has no light and dark places to draw with.",
        "Patches that were chosen for being alike are not independent, and where they join contrast may rise. Large "
        "patches show little of the pattern, small ones little of the texture.",
    ),
    figures=(
        Figure(
            "A pavilion under water",
            "The clip, the pattern, the clip's average image, in which its light and dark places are looked for, and "
            "the video, whose first and last frames meet. All places of the average image are compared.",
            (
                Exhibit(
                    "video-transfer",
                    (LEAVES, SCENE),
                    {"seed": 1, "candidates": 0},
                    ("crop", "crop-2", "average", "texture"),
                ),
            ),
        ),
        Figure(
            "Fewer candidates",
            "Among two places drawn at random there is seldom a good one, among twenty often: the fewer, the more "
            "varied, and the harder to recognise.",
            tuple(
                Exhibit("video-transfer", (LEAVES, SCENE), {"seed": 1, "candidates": n}, ("texture",), f"{n} places")
                for n in (2, 20, 200)
            ),
        ),
        Figure(
            "Averages without contrast",
            "In smoke and in clouds everything moves: their averages are nearly even, and the scene is faint. The "
            "light on the sand wanders everywhere, and nothing of the scene is left.",
            tuple(
                Exhibit("video-transfer", (clip, SCENE), {"seed": 1, "candidates": 0}, ("texture",), label)
                for clip, label in ((SMOKE, "smoke"), (SKY, "clouds"), (SAND, "sand under water"))
            ),
        ),
    ),
)

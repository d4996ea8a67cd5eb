"""Explanation of `mix`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

EXPLANATION = Explanation(
    what=(
        "What lies between two textures? A Gaussian texture is told by its mean and covariance, so one asks for a law "
        "between two laws. The optimal transport distance compares them by moving one onto the other with the least "
        "effort, and the *barycentre* of several models is the law whose squared distances to them, weighted, have the "
        "least sum. The barycentres of two are a path from one to the other, of constant speed.",
        "For random phase textures all this happens frequency by frequency. In grey one averages the Fourier moduli, "
        "that is, the textons. In colour a phase is taken off every frequency of the second sample first, so that "
        "its colours there meet those of the first as closely as they can; for three samples and more, such phases "
        "are found by turns until none changes.",
        "One noise drives all textures along the path, which the optimal coupling turns into a cross-fade, pixel by "
        "pixel, of the two at its ends. What makes it a texture at every step is that those two are tuned to each "
        "other: their grains and stains lie at the same places. Independent ones would lose up to half of "
        "their variance in the middle.",
    ),
    formulas=(
        Formula(
            r"\hat{f}_\rho = (1 - \rho)\, \hat{f}_0 + \rho\, \hat{f}_1\, \frac{\hat{f}_1^* \hat{f}_0}"
            r"{\lvert \hat{f}_1^* \hat{f}_0 \rvert}, \qquad 0 \le \rho \le 1",
            r"$\hat{f}_0$ and $\hat{f}_1$ are the spectra of the two spots (vectors of their colours at each "
            r"frequency, with $\hat{f}_1^* \hat{f}_0$ for their inner product). Means go along a straight line.",
        ),
        Formula(
            r"W^2 = \sum_{\xi} \lVert \hat{f}_0(\xi) \rVert^2 + \lVert \hat{f}_1(\xi) \rVert^2 "
            r"- 2\, \lvert \hat{f}_1(\xi)^* \hat{f}_0(\xi) \rvert",
            r"The squared distance of the two models, up to a factor and that of their means: along the path it is "
            r"$(\rho - \rho')^2\, W^2$.",
        ),
        Formula(
            r"\hat{f} = \sum_i w_i\, \hat{f}_i\, \frac{\hat{f}_i^* \hat{f}}{\lvert \hat{f}_i^* \hat{f} \rvert}",
            r"For more samples, of weights $w_i$ of sum 1, the barycentre's spot is a fixed point of this map.",
        ),
    ),
    fails=(
        "It mixes models, and inherits what they lose: edges and objects are gone from every step, the ends included. "
        "Look at RPN or ADSN of each sample first.",
        "Two samples whose energy lies at different frequencies or in different directions have no texture of medium "
        "size or direction between them: halfway one sees both, each at half its contrast. Stripes do not turn, nor "
        "do grains grow.",
        "For four samples the textures keep to one random phase for all colours, which among all Gaussian textures "
        "might not be the very best; for two and three it is.",
    ),
    figures=(
        Figure(
            "From granite to grass",
            "Eight steps with one noise. The first is the ADSN of the granite, the last one of the grass.",
            (
                Exhibit(
                    "mix",
                    (("rockface_pink", "190,60,256,256"), ("grass_jungle002", "64,300,256,256")),
                    {"seed": 1},
                    ("crop", "crop-2", "strip"),
                ),
            ),
        ),
        Figure(
            "Three samples",
            "Sand, soil and lichen, and the barycentre of equal weights.",
            (
                Exhibit(
                    "mix",
                    (
                        ("sand_desert009", "256,256,256,256"),
                        ("soil_ground010", "416,352,256,256"),
                        ("lichen_rock_gray", "190,40,256,256"),
                    ),
                    {"seed": 1},
                    ("crop", "crop-2", "crop-3", "texture"),
                ),
            ),
        ),
        Figure(
            "What it cannot do",
            "Halfway between boards and paving there is neither: their edges were lost at the ends already.",
            (
                Exhibit(
                    "mix",
                    (("planks_wood", "96,160,256,256"), ("tiles02", "0,0,256,256")),
                    {"strip": 5, "seed": 1},
                    ("crop", "crop-2", "strip"),
                ),
            ),
        ),
    ),
)

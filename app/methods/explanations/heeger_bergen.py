"""Explanation of `heeger-bergen`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

SOIL = (("soil_ground010", "0,0,256,256"),)
DIRT = (("dirt003", "0,0,256,256"),)
SAND = (("sand_desert009", "0,0,256,256"),)
PAVING = (("crazy_paving001", "0,0,256,256"),)
TOWEL = (("towel_white", "0,0,256,256"),)

EXPLANATION = Explanation(
    what=(
        "Two textures look alike, say Heeger and Bergen, if filters that respond to detail of one size and direction, "
        "as cells of the visual cortex do, respond to both with the same histogram. So noise is made to: a steerable "
        "pyramid takes it apart into sub-bands, one for each scale and orientation, each sub-band is given the "
        "histogram that the crop's sub-band has, and the pyramid is put together again.",
        "That spoils the histogram of the pixels themselves, which is matched next, and that in turn spoils the "
        "sub-bands a little; hence a few iterations. The last step is the pixels', whose histogram is therefore exact; "
        "the distance that remains between the sub-bands' histograms is given with their picture, in parts of their "
        "deviation.",
        "Colours are taken apart into their principal components, which are not correlated, and each component is "
        "synthesised by itself. The pyramid and the histograms ask for no particular size: a larger texture takes "
        "interpolated quantiles of the crop's values.",
        "In the picture of the sub-bands a row is a scale, the finest first, and a column an orientation; mid-grey is "
        "the mean, black and white are three deviations from it. The last row has what is finer than all scales and "
        "what is coarser.",
    ),
    formulas=(
        Formula(
            r"B_s(r) = \cos\left(\frac{\pi}{2} (\log_2 r + s + 1)\right), \qquad 2^{-s-2} < r < 2^{-s}",
            r"The window of scale $s = 0, 1, \dots$ over the radial frequency $r$, with $r = 1$ at the Nyquist "
            r"frequency: two octaves around $2^{-s-1}$.",
        ),
        Formula(
            r"A_b(\theta) = \sqrt{\kappa} \, \cos^{Q-1}\left(\theta - \frac{\pi b}{Q}\right), \qquad "
            r"\sum_{b=0}^{Q-1} A_b(\theta)^2 = 1",
            r"That of orientation $b$ among $Q$ over the angle $\theta$; the sum fixes $\kappa$. A sub-band is the "
            r"image filtered with $B_s A_b$ (times $(-i)^{Q-1}$, which makes it real).",
        ),
        Formula(
            r"H^2 + \sum_{s,b} (B_s A_b)^2 + L^2 = 1",
            r"With the residuals $H$ and $L$ of the highest and lowest frequencies, filtering every sub-band with its "
            r"own filter once more and adding up gives the image back exactly.",
        ),
        Formula(
            r"v(x) \leftarrow F_u^{-1}\left(F_v(v(x))\right)",
            r"Matching the histogram of $v$ to that of $u$, with their distribution functions $F$: the value of a "
            r"given rank becomes the value of that rank.",
        ),
    ),
    fails=(
        "Histograms know no places. What is arranged over more than the coarsest filter, or by sub-bands acting "
        "together, is lost: the joints of a paving become splashes of the right colour, a weave its grain. Efros–Leung "
        "copies such things.",
        "Of the Fourier modulus only what the few broad filters see is kept. Long streaks and exact periods, which "
        "random phase noise keeps, are cut to pieces here: the two models fail on different textures, so try both.",
        "The principal components are synthesised independently, so a pixel may pair values of them that never meet "
        "in the crop. Where few colours dominate, that shows as specks of a foreign colour.",
        "A crop with slow changes of light gives stains. Periodic edges take out the change from one border to the "
        "other; mirrored edges keep it, and the stains are stronger.",
    ),
    figures=(
        Figure(
            "Pebbles stay pebbles",
            "A few stones on bare ground are rare, large values in the sub-bands, which Heeger–Bergen keeps. Random "
            "phase noise has no outliers: it spreads them evenly.",
            (
                Exhibit("heeger-bergen", SOIL, {"seed": 1}, label="Heeger–Bergen"),
                Exhibit("rpn", SOIL, {"seed": 1}, show=("texture",), label="RPN"),
            ),
        ),
        Figure(
            "From noise to texture",
            "Noise with the crop's colours, the first iteration, which does most of the work, and the fifth.",
            (Exhibit("heeger-bergen", DIRT, {"seed": 1}, show=("crop", "noise", "iteration-1", "texture")),),
        ),
        Figure(
            "Scales and orientations",
            "Ripples of sand and their sub-bands. Two scales see no ripples, only grain; one orientation sees them, "
            "but not their direction; six scales and four orientations see both.",
            (
                Exhibit("heeger-bergen", SAND, {"seed": 1}, show=("crop", "crop-bands")),
                Exhibit("heeger-bergen", SAND, {"seed": 1, "scales": 2}, show=("texture",), label="2 scales"),
                Exhibit(
                    "heeger-bergen", SAND, {"seed": 1, "orientations": 1}, show=("texture",), label="1 orientation"
                ),
                Exhibit("heeger-bergen", SAND, {"seed": 1, "scales": 6}, show=("texture",), label="6 scales"),
            ),
        ),
        Figure(
            "The right colours in the wrong places",
            "The joints of crazy paving keep their colour and their share of the area, unlike in random phase noise, "
            "but not their network.",
            (
                Exhibit("heeger-bergen", PAVING, {"seed": 1}, label="Heeger–Bergen"),
                Exhibit("rpn", PAVING, {"seed": 1}, show=("texture",), label="RPN"),
            ),
        ),
        Figure(
            "Order that is longer than the filters",
            "The rows of a towel run from side to side. Heeger–Bergen breaks them up; random phase noise keeps them.",
            (
                Exhibit("heeger-bergen", TOWEL, {"seed": 1}, label="Heeger–Bergen"),
                Exhibit("rpn", TOWEL, {"seed": 1}, show=("texture",), label="RPN"),
            ),
        ),
    ),
)

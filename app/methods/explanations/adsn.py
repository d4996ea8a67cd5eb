"""Explanation of `adsn`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

SINUSOIDS = (("two_sinusoids", "0,0,256,256"),)

EXPLANATION = Explanation(
    what=(
        "Throw copies of a spot onto a plane at random and add them up: that is a discrete spot noise. With ever more "
        "copies, centred and normalised, it tends to a Gaussian texture, the asymptotic discrete spot noise: the "
        "crop, without its mean, convolved with a Gaussian white noise.",
        "In the Fourier domain it differs from random phase noise by a factor alone: its modulus is multiplied by a "
        "Rayleigh noise. From one seed both have the same phase, so that they can be compared point by point.",
    ),
    formulas=(
        Formula(
            r"Z = m + \frac{1}{\sqrt{MN}}\, (h - m) * Y",
            r"$h$ is the crop of $M \times N$ pixels, or its extended spot, $m$ its mean and $Y$ a Gaussian white "
            r"noise of variance 1, the same for every channel.",
        ),
        Formula(
            r"\operatorname{Cov}\bigl(Z(x), Z(y)\bigr) = \frac{1}{MN} \sum_{t} (h(t) - m)\,(h(t + y - x) - m)^{T}",
            r"Its covariance is the autocorrelation of the crop: it is the Gaussian texture with the sample's mean and "
            r"covariance.",
        ),
    ),
    fails=(
        "A Gaussian texture is told by its mean and covariance: it is symmetric about its mean, has no edges and no "
        "isolated objects. Where random phase noise fails it fails, too.",
        "Where the spectrum holds a few frequencies only, its Rayleigh modulus may all but drop one of them, which "
        "random phase noise never does: see the two sinusoids above.",
    ),
    figures=(
        Figure(
            "A Gaussian texture",
            "Granite, and the asymptotic discrete spot noise that has its mean and covariance, on four times the area.",
            (Exhibit("adsn", (("rockface_pink", "190,60,256,256"),), {"width": 512, "height": 512, "seed": 2}),),
        ),
        Figure(
            "Beside random phase noise",
            "RPN and ADSN at one phase: the modulus of the second is random, too, and one hardly sees it.",
            (
                Exhibit("rpn", (("towel_red", "96,96,256,256"),), {"seed": 1}),
                Exhibit("adsn", (("towel_red", "96,96,256,256"),), {"seed": 1}, ("texture",)),
                Exhibit("rpn", (("concrete_img_0572", "128,64,256,256"),), {"seed": 1}),
                Exhibit("adsn", (("concrete_img_0572", "128,64,256,256"),), {"seed": 1}, ("texture",)),
            ),
        ),
        Figure(
            "Two frequencies only",
            "A drawing, and where the difference shows: RPN shifts the two sinusoids, ADSN makes one of them weak, "
            "another one for each seed. The drawing repeats by itself, so its periodic component is not taken.",
            (
                Exhibit("rpn", SINUSOIDS, {"seed": 1, "periodic": False}),
                *(
                    Exhibit("adsn", SINUSOIDS, {"seed": seed, "periodic": False}, ("texture",), f"ADSN, seed {seed}")
                    for seed in (5, 15)
                ),
            ),
        ),
        Figure(
            "What it cannot do",
            "Stones and joints do not have a Gaussian distribution: what is bright and what is dark is not "
            "interchangeable, and neither has an outline any more.",
            (
                Exhibit("adsn", (("stonewall_rockwall", "128,128,256,256"),), {"seed": 2}),
                Exhibit("adsn", (("crazy_paving001", "80,80,256,256"),), {"seed": 2}),
            ),
        ),
    ),
)

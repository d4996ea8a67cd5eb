"""Explanation of `rayleigh`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

EXPLANATION = Explanation(
    what=(
        "Random phase noise and asymptotic discrete spot noise have the same phase and differ by a white Rayleigh "
        "noise on the modulus, and yet one takes them for each other. Is the eye blind to this noise? Here it is put "
        "on the photograph itself: its phase is kept, its modulus multiplied by independent Rayleigh numbers.",
        "A photograph with contours does not bear it: a woven haze spreads over all that was smooth, and contours fade "
        "in it. A random phase texture looks the same before and after. That only such textures bear it may be what "
        "characterises them. Below the crop, its random phase noise (RPN) undergoes the very same multiplication, "
        "which makes it an ADSN.",
        "The noise is put on the periodic component of the crop, as in all the experiments of the article, so that "
        "the jump between opposite borders does not spread as streaks. Measured pixel by pixel both suffer alike: the "
        r"correlation with what was before is about $\sqrt{\pi}/2 \approx 0.89$ whatever the image.",
    ),
    formulas=(
        Formula(
            r"\hat{z}(\xi) = R(\xi)\, \hat{p}(\xi), \qquad R(-\xi) = R(\xi), \quad R(0) = 1",
            r"$p$ is the periodic component of the crop and $R$ a white Rayleigh noise, the same for every channel; "
            r"the phase of $\hat{p}$ and the mean stay.",
        ),
        Formula(
            r"\mathbb{P}(R > r) = e^{-r^2}, \qquad \mathbb{E}(R^2) = 1, \qquad \mathbb{E}(R) = \frac{\sqrt{\pi}}{2}",
            r"It keeps the energy of every frequency on the average, and is the modulus noise of the ADSN of the same "
            r"seed.",
        ),
    ),
    fails=(
        "It makes no new texture: the phase, and with it the place of everything, is the crop's. It is an experiment "
        "on what one sees; for a texture take RPN or ADSN.",
        "A structure that fills the crop evenly, such as gravel of one size, is nearly a random phase texture and "
        "bears the noise nearly as well: look for contours and for surfaces without grain. And where a few frequencies "
        "hold most of the energy, as in a row of tiles, even a random phase texture shows which of them the noise "
        "favours.",
    ),
    figures=(
        Figure(
            "A scene does not bear it",
            "A whole photograph, and the same under Rayleigh noise: a haze lies over sky and lake.",
            (Exhibit("rayleigh", (("scene_china", "0,0,640,427"),), {"seed": 1}),),
        ),
        Figure(
            "What has contours is damaged, its random phase texture is not",
            "Crazy paving under the noise; and its random phase noise, before and after the same multiplication.",
            (
                Exhibit(
                    "rayleigh", (("crazy_paving001", "80,80,256,256"),), {"seed": 1}, ("crop", "texture", "rpn", "adsn")
                ),
            ),
        ),
        Figure(
            "A micro-texture bears it",
            "Granite is nearly a random phase texture already: with and without the noise it is the same stone.",
            (Exhibit("rayleigh", (("rockface_pink", "190,60,256,256"),), {"seed": 1}),),
        ),
    ),
)

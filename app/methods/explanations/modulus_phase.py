"""Explanation of `modulus-phase`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

EXPLANATION = Explanation(
    what=(
        "A picture's Fourier transform has a modulus, which says how strong each oscillation is, and a phase, which "
        "says where its crests lie. Give a picture the phase of another and keep its modulus: which of the two "
        "does one then see?",
        "Contours are where the crests of many oscillations meet: they follow the phase. A grain, and how rough or "
        "streaked a surface is, follows the modulus. So a photograph with the modulus of a texture keeps its drawing "
        "and takes on that texture's surface, and the other way round of the texture only its frequencies remain. That "
        "is why a texture can be made from a modulus and a random phase, and why a house cannot.",
        "Each channel is swapped on its own, on the crops as they are, and from a larger crop its centre is taken. "
        "Swapping twice gives both back. The bright cross in the modulus comes from the jump between opposite borders: "
        "RPN takes it out by means of the periodic component.",
    ),
    formulas=(
        Formula(
            r"\hat{t}(\xi) = \lvert \hat{a}(\xi) \rvert \, e^{i \operatorname{arg} \hat{b}(\xi)}, \qquad "
            r"\hat{o}(\xi) = \lvert \hat{b}(\xi) \rvert \, e^{i \operatorname{arg} \hat{a}(\xi)}",
            r"$a$ and $b$ are the two crops, $t$ and $o$ the swapped pictures; at the origin the modulus is the mean's "
            r"and the phase its sign.",
        ),
        Formula(
            r"\sum_x \lvert t(x) \rvert^2 = \sum_x \lvert a(x) \rvert^2, \qquad t * \tilde{t} = a * \tilde{a}",
            r"Energy and autocorrelation go with the modulus (with $\tilde{a}(x) = a(-x)$, on the torus): as far as "
            r"a Gaussian model can tell, $t$ is $a$.",
        ),
    ),
    fails=(
        "If the modulus belongs to a picture with few and strong frequencies, such as a wall of tiles, the swapped "
        "picture shows these frequencies as stripes whatever the phase; and where the picture that gave the phase is "
        "flat, its phase is but noise.",
        "The colours are those of the modulus on the average, but the phases of the other picture shift the channels "
        "against each other: false colours appear at its contours. Values that leave the range of the samples are cut "
        "off, so the pictures, unlike the numbers, do not swap back exactly.",
    ),
    figures=(
        Figure(
            "The drawing follows the phase",
            "Modulus of clouds, phase of a pavilion: a pavilion in the clouds' colours and softness. The other way "
            "round the clouds' outlines remain, in harsh streaks and colours of the pavilion.",
            (
                Exhibit(
                    "modulus-phase",
                    (("sky_clouds", "352,64,427,427"), ("scene_china", "0,0,427,427")),
                    {},
                    ("crop", "crop-2", "texture", "other"),
                ),
            ),
        ),
        Figure(
            "The surface follows the modulus",
            "Grass laid out like paving. The regular tiles are strong in a few frequencies, which show as stripes "
            "where the phase is that of the grass.",
            (
                Exhibit(
                    "modulus-phase",
                    (("grass_jungle002", "64,300,256,256"), ("tiles02", "0,0,256,256")),
                    {},
                    ("crop", "crop-2", "texture", "other"),
                ),
            ),
        ),
        Figure(
            "Modulus and phase of each",
            "The modulus tells two pictures apart at a glance; their phases both look like noise, and yet they "
            "hold the drawing.",
            (
                Exhibit(
                    "modulus-phase",
                    (("gravel_gray", "96,96,256,256"), ("scene_china", "80,20,256,256")),
                    {},
                    ("modulus", "phase", "modulus-2", "phase-2", "texture"),
                ),
            ),
        ),
    ),
)

"""`modulus-phase`: the swap of Oppenheim and Lim."""

from collections.abc import Iterator, Sequence

import numpy as np
from pydantic import Field

from app.errors import InvalidInputError
from app.methods.announced import shown_inputs, texture, views
from app.methods.explanation import Exhibit, Explanation, Figure, Formula
from app.methods.model import MAX_SEED, Context, Method, Picture, Size, Slot, Source, StillParams
from app.methods.options import WHOLE_IN_MEMORY
from app.methods.pictures import crops, encode, log_modulus, refuse_infinite
from app.methods.references import OPPENHEIM_LIM, RANDOM_PHASE_TEXTURES
from app.methods.several import alike
from app.numbers import FAR
from app.synthesis.modulus_phase import centred_phase, power, swap
from app.synthesis.spot import centre


class ModulusPhaseParams(StillParams):
    """Parameters of the swap: those that all methods have. Nothing is drawn at random."""

    width: int | None = Field(
        None,
        ge=1,
        le=FAR,
        title="Width",
        description="Pixels of the texture; default: as the narrower crop. Both are centred.",
    )
    height: int | None = Field(
        None,
        ge=1,
        le=FAR,
        title="Height",
        description="Pixels of the texture; default: as the lower crop. Both are centred.",
    )
    seed: int = Field(
        0,
        ge=0,
        le=MAX_SEED,
        title="Seed",
        description="Start of the random numbers; none are drawn here, so it changes nothing.",
    )


def common_size(sizes: Sequence[Size]) -> tuple[int, int]:
    """Width and height that both crops have."""
    return min(size.width for size in sizes), min(size.height for size in sizes)


def check(sizes: Sequence[Size], params: ModulusPhaseParams) -> None:
    """Refuse a size beyond that of either crop."""
    for name, most in zip(("width", "height"), common_size(sizes), strict=True):
        asked = getattr(params, name)
        if asked and asked > most:
            raise InvalidInputError(
                f"Modulus and phase are swapped pixel for pixel, so the {name} can be at most that of the smaller "
                f"crop, {most} pixels, and {asked} is asked for: take larger crops, or a smaller {name}.",
                f"parameters.{name}",
            )


def run(sources: Sequence[Source], params: ModulusPhaseParams, context: Context) -> Iterator[Picture]:
    """Both swapped pictures; then modulus and phase of each crop."""
    sizes = [source.size for source in sources]
    check(sizes, params)
    refuse_infinite(sources)
    width, height = common_size(sizes)
    width, height = params.width or width, params.height or height
    peak = sources[0].peak
    images = [centre(pixels, height, width) for pixels in alike(sources)]
    one, other = swap(images[0], images[1], context.threads, context.between(0, 0.5))
    yield encode("texture", "Modulus of the first, phase of the second", one, peak, context, kind="texture")
    context.progress("swap", 0.55)
    yield encode("other", "Modulus of the second, phase of the first", other, peak, context, kind="texture")
    context.progress("crops", 0.6)
    yield from crops(sources, context)
    for number, image in enumerate(images):
        which, suffix = ("first", "") if number == 0 else ("second", "-2")
        context.progress("spectra", 0.65 + 0.15 * number)
        squares = power(image.transpose(2, 0, 1), context.threads)
        yield log_modulus(f"modulus{suffix}", f"Log-modulus of the {which}", squares, width, context)
        context.progress("spectra", 0.7 + 0.15 * number)
        phase = centred_phase(image, context.threads) / np.float32(2 * np.pi) + np.float32(0.5)
        yield encode(f"phase{suffix}", f"Phase of the {which}, black −π to white π", phase, 1, context)
    context.progress("spectra", 1.0)


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

MODULUS_PHASE = Method(
    name="modulus-phase",
    title="Swap of modulus and phase",
    summary="The Fourier modulus of one picture with the phase of another, both ways.",
    inputs=(
        Slot("modulus", "Modulus", "A photograph, of which the first picture takes the Fourier modulus."),
        Slot("phase", "Phase", "A photograph, of which the first picture takes the phase."),
    ),
    params=ModulusPhaseParams,
    references=(OPPENHEIM_LIM, RANDOM_PHASE_TEXTURES),
    explanation=EXPLANATION,
    check=check,
    run=run,
    outputs=(
        texture(),
        texture("other"),
        *shown_inputs(2, least=2),
        *views("modulus", deep=False),
        *views("phase"),
        *views("modulus-2", deep=False),
        *views("phase-2"),
    ),
    most_pixels=WHOLE_IN_MEMORY,
    size=common_size,
    toroidal=lambda params: False,
)

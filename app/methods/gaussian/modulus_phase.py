"""`modulus-phase`: the swap of Oppenheim and Lim."""

from collections.abc import Iterator, Sequence

import numpy as np
from pydantic import Field

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.explanations.modulus_phase import EXPLANATION
from app.methods.explanations.references import OPPENHEIM_LIM, RANDOM_PHASE_TEXTURES
from app.methods.inputs import alike
from app.methods.model import Method, Picture, Size, Slot, Source
from app.methods.output.pictures import crops, encode, log_modulus
from app.methods.outputs import shown_inputs, texture, views
from app.methods.params import MAX_SEED, WHOLE_IN_MEMORY, Resolved, StillParams
from app.numbers import FAR
from app.synthesis.fourier.spot import centre
from app.synthesis.gaussian.modulus_phase import centred_phase, power, swap


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


def check(sizes: Sequence[Size], resolved: Resolved[ModulusPhaseParams]) -> None:
    """Refuse a size beyond that of either crop."""
    widest, highest = common_size(sizes)
    for name, length, most in (("width", resolved.width, widest), ("height", resolved.height, highest)):
        if length > most:
            raise InvalidInputError(
                f"Choose a {name} of at most {most} pixels instead of {length}, or larger crops: modulus and phase are "
                f"swapped pixel for pixel, and the smaller crop has a {name} of {most}.",
                f"parameters.{name}",
            )


def run(sources: Sequence[Source], resolved: Resolved[ModulusPhaseParams], context: Context) -> Iterator[Picture]:
    """Both swapped pictures; then modulus and phase of each crop."""
    width, height = resolved.width, resolved.height
    peak = sources[0].peak
    images = [centre(pixels, height, width) for pixels in alike(sources)]
    one, other = swap(images[0], images[1], context.threads, context.progress)
    yield encode("texture", "Modulus of the first, phase of the second", one, peak, context, kind="texture")
    yield encode("other", "Modulus of the second, phase of the first", other, peak, context, kind="texture")
    context.progress("crops", 0)
    yield from crops(sources, context)
    for number, image in enumerate(images):
        which, suffix = ("first", "") if number == 0 else ("second", "-2")
        context.progress("spectra", 2 * number / 4)
        squares = power(image.transpose(2, 0, 1), context.threads)
        yield log_modulus(f"modulus{suffix}", f"Log-modulus of the {which}", squares, width, context)
        context.progress("spectra", (2 * number + 1) / 4)
        phase = centred_phase(image, context.threads) / np.float32(2 * np.pi) + np.float32(0.5)
        yield encode(f"phase{suffix}", f"Phase of the {which}, black −π to white π", phase, 1, context)


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
    stages=lambda sizes, resolved: (("swap", 60), ("crops", 5), ("spectra", 35)),
    most_pixels=WHOLE_IN_MEMORY,
    size=common_size,
    toroidal=lambda params: False,
)

"""`rayleigh`: Rayleigh noise on the modulus, with the phase kept."""

from collections.abc import Iterator, Sequence

import numpy as np

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.explanations.rayleigh import EXPLANATION
from app.methods.explanations.references import PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.methods.inputs import INPUTS
from app.methods.model import Fact, Method, Picture, Size, Source
from app.methods.output.pictures import crops, encode, log_modulus
from app.methods.outputs import shown_inputs, texture, views
from app.methods.params import WHOLE_IN_MEMORY, Resolved, StillParams
from app.methods.stages import Plan
from app.synthesis.arrays import Real
from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.fourier.spot import centre
from app.synthesis.gaussian.adsn import adsn
from app.synthesis.gaussian.modulus_phase import power
from app.synthesis.gaussian.rayleigh import rayleigh
from app.synthesis.gaussian.rpn import rpn


def check(sizes: Sequence[Size], resolved: Resolved[StillParams]) -> None:
    """Refuse a size beyond the crop's."""
    size = sizes[0]
    for name, length, most in (("width", resolved.width, size.width), ("height", resolved.height, size.height)):
        if length > most:
            raise InvalidInputError(
                f"Choose a {name} of at most {most} pixels, the crop's own, instead of {length}, or a larger crop: the "
                "phase of the crop is kept, and there is none beyond it.",
                f"parameters.{name}",
            )


def run(sources: Sequence[Source], resolved: Resolved[StillParams], context: Context) -> Iterator[Picture]:
    """The crop under the noise; then its random phase noise, without and with the same noise."""
    source = sources[0]
    h, peak = source.pixels, source.peak
    seed, height, width = resolved.params.seed, resolved.height, resolved.width
    z = rayleigh(h, height, width, seed=seed, threads=context.threads, progress=context.progress)
    context.progress("periodic", 0)
    p = periodic_component(centre(h, height, width), context.threads)
    context.progress("correlation", 0)
    fact = Fact("correlation", "Correlation with the periodic component", _correlation(p, z))
    yield encode("texture", "Rayleigh noise on the modulus", z, peak, context, kind="texture", facts=(fact,))
    context.progress("pictures", 0)
    yield from crops(sources, context)
    yield encode("periodic", "Periodic component", p, peak, context)
    for name, model, title in (
        ("rpn", rpn, "RPN of the crop"),
        ("adsn", adsn, "The same with Rayleigh noise: ADSN"),
    ):
        progress = context.during(name, (("spot", 1), ("random phase", 1), ("texture", 1)))
        texture = model(h, height, width, seed=seed, threads=context.threads, progress=progress)
        yield encode(name, title, texture, peak, context, kind="texture")
    for name, title, image in (
        ("input-spectrum", "Log-modulus of the periodic component", p),
        ("output-spectrum", "Log-modulus with Rayleigh noise", z),
    ):
        context.progress(name, 0)
        yield log_modulus(name, title, power(image.transpose(2, 0, 1), context.threads), width, context)


STAGES: Plan = (
    ("rayleigh noise", 25),
    ("periodic", 5),
    ("correlation", 3),
    ("pictures", 2),
    ("rpn", 25),
    ("adsn", 25),
    ("input-spectrum", 5),
    ("output-spectrum", 5),
)


def _correlation(p: Real, z: Real) -> float:
    """Over all pixels and channels, each channel about its own mean; 1 for an image without contrast."""
    products = np.zeros(3)
    for channel in range(p.shape[2]):
        one, other = (image[:, :, channel] - float(image[:, :, channel].mean(dtype=np.float64)) for image in (p, z))
        products += [np.mean(a * b, dtype=np.float64) for a, b in ((one, other), (one, one), (other, other))]
    scale = float(np.sqrt(products[1] * products[2]))
    return float(products[0]) / scale if scale else 1.0


RAYLEIGH = Method(
    name="rayleigh",
    title="Rayleigh noise on the modulus",
    summary="Keeps the phase of the crop and multiplies its Fourier modulus by Rayleigh noise.",
    inputs=INPUTS,
    params=StillParams,
    references=(RANDOM_PHASE_TEXTURES, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    check=check,
    run=run,
    outputs=(
        texture(),
        *shown_inputs(),
        *views("periodic"),
        texture("rpn"),
        texture("adsn"),
        *views("input-spectrum", "output-spectrum", deep=False),
    ),
    stages=lambda sizes, resolved: STAGES,
    most_pixels=WHOLE_IN_MEMORY,
)

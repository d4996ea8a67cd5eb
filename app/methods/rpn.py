"""`rpn`: random phase noise."""

from functools import partial

from app.methods.explanations.references import IPOL_RPN, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.methods.explanations.rpn import EXPLANATION
from app.methods.model import Method
from app.methods.options import not_extended
from app.methods.random_phase import INPUTS, OUTPUTS, RandomPhaseParams, check, run, toroidal

RPN = Method(
    name="rpn",
    title="Random phase noise (RPN)",
    summary="Keeps the Fourier modulus of the crop and draws its phase at random.",
    inputs=INPUTS,
    params=RandomPhaseParams,
    references=(IPOL_RPN, RANDOM_PHASE_TEXTURES, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    check=check,
    run=partial(run, rayleigh=False),
    outputs=OUTPUTS,
    toroidal=toroidal,
    phase=True,
    idle=not_extended,
)

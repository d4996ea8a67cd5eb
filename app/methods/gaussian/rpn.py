"""`rpn`: random phase noise."""

from functools import partial

from app.methods.explanations.references import IPOL_RPN, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.methods.explanations.rpn import EXPLANATION
from app.methods.gaussian.params import not_extended
from app.methods.gaussian.random_phase import OUTPUTS, RandomPhaseParams, check, run, stages, toroidal
from app.methods.inputs import INPUTS
from app.methods.model import Method
from app.synthesis.gaussian.rpn import rpn_field

RPN = Method(
    name="rpn",
    title="Random phase noise (RPN)",
    summary="Keeps the Fourier modulus of the crop and draws its phase at random.",
    inputs=INPUTS,
    params=RandomPhaseParams,
    references=(IPOL_RPN, RANDOM_PHASE_TEXTURES, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    check=check,
    run=partial(run, model=rpn_field),
    outputs=OUTPUTS,
    stages=stages,
    toroidal=toroidal,
    phase=True,
    idle=not_extended,
)

"""`adsn`: asymptotic discrete spot noise."""

from functools import partial

from app.methods.explanations.adsn import EXPLANATION
from app.methods.explanations.references import IPOL_RPN, PERIODIC_PLUS_SMOOTH, RANDOM_PHASE_TEXTURES
from app.methods.gaussian.params import not_extended
from app.methods.gaussian.random_phase import OUTPUTS, RandomPhaseParams, check, run, stages, toroidal
from app.methods.inputs import INPUTS
from app.methods.model import Method
from app.synthesis.gaussian.adsn import adsn_field

ADSN = Method(
    name="adsn",
    title="Asymptotic discrete spot noise (ADSN)",
    summary="The Gaussian texture that has the crop's mean and covariance.",
    inputs=INPUTS,
    params=RandomPhaseParams,
    references=(RANDOM_PHASE_TEXTURES, IPOL_RPN, PERIODIC_PLUS_SMOOTH),
    explanation=EXPLANATION,
    check=check,
    run=partial(run, model=adsn_field),
    outputs=OUTPUTS,
    stages=stages,
    toroidal=toroidal,
    phase=True,
    idle=not_extended,
)

"""Registry of the methods, by name."""

from app.errors import InvalidInputError, NotFoundError
from app.methods.gaussian.adsn import ADSN
from app.methods.gaussian.dsn import DSN
from app.methods.gaussian.mix import MIX
from app.methods.gaussian.modulus_phase import MODULUS_PHASE
from app.methods.gaussian.rayleigh import RAYLEIGH
from app.methods.gaussian.rpn import RPN
from app.methods.gaussian.texton import TEXTON
from app.methods.gaussian.video_rpn import VIDEO_RPN
from app.methods.model import Method
from app.methods.patchwork.patchwork import PATCHWORK
from app.methods.patchwork.transfer import TRANSFER
from app.methods.patchwork.video_patchwork import VIDEO_PATCHWORK
from app.methods.patchwork.video_transfer import VIDEO_TRANSFER
from app.methods.pyramid.heeger_bergen import HEEGER_BERGEN
from app.methods.sampling.efros_leung import EFROS_LEUNG
from app.numbers import quote

METHODS: dict[str, Method] = {
    "rpn": RPN,
    "adsn": ADSN,
    "dsn": DSN,
    "texton": TEXTON,
    "mix": MIX,
    "modulus-phase": MODULUS_PHASE,
    "rayleigh": RAYLEIGH,
    "heeger-bergen": HEEGER_BERGEN,
    "efros-leung": EFROS_LEUNG,
    "patchwork": PATCHWORK,
    "transfer": TRANSFER,
    "video-rpn": VIDEO_RPN,
    "video-patchwork": VIDEO_PATCHWORK,
    "video-transfer": VIDEO_TRANSFER,
}


def method(name: str) -> Method:
    """Look up a method by its name.

    Raises
    ------
    NotFoundError
        With the names there are.
    """
    if name not in METHODS:
        raise NotFoundError(_no_method(name))
    return METHODS[name]


def refuse_unknown(name: str) -> None:
    """Raise `InvalidInputError` at ``method``, with the names there are, unless there is a method of this name."""
    if name not in METHODS:
        raise InvalidInputError(_no_method(name), "method")


def _no_method(name: str) -> str:
    return f"There is no method {quote(name)}. The methods are: {', '.join(METHODS)}."

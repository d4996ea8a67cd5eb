"""The registry: every method of the service, by name."""

from app.errors import NotFoundError
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
    """The method of this name.

    Raises
    ------
    NotFoundError
        With the names there are.
    """
    try:
        return METHODS[name]
    except KeyError:
        raise NotFoundError(f"There is no method {name!r}. The methods are: {', '.join(METHODS)}.") from None

"""The registry: every method of the service, by name."""

from app.errors import NotFoundError
from app.methods.adsn import ADSN
from app.methods.dsn import DSN
from app.methods.efros_leung import EFROS_LEUNG
from app.methods.heeger_bergen import HEEGER_BERGEN
from app.methods.mix import MIX
from app.methods.model import Method
from app.methods.modulus_phase import MODULUS_PHASE
from app.methods.patchwork import PATCHWORK
from app.methods.rayleigh import RAYLEIGH
from app.methods.rpn import RPN
from app.methods.texton import TEXTON
from app.methods.transfer import TRANSFER
from app.methods.video_patchwork import VIDEO_PATCHWORK
from app.methods.video_rpn import VIDEO_RPN
from app.methods.video_transfer import VIDEO_TRANSFER

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

"""Parameters of the spot extension."""

from collections.abc import Sequence
from typing import Literal

from pydantic import Field

from app.methods.model import Size
from app.methods.params import ADVANCED, Resolved, StillParams


class SpotParams(StillParams):
    """Parameters of the methods that extend a spot to a larger texture."""

    alpha: float = Field(
        0.1,
        ge=0,
        le=0.5,
        title="Transition α",
        description="Fraction of the crop's side over which its border fades out before it is pasted into a larger "
        "image; only for textures larger than the crop. 0 cuts sharply and may leave streaks.",
        json_schema_extra=ADVANCED,
    )
    window: Literal["bump", "gaussian"] = Field(
        "bump",
        title="Window",
        description="How the crop fades out along its border: 'bump' is the smooth step of the IPOL article (usual α: "
        "0.1), 'gaussian' the profile of the TIP article (usual α: 0.2).",
        json_schema_extra=ADVANCED,
    )


NOT_EXTENDED = "the crop fades out only in a texture that is larger than it; choose a larger one, or leave it out"
NO_BAND = "with α = 0 there is no band in which the crop fades out; choose another α, or leave it out"


def not_extended(sizes: Sequence[Size], resolved: Resolved[SpotParams]) -> dict[str, str]:
    """Say of the extension's parameters that they are idle where the texture is larger than no crop on any axis."""
    for size in sizes:
        if resolved.width > size.width or resolved.height > size.height or resolved.frames > size.frames:
            return {"window": f"{NO_BAND}."} if resolved.params.alpha == 0 else {}
    return dict.fromkeys(("alpha", "window"), f"{NOT_EXTENDED}.")

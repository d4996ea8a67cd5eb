"""Parameters that several methods share."""

from typing import Literal

from pydantic import Field
from pydantic.config import JsonDict

from app.methods.model import StillParams

ADVANCED: JsonDict = {"advanced": True}


class SpotParams(StillParams):
    """Parameters of the methods that extend a spot to a larger texture."""

    alpha: float = Field(
        0.1,
        ge=0,
        le=0.5,
        title="Transition α",
        description="Width of the band along the border of the crop, as a part of its side, in which it fades out "
        "before it is pasted into a larger image; only for textures larger than the crop. 0 cuts sharply and may "
        "leave streaks.",
        json_schema_extra=ADVANCED,
    )
    window: Literal["bump", "gaussian"] = Field(
        "bump",
        title="Window",
        description="How the crop fades out along its border: 'bump' is the smooth step of the IPOL article (usual α: "
        "0.1), 'gaussian' the profile of the TIP article (usual α: 0.2).",
        json_schema_extra=ADVANCED,
    )

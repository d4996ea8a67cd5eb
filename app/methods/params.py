"""Parameters of all methods and of all video methods, as typed and resolved."""

from dataclasses import dataclass
from typing import Generic, TypeVar

from pydantic import BaseModel, ConfigDict, Field
from pydantic.config import JsonDict

from app.numbers import FAR

ADVANCED: JsonDict = {"advanced": True}
WHOLE_IN_MEMORY = 1 << 24  # pixels; what holds several float pictures of the texture's size then stays within 1.5 GB
MAX_SEED = 2**53 - 1  # the largest whole number that JSON readers in JavaScript keep exactly
ADD_SMOOTH = Field(
    False,
    title="Add the smooth component",
    description="Put the slow changes of light and colour across the crop, which are taken out before the synthesis, "
    "back in afterwards. Only for a texture of the crop's own size; it then no longer tiles without a seam.",
    json_schema_extra=ADVANCED,
)


class StillParams(BaseModel):
    """Parameters that every still-image method has."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    width: int | None = Field(
        None, ge=1, le=FAR, title="Width", description="Pixels of the texture; default: as the crop."
    )
    height: int | None = Field(
        None, ge=1, le=FAR, title="Height", description="Pixels of the texture; default: as the crop."
    )
    seed: int = Field(
        0,
        ge=0,
        le=MAX_SEED,
        title="Seed",
        description="Start of the random numbers: the same seed gives the same texture, another seed another one.",
    )


class MovingParams(StillParams):
    """Parameters of every video method: frames besides."""

    frames: int | None = Field(
        None, ge=2, le=FAR, title="Frames", description="Frames of the video; default: as the clip."
    )


class LoopParams(MovingParams):
    """Parameters of the video methods that can make a loop."""

    loop: bool = Field(
        True,
        title="Loop",
        description="The last frame continues in the first, so that the video plays for ever without a jump.",
    )


class SeamlessParams(LoopParams):
    """Parameters of the video methods whose frames can tile, too."""

    tileable: bool = Field(
        True, title="Tileable", description="Opposite edges of every frame meet, so that it tiles without a seam."
    )


P_co = TypeVar("P_co", bound=StillParams, covariant=True)


@dataclass(frozen=True)
class Resolved(Generic[P_co]):
    """A method's parameters with the size of the texture filled in: what a run starts from.

    Parameters
    ----------
    params : StillParams
        The method's own, whose width, height and frames are those below.
    width, height : int
        Pixels of the texture.
    frames : int
        Of a video; 1 of a still texture.
    """

    params: P_co
    width: int
    height: int
    frames: int = 1

    @property
    def shape(self) -> tuple[int, int, int]:
        """Frames, height and width, in the order of an array's axes."""
        return self.frames, self.height, self.width

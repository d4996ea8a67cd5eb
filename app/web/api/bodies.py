"""The JSON that is sent to the API."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from app.experiments.submission import NewInput
from app.images.crop import Frames, Rectangle

IDENTIFIER = r"^[A-Za-z0-9_-]{1,64}$"
Identifier = Annotated[str, StringConstraints(pattern=IDENTIFIER)]
_FAR = 1_000_000  # pixels or frames; beyond any sample, and small enough for every database


class Body(BaseModel):
    """A JSON body: no unknown fields, no guessing at types."""

    model_config = ConfigDict(strict=True, extra="forbid")


class Crop(Body):
    """A rectangle in pixels of the upright sample."""

    x: int = Field(ge=0, le=_FAR, description="From the left edge.")
    y: int = Field(ge=0, le=_FAR, description="From the top edge.")
    width: int = Field(ge=1, le=_FAR)
    height: int = Field(ge=1, le=_FAR)

    def rectangle(self) -> Rectangle:
        return Rectangle(self.x, self.y, self.width, self.height)


class TimeRange(Body):
    """A range of a video's frames."""

    first: int = Field(0, ge=0, le=_FAR, description="Number of the first frame, from 0.")
    count: int = Field(ge=1, le=_FAR, description="How many frames.")

    def frames(self) -> Frames:
        return Frames(self.first, self.count)


class InputBody(Body):
    """One input of an experiment."""

    sample: Identifier = Field(description="Id of an uploaded or bundled sample.")
    crop: Crop | None = Field(None, description="Default: the whole sample.")
    frames: TimeRange | None = Field(
        None, description="Of a video. Default: all frames where the method takes a video, else the first one."
    )

    def wanted(self) -> NewInput:
        crop = None if self.crop is None else self.crop.rectangle()
        return NewInput(self.sample, crop, None if self.frames is None else self.frames.frames())


class ListedBody(Body):
    """What may be changed of an experiment."""

    listed: bool = Field(description="Whether the archive shows it; otherwise only its link leads to it.")

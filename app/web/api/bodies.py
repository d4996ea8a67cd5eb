"""JSON request bodies of the API: strict types, no unknown fields."""

from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StringConstraints, model_validator
from pydantic_core import PydanticCustomError

from app.experiments.preparation import NewInput
from app.images.crop import Frames, Rectangle
from app.numbers import FAR

IDENTIFIER = r"^[A-Za-z0-9_-]{1,64}$"
UNKNOWN_KEYS = 8  # each of which is named
Identifier = Annotated[str, StringConstraints(pattern=IDENTIFIER)]


def without_fraction(value: object) -> object:
    """Take ``7.0`` for 7, as JSON Schema does: what has no fraction is an integer."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


Whole = Annotated[int, BeforeValidator(without_fraction)]


class Body(BaseModel):
    """A JSON body: no unknown fields, no guessing at types."""

    model_config = ConfigDict(strict=True, extra="forbid")

    @model_validator(mode="before")
    @classmethod
    def _refuse_many_unknown(cls, value: Any) -> Any:
        """Count what is not known before anything is validated: a fault is not made for each of thousands of fields."""
        if isinstance(value, dict):
            unknown = [key for key in value if key not in cls.model_fields]
            if len(unknown) > UNKNOWN_KEYS:
                raise PydanticCustomError(
                    "unknown_fields",
                    "{count} of its fields are not known; it has {known} only",
                    {"count": len(unknown), "known": ", ".join(cls.model_fields)},
                )
        return value


class Crop(Body):
    """A rectangle in pixels of the upright sample."""

    x: Whole = Field(ge=0, le=FAR, description="From the left edge.")
    y: Whole = Field(ge=0, le=FAR, description="From the top edge.")
    width: Whole = Field(ge=1, le=FAR)
    height: Whole = Field(ge=1, le=FAR)

    def to_rectangle(self) -> Rectangle:
        return Rectangle(self.x, self.y, self.width, self.height)


class TimeRange(Body):
    """A range of a video's frames."""

    first: Whole = Field(0, ge=0, le=FAR, description="Number of the first frame, from 0.")
    count: Whole = Field(ge=1, le=FAR, description="How many frames.")

    def frames(self) -> Frames:
        return Frames(self.first, self.count)


class InputBody(Body):
    """One input of an experiment."""

    sample: Identifier = Field(description="Id of an uploaded or bundled sample.")
    crop: Crop | None = Field(None, description="Default: the whole sample.")
    frames: TimeRange | None = Field(
        None, description="Of a video. Default: all frames where the method takes a video, else the first one."
    )

    def to_input(self) -> NewInput:
        crop = None if self.crop is None else self.crop.to_rectangle()
        return NewInput(self.sample, crop, None if self.frames is None else self.frames.frames())


class ListedBody(Body):
    """What may be changed of an experiment."""

    listed: bool = Field(description="Whether the archive shows it; otherwise only its link leads to it.")

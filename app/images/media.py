"""Media: the properties of a picture or a video, which uploads, samples and stored rows have in common."""

from dataclasses import dataclass, fields
from typing import Any

STILL = "image/png"  # the media type of every still picture, whatever it was uploaded as


@dataclass(frozen=True)
class Media:
    """Properties of a picture or a video, upright and in sRGB; a video has more than one frame.

    What derives from it adds what it is: a decoded upload its pixels, a sample its identifier.
    """

    #: Pixels from left to right.
    width: int
    #: Pixels from top to bottom, of one frame.
    height: int
    #: Colour channels: 1 (grey) or 3 (RGB).
    channels: int
    #: Bits per channel: 8 or 16.
    depth: int
    #: Whether an alpha channel follows the colours, with pixels that are not opaque.
    transparent: bool
    #: Number of frames; 1 of a still picture.
    frames: int = 1
    #: Frames a second; 0 of a still picture.
    rate: float = 0.0
    #: What a video was uploaded as; `STILL` of a still picture.
    media_type: str = STILL

    @property
    def moving(self) -> bool:
        """Whether it is a video."""
        return self.frames > 1

    def properties(self) -> dict[str, Any]:
        """These fields by name, without what a derived class adds.

        Examples
        --------
        >>> Media(64, 48, 3, 8, False).properties()["height"]
        48
        """
        return {field.name: getattr(self, field.name) for field in fields(Media)}

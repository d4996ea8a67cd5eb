"""Crops of a sample: a rectangle in pixels of the upright original, and a range of a video's frames."""

from dataclasses import dataclass

from app.errors import InvalidInputError
from app.numbers import quote, whole
from app.synthesis.structure import CENTRE


@dataclass(frozen=True)
class Rectangle:
    """A rectangle: ``x`` to the right and ``y`` down from the top left corner, ``width`` and ``height``; in pixels."""

    x: int
    y: int
    width: int
    height: int

    @classmethod
    def parse(cls, text: str) -> "Rectangle":
        """Read ``x,y,width,height``.

        Raises
        ------
        InvalidInputError
            If the text is not four whole numbers separated by commas.

        Examples
        --------
        >>> Rectangle.parse("10,20,256,256")
        Rectangle(x=10, y=20, width=256, height=256)
        """
        try:
            x, y, width, height = (whole(part) for part in text.split(","))
        except ValueError:
            raise InvalidInputError(
                f"A crop is four whole numbers x,y,width,height, for example 10,20,256,256; got {quote(text)}.", "crop"
            ) from None
        return cls(x, y, width, height)

    def check_within(self, width: int, height: int) -> "Rectangle":
        """Return the rectangle itself if it lies in a picture of this size.

        Raises
        ------
        InvalidInputError
            If it is empty or reaches outside.
        """
        if self.width < 1 or self.height < 1:
            raise InvalidInputError(
                "A crop has at least 1 × 1 pixel: draw it again, or enter a width and a height.", "crop"
            )
        if self.x < 0 or self.y < 0 or self.x + self.width > width or self.y + self.height > height:
            raise InvalidInputError(
                f"The crop {self} reaches outside the photograph, which is {width} × {height} pixels: "
                "move it or make it smaller.",
                "crop",
            )
        return self

    def scale_size(self, factor: float) -> tuple[int, int]:
        """Multiply width and height by ``factor``; half a pixel is rounded up, and no side is less than 1.

        Examples
        --------
        >>> Rectangle(0, 0, 103, 99).scale_size(1.5)
        (155, 149)
        """
        return max(1, int(self.width * factor + 0.5)), max(1, int(self.height * factor + 0.5))

    def __str__(self) -> str:
        return f"{self.x},{self.y},{self.width},{self.height}"


@dataclass(frozen=True)
class Frames:
    """A range of a video's frames: ``first`` counts from 0; a still picture has one frame."""

    first: int = 0
    count: int = 1

    @classmethod
    def parse(cls, text: str) -> "Frames":
        """Read ``first,count``.

        Raises
        ------
        InvalidInputError
            If the text is not two whole numbers separated by a comma.

        Examples
        --------
        >>> Frames.parse("12,48")
        Frames(first=12, count=48)
        """
        try:
            first, count = (whole(part) for part in text.split(","))
        except ValueError:
            raise InvalidInputError(
                f"A time range is two whole numbers first,count, for example 0,48; got {quote(text)}.", "frames"
            ) from None
        return cls(first, count)

    def check_within(self, frames: int) -> "Frames":
        """Return the range itself if it lies in a sample of so many frames.

        Raises
        ------
        InvalidInputError
            If it is empty or reaches outside.
        """
        if self.count < 1:
            raise InvalidInputError("A time range has at least 1 frame: enter the number of frames.", "frames")
        if self.first < 0 or self.first + self.count > frames:
            raise InvalidInputError(
                f"The time range {self} reaches outside the sample, which has {frames} "
                f"frame{'s' if frames > 1 else ''} (the first is number 0): move it or make it shorter.",
                "frames",
            )
        return self

    def __str__(self) -> str:
        return f"{self.first},{self.count}"


def crop_to_centre(area: Rectangle) -> Rectangle:
    """Cut a rectangle down to the part the structure meter looks at: its centre, 1024 pixels wide and high at most.

    Examples
    --------
    >>> crop_to_centre(Rectangle(10, 10, 1124, 200))
    Rectangle(x=60, y=10, width=1024, height=200)
    """
    width, height = min(area.width, CENTRE), min(area.height, CENTRE)
    return Rectangle(area.x + (area.width - width) // 2, area.y + (area.height - height) // 2, width, height)

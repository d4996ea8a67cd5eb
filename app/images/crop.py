"""A rectangle of a picture, in pixels of the upright original."""

from dataclasses import dataclass

from app.errors import InvalidInputError


@dataclass(frozen=True)
class Rectangle:
    """``x`` to the right and ``y`` down from the top left corner; ``width`` and ``height`` in pixels."""

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
            x, y, width, height = (int(part) for part in text.split(","))
        except ValueError:
            raise InvalidInputError(
                f"A crop is four whole numbers x,y,width,height, for example 10,20,256,256; got {text!r}.", "crop"
            ) from None
        return cls(x, y, width, height)

    def within(self, width: int, height: int) -> "Rectangle":
        """Itself, if it lies in a picture of this size.

        Raises
        ------
        InvalidInputError
            If it is empty or reaches outside.
        """
        if self.width < 1 or self.height < 1:
            raise InvalidInputError(
                "A crop is at least 1 × 1 pixel: draw it again, or give a width and a height.", "crop"
            )
        if self.x < 0 or self.y < 0 or self.x + self.width > width or self.y + self.height > height:
            raise InvalidInputError(
                f"The crop {self} reaches outside the photograph, which is {width} × {height} pixels: "
                "move it or make it smaller.",
                "crop",
            )
        return self

    def __str__(self) -> str:
        return f"{self.x},{self.y},{self.width},{self.height}"

"""Limits of a service on what a run may make and take: pixels and memory."""

from dataclasses import dataclass
from typing import Any, Self

from app.errors import TooLargeError
from app.methods.params import MovingParams, Resolved
from app.settings import MEBIBYTE, Settings

WORKING_SHARE = 0.75  # of a worker's memory; the rest is the interpreter's, the libraries' and the encoders'


@dataclass(frozen=True)
class Allowed:
    """What a texture may have and take: pixels (of a video, of one frame and of all) and a worker's bytes of memory."""

    pixels: int
    video_pixels: int
    memory: int

    @classmethod
    def by(cls, settings: Settings) -> Self:
        """What the settings allow."""
        memory = int(settings.worker_memory * WORKING_SHARE)
        return cls(settings.max_output_pixels, settings.max_film_pixels, memory)

    def refuse_pixels(self, resolved: Resolved[Any], method: str, most: int | None) -> None:
        """Raise `TooLargeError` for more pixels than are allowed, or than the method itself can make (``most``)."""
        width, height, frames = resolved.width, resolved.height, resolved.frames
        if isinstance(resolved.params, MovingParams) and width * height * frames > self.video_pixels:
            raise TooLargeError(
                f"A video of {frames} frames of {width} × {height} has {width * height * frames / 1e6:.0f} megapixels; "
                f"this service makes at most {self.video_pixels / 1e6:.0f}: ask for fewer frames, or for a smaller "
                "width or height."
            )
        maker, allowed = "this service", self.pixels
        if most is not None and most < allowed:
            maker, allowed = f"the method {method}", most
        if width * height > allowed:
            raise TooLargeError(
                f"A texture of {width} × {height} has {width * height / 1e6:.0f} megapixels; {maker} makes at most "
                f"{allowed / 1e6:.0f}: ask for a smaller width or height."
            )

    def refuse_memory(self, needed: int, *, moving: bool) -> None:
        """Raise `TooLargeError` for a run that needs more bytes than a worker has."""
        if needed > self.memory:
            smaller = (
                "a shorter or smaller crop, fewer frames, or a smaller width and height"
                if moving
                else "a smaller crop, or a smaller width and height"
            )
            raise TooLargeError(
                f"This run would need about {needed / MEBIBYTE:,.0f} MB of memory, and a worker of this service has "
                f"{self.memory / MEBIBYTE:,.0f} MB for it: take {smaller}."
            )

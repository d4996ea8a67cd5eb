"""Output declarations: the name and type of every output of a method, and the parameters that change it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

Condition = Callable[[Any, int], bool]


def _always(params: Any, inputs: int) -> bool:
    return True


@dataclass(frozen=True)
class OutputSpec:
    """An output that a method can make.

    Parameters
    ----------
    name, kind, media_type
        As those of the `app.methods.model.Picture`.
    of : tuple of str, optional
        The parameters that change it, beside those that every method has; by default all of them.
    deep : bool
        Whether its PNG file has 16 bits per channel in a run of that depth.
    as_uploaded : bool
        Whether it is an input unchanged, which has the depth of its sample and no other.
    applies : callable ``(params, inputs) -> bool``
        Whether a run with these parameters and this number of inputs makes it.
    condition : str
        The same in words, after "where"; empty for what every run makes.
    """

    name: str
    kind: Literal["texture", "view"] = "view"
    media_type: str = "image/png"
    of: tuple[str, ...] | None = None
    deep: bool = True
    as_uploaded: bool = False
    applies: Condition = _always
    condition: str = ""

    @property
    def video(self) -> bool:
        """Whether it is a video, not a picture (though that may be animated)."""
        return self.media_type.startswith("video/")

    def changed_by(self, parameter: str) -> bool:
        """Whether a parameter, of those that not every method has, changes it."""
        return self.of is None or parameter in self.of


def from_inputs(number: int) -> Condition:
    """Make the condition that there are this many inputs or more."""
    return lambda params, inputs: inputs >= number


def texture(
    name: str = "texture", of: tuple[str, ...] | None = None, applies: Condition = _always, condition: str = ""
) -> OutputSpec:
    """Declare a synthesised texture."""
    return OutputSpec(name, "texture", of=of, applies=applies, condition=condition)


def views(*names: str, of: tuple[str, ...] | None = None, deep: bool = True) -> tuple[OutputSpec, ...]:
    """Declare pictures of intermediate steps."""
    return tuple(OutputSpec(name, of=of, deep=deep) for name in names)


def shown_inputs(most: int = 1, least: int = 1) -> tuple[OutputSpec, ...]:
    """Declare the crops: ``crop``, and ``crop-2``, … of further inputs, of which ``least`` are always there."""
    return tuple(
        OutputSpec(
            f"crop-{number}" if number > 1 else "crop",
            of=(),
            as_uploaded=True,
            applies=from_inputs(number),
            condition="" if number <= least else f"there are {number} inputs or more",
        )
        for number in range(1, most + 1)
    )


VIDEO_OUTPUTS = (
    OutputSpec("texture", "texture", "video/webm", deep=False),
    OutputSpec("texture-mp4", media_type="video/mp4", deep=False),
    OutputSpec("preview", media_type="image/webp", deep=False),
    OutputSpec("cube", deep=False),
)
SHOWN_CLIP = (
    OutputSpec("crop", media_type="video/webm", of=(), deep=False),
    OutputSpec("crop-mp4", media_type="video/mp4", of=(), deep=False),
    OutputSpec("crop-cube", of=(), deep=False),
)

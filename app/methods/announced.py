"""Outputs as a method announces them before it runs: their names, and the parameters that each of them hangs on."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

Condition = Callable[[Any, int], bool]


def _always(params: Any, inputs: int) -> bool:
    return True


@dataclass(frozen=True)
class Announced:
    """An output that a method may give.

    Parameters
    ----------
    name, kind, media_type
        Of the `app.methods.model.Picture`.
    of : tuple of str, optional
        The parameters that change it, beside those that every method has; by default all of them.
    deep : bool
        Whether its PNG file has 16 bits per channel where that depth is asked for.
    as_given : bool
        Whether it is an input as it came, which has the depth of its sample and no other.
    given : callable ``(params, inputs) -> bool``
        Whether it is given under these parameters, of so many inputs.
    condition : str
        The same in words, after "where"; empty for what is always given.
    """

    name: str
    kind: Literal["texture", "view"] = "view"
    media_type: str = "image/png"
    of: tuple[str, ...] | None = None
    deep: bool = True
    as_given: bool = False
    given: Condition = _always
    condition: str = ""

    @property
    def video(self) -> bool:
        """Whether it is a video, not a picture (though that may be animated)."""
        return self.media_type.startswith("video/")

    def changed_by(self, parameter: str) -> bool:
        """Whether a parameter, of those that not every method has, changes it."""
        return self.of is None or parameter in self.of


def from_inputs(number: int) -> Condition:
    """The condition that there are so many inputs or more."""
    return lambda params, inputs: inputs >= number


def texture(
    name: str = "texture", of: tuple[str, ...] | None = None, given: Condition = _always, condition: str = ""
) -> Announced:
    """Announce a texture that is synthesised."""
    return Announced(name, "texture", of=of, given=given, condition=condition)


def views(*names: str, of: tuple[str, ...] | None = None, deep: bool = True) -> tuple[Announced, ...]:
    """Announce what shows steps on the way."""
    return tuple(Announced(name, of=of, deep=deep) for name in names)


def shown_inputs(most: int = 1, least: int = 1) -> tuple[Announced, ...]:
    """Announce the crops: ``crop``, and ``crop-2``, … of further inputs, of which ``least`` are always there."""
    return tuple(
        Announced(
            f"crop-{number}" if number > 1 else "crop",
            of=(),
            as_given=True,
            given=from_inputs(number),
            condition="" if number <= least else f"there are {number} inputs or more",
        )
        for number in range(1, most + 1)
    )


FILMS = (
    Announced("texture", "texture", "video/webm", deep=False),
    Announced("texture-mp4", media_type="video/mp4", deep=False),
    Announced("preview", media_type="image/webp", deep=False),
    Announced("cube", deep=False),
)
SHOWN_CLIP = (
    Announced("crop", media_type="video/webm", of=(), deep=False),
    Announced("crop-mp4", media_type="video/mp4", of=(), deep=False),
    Announced("crop-cube", of=(), deep=False),
)

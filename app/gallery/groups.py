"""Grouping and order of the methods on the overview page."""

from dataclasses import dataclass

from app.methods.model import Method
from app.methods.registry import METHODS


@dataclass(frozen=True)
class Group:
    """Methods that have an idea in common; ``text`` says which."""

    title: str
    text: str
    names: tuple[str, ...]

    @property
    def methods(self) -> tuple[Method, ...]:
        """Those of them that are registered."""
        return tuple(METHODS[name] for name in self.names if name in METHODS)


GROUPS = (
    Group(
        "Random phase and Gaussian models",
        "All they know of a sample is its mean and its Fourier modulus. They give a texture of any size at once, and "
        "without fail; of a micro-texture it is the right one.",
        ("rpn", "adsn", "dsn", "texton", "mix"),
    ),
    Group(
        "Spectra explained",
        "What of a picture is in its modulus, and what in its phase: experiments on photographs rather than textures.",
        ("modulus-phase", "rayleigh"),
    ),
    Group(
        "Beyond the phase",
        "A pyramid matches how the values of sub-bands are distributed, which brings some contours back. Copying the "
        "sample pixel by pixel needs no model at all: structure is kept, and so are whole pieces of the sample.",
        ("heeger-bergen", "efros-leung"),
    ),
    Group(
        "Patchwork",
        "Patches of random shape, copied from anywhere in the sample and joined so that the joins keep its contrast. "
        "Inside a patch everything is as in the sample, sharp structure too; the same patches, chosen to resemble "
        "another picture, paint that picture in the texture.",
        ("patchwork", "transfer"),
    ),
    Group(
        "Videos",
        "Water, fire, foliage, smoke: textures that move. Both ideas carry over to time: the phase of all frequencies "
        "of space and time drawn at random, and patches joined in space whose frames are joined in time.",
        ("video-rpn", "video-patchwork", "video-transfer"),
    ),
)


def groups() -> tuple[Group, ...]:
    """The groups that have methods; those that stand in none come last."""
    rest = tuple(name for name in METHODS if not any(name in group.names for group in GROUPS))
    return tuple(group for group in (*GROUPS, Group("More", "", rest)) if group.methods)

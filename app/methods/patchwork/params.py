"""Fields of parameters that the patchwork methods share; each method gives its own default and description.

Fields and not base classes: inherited fields would come first, and forms, API schema and command line list parameters
in the order in which they are declared.
"""

from typing import Any, Protocol

from pydantic import Field

from app.methods.params import ADVANCED
from app.synthesis.patchwork.unbounded_cells import Reach

LEAST_GRID = 4
RESCALE: Any = Field(
    True,
    title="Rescale the pattern's colours",
    description="Give every channel of the pattern the texture's mean and range before they are compared, so that "
    "dark and light find their like. Off: the colours are compared as they are.",
)
INTERVAL: Any = Field(
    18,
    ge=1,
    le=600,
    title="Interval",
    description="Frames from one transition in time to the next, about. Longer ones keep longer movements; the clip "
    "must hold what is seen around a transition, about 2½ intervals.",
)


class PatchParams(Protocol):
    """Parameters of a method that joins patches; those of patchwork have a ``blend`` as well."""

    @property
    def grid(self) -> int: ...

    @property
    def sharpness(self) -> float: ...

    @property
    def reach(self) -> Reach: ...


def grid_field(default: int, description: str) -> Any:
    """Declare the distance of the patches; the description goes on from what it is."""
    return Field(
        default,
        ge=LEAST_GRID,
        le=1024,
        title="Grid",
        description=f"Pixels from one patch to the next, about. {description}",
    )


def sharpness_field(default: float, description: str = "", *, advanced: bool = False) -> Any:
    """Declare the sharpness f; the description goes on from what it is."""
    return Field(
        default,
        ge=1,
        le=40,
        title="Sharpness f",
        description="How suddenly a patch gives way to its neighbour"
        + (description or ": the higher, the more suddenly."),
        json_schema_extra=ADVANCED if advanced else None,
    )


def candidates_field(description: str) -> Any:
    """Declare how many places are compared with each patch."""
    return Field(200, ge=0, le=100_000, title="Candidates", description=description)


def reach_field(default: Reach) -> Any:
    """Declare how many patches count at a pixel."""
    return Field(
        default,
        title="Patches that count",
        description="At every pixel 'all' patches count, however far away, as the article's sum says; or those 'near' "
        "alone: weights are lowered so that they end three grids from a patch's centre, which is quick for any size. "
        "From a sharpness of 6 on it makes no difference.",
        json_schema_extra=ADVANCED,
    )

"""What a method declares, and what it is given and gives back.

A method is declared once; its form, its API schema, its command line options and its page come from that.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

MAX_SEED = 2**53 - 1  # the largest whole number that JSON readers in JavaScript keep exactly


class StillParams(BaseModel):
    """Parameters that every still-image method has."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    width: int | None = Field(None, ge=1, title="Width", description="Pixels of the texture; default: as the crop.")
    height: int | None = Field(None, ge=1, title="Height", description="Pixels of the texture; default: as the crop.")
    seed: int = Field(
        0,
        ge=0,
        le=MAX_SEED,
        title="Seed",
        description="Start of the random numbers: the same seed gives the same texture, another seed another one.",
    )


class Progress(Protocol):
    """What a method calls between pieces of work; it raises when the experiment is cancelled or out of time.

    ``stage`` is a short lower-case name (``"periodic component"``), ``fraction`` the part of the run that is done, 0–1.
    The time from one stage's first call to the next stage's is that stage's time in the record.
    """

    def __call__(self, stage: str, fraction: float) -> None: ...


@dataclass(frozen=True)
class Slot:
    """One input a method asks for."""

    name: str
    title: str
    summary: str


@dataclass(frozen=True)
class Source:
    """One input as a method is given it: the crop's pixels.

    ``pixels`` is (H, W, C) float32 in the sample's own range [0, ``peak``]; ``peak`` is 255 or 65535.
    """

    pixels: NDArray[np.float32]
    peak: int


@dataclass(frozen=True)
class Context:
    """What a run may use: ``depth`` is the bits per channel of the pictures, 8 or 16."""

    depth: Literal[8, 16]
    threads: int
    progress: Progress


@dataclass(frozen=True)
class Picture:
    """One picture a method gives back, already a PNG file."""

    name: str
    title: str
    width: int
    height: int
    png: bytes


@dataclass(frozen=True)
class Reference:
    """Where a method comes from."""

    authors: str
    title: str
    venue: str
    year: int
    url: str


@dataclass(frozen=True)
class Size:
    """Size of an input, known before its pixels are read."""

    width: int
    height: int
    channels: int


@dataclass(frozen=True)
class Method:
    """One synthesis model.

    Parameters
    ----------
    name : str
        As in URLs and on the command line.
    title, summary : str
        One line each; the summary says what it computes.
    inputs : tuple of Slot
    params : type of pydantic.BaseModel
        Every field has a title, a description and a default; ``json_schema_extra={"advanced": True}`` puts it
        under "advanced".
    references : tuple of Reference
        The main one first.
    check : callable ``(sizes, params) -> None``
        Raises `app.errors.InvalidInputError` for a combination that cannot run, before anything is queued.
    run : callable ``(sources, params, context) -> iterator of Picture``
        Yields its pictures as they are made, the main one, ``texture``, first; what is not asked for is not computed.
    """

    name: str
    title: str
    summary: str
    inputs: tuple[Slot, ...]
    params: type[StillParams]
    references: tuple[Reference, ...]
    check: Callable[[Sequence[Size], Any], None]
    run: Callable[[Sequence[Source], Any, Context], Iterator[Picture]]

"""Methods and their values: `Method`, its inputs (`Slot`, `Size`, `Source`) and its outputs (`Picture`, `Fact`).

A method is declared once; its form, its API schema, its command line options and its page come from that.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, fields, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from app.errors import InvalidInputError
from app.methods.allowed import Allowed
from app.methods.context import Context
from app.methods.explanations.model import Explanation, Reference
from app.methods.outputs import OutputSpec
from app.methods.params import MovingParams, Resolved, StillParams
from app.methods.stages import Plan, Stages
from app.synthesis.arrays import Bytes, Real


@dataclass(frozen=True)
class Slot:
    """Input that a method needs; a ``moving`` one is a video."""

    name: str
    title: str
    summary: str
    moving: bool = False


@dataclass(frozen=True)
class Size:
    """Size of an input, known before its pixels are read; a still picture has one frame."""

    width: int
    height: int
    channels: int
    frames: int = 1


@dataclass(frozen=True)
class Clip:
    """Video of an input: ``frames``, (T, H, W, C) uint8, and ``rate``, how many of them are shown a second."""

    frames: Bytes
    rate: float


@dataclass(frozen=True)
class Source:
    """Pixels of one input: those of its crop.

    Parameters
    ----------
    pixels : ndarray of float32, shape (H, W, C)
        In the sample's own range, 0 to ``peak``; of a clip those of the first frame.
    peak : int
        255 or 65535.
    clip : Clip, optional
        The video, of an input of a moving slot.
    """

    pixels: Real
    peak: int
    clip: Clip | None = None

    def require_clip(self) -> Clip:
        """Return the video of an input of a moving slot.

        Raises
        ------
        TypeError
            For a still picture.
        """
        if self.clip is None:
            raise TypeError("This input is a still picture, and its slot takes a video.")
        return self.clip

    @property
    def size(self) -> Size:
        height, width, channels = self.pixels.shape
        return Size(width, height, channels, 1 if self.clip is None else len(self.clip.frames))


@dataclass(frozen=True)
class Fact:
    """A number that a run found out, such as the radius that holds half of a texton's energy."""

    name: str
    title: str
    value: float
    unit: str = ""


@dataclass(frozen=True)
class PictureInfo:
    """Properties of a picture or a video that a method gives: of the `Picture` itself, and of the output it becomes."""

    #: Of addresses; unique within an experiment.
    name: str
    #: For people.
    title: str
    #: Pixels from left to right.
    width: int
    #: Pixels from top to bottom, of one frame.
    height: int
    _: KW_ONLY
    #: A ``texture`` that was synthesised, which is measured and shown at once, or a ``view`` of something on the way.
    kind: Literal["texture", "view"] = "view"
    #: Of the file; PNG of a still picture.
    media_type: str = "image/png"
    #: Number of frames; 1 of a still picture.
    frames: int = 1
    #: Frames a second; 0 of a still picture.
    rate: float = 0.0

    def properties(self) -> dict[str, Any]:
        """These fields by name, without what a derived class adds."""
        return {each.name: getattr(self, each.name) for each in fields(PictureInfo)}


@dataclass(frozen=True)
class Picture(PictureInfo):
    """One picture or video that a method gives back, already a file."""

    #: The file's content, or the file itself in the context's ``scratch`` directory: then it is the receiver's.
    data: bytes | Path
    #: Numbers that the method found out, for the experiment's diagnostics.
    facts: tuple[Fact, ...] = ()


def first_size(sizes: Sequence[Size]) -> tuple[int, int]:
    """Width and height of the first input."""
    return sizes[0].width, sizes[0].height


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
        Those it needs.
    params : type of pydantic.BaseModel
        Every field has a title, a description and a default; ``json_schema_extra={"advanced": True}`` puts it
        under "advanced".
    references : tuple of Reference
        The main one first.
    explanation : Explanation
        Its page.
    run : callable ``(sources, resolved, context) -> iterator of Picture``
        Yields its pictures as they are made, the main one, ``texture``, first; the work stops where nobody takes more.
        Among them is ``crop``, and ``crop-2``, … for further inputs (see `app.methods.output.pictures.crops`).
        Its inputs are finite and its `Resolved` parameters have passed ``check``: see `pictures`, which calls it.
        It calls ``context.progress`` with its stages and the part of each that is done.
    outputs : tuple of OutputSpec
        Every picture that it may yield, in that order.
    stages : callable ``(sizes, resolved) -> Plan``
        The stages that a run with these parameters goes through, in their order, with weights: see `Stages`.
    check : callable ``(sizes, resolved) -> None``
        Raises `app.errors.InvalidInputError` for a combination that cannot run, before anything is queued; default:
        nothing is refused.
    more : int
        How many further inputs like the last one it takes.
    size : callable ``(sizes) -> (width, height)``
        Size of the texture that is made by default; default: the first input's.
    toroidal : callable ``(params) -> bool``
        Whether the texture tiles without a seam.
    most_pixels : int, optional
        Pixels that its texture may have where that is fewer than the service allows: what it holds in memory.
    phase : bool
        Whether it is driven by the random phase that `rpn` and `adsn` share: at one seed and size all such methods
        have the same phase.
    memory : callable ``(sizes, resolved) -> int``, optional
        Bytes that a run needs at its peak beside the interpreter, for one whose need grows with the texture.
    idle : callable ``(sizes, resolved) -> mapping``, optional
        Parameters that change nothing with these others, each with when they do and what to do, in words.
    """

    name: str
    title: str
    summary: str
    inputs: tuple[Slot, ...]
    params: type[StillParams]
    references: tuple[Reference, ...]
    explanation: Explanation
    run: Callable[[Sequence[Source], Resolved[Any], Context], Iterator[Picture]]
    outputs: tuple[OutputSpec, ...]
    stages: Callable[[Sequence[Size], Resolved[Any]], Plan]
    check: Callable[[Sequence[Size], Resolved[Any]], None] = lambda sizes, resolved: None
    more: int = 0
    size: Callable[[Sequence[Size]], tuple[int, int]] = first_size
    toroidal: Callable[[Any], bool] = lambda params: True
    most_pixels: int | None = None
    phase: bool = False
    memory: Callable[[Sequence[Size], Resolved[Any]], int] | None = None
    idle: Callable[[Sequence[Size], Resolved[Any]], Mapping[str, str]] = lambda sizes, resolved: {}

    def slot(self, index: int) -> Slot:
        """The slot of an input, from 0; further inputs are like the last one."""
        return self.inputs[min(index, len(self.inputs) - 1)]

    @property
    def moving(self) -> bool:
        """Whether it makes videos, of which `MovingParams` are the parameters."""
        return any(slot.moving for slot in self.inputs)

    def fill(self, sizes: Sequence[Size], params: StillParams) -> Resolved[Any]:
        """Fill in width, height and frames as `resolve` does, and refuse nothing."""
        width, height = self.size(sizes)
        filled = {"width": params.width or width, "height": params.height or height}
        if isinstance(params, MovingParams):
            filled["frames"] = params.frames or max(size.frames for size in sizes)
        return Resolved(params.model_copy(update=filled), **filled)

    def resolve(self, sizes: Sequence[Size], params: StillParams, allowed: Allowed | None = None) -> Resolved[Any]:
        """Fill in the size of the texture where it was left empty, and refuse what cannot run.

        Parameters
        ----------
        sizes : sequence of Size
            Of the inputs, in the order of the slots.
        params : StillParams
            The method's own; resolving them again changes nothing.
        allowed : Allowed, optional
            What a service makes at most; by default any size.

        Raises
        ------
        InvalidInputError
            From ``check``, with the field at fault.
        TooLargeError
            If the texture has more pixels than are allowed.

        Examples
        --------
        >>> from app.methods.registry import METHODS
        >>> resolved = METHODS["rpn"].resolve([Size(300, 200, 3)], METHODS["rpn"].params(width=512))
        >>> resolved.width, resolved.height, resolved.params.height
        (512, 200, 200)
        """
        resolved = self.fill(sizes, params)
        if allowed is not None:
            allowed.refuse_pixels(resolved, self.name, self.most_pixels)
        self.check(sizes, resolved)
        return resolved

    def pictures(self, sources: Sequence[Source], params: StillParams, context: Context) -> Iterator[Picture]:
        """Run the method: its pictures as they are made, ``texture`` first.

        Parameters
        ----------
        sources : sequence of Source
            One for each slot, and further ones like the last.
        params : StillParams
            The method's own, as typed or resolved.
        context : Context
            Its progress is called with the part of the run that is done; it never falls, and ends at 1.

        Raises
        ------
        InvalidInputError
            At once, if `resolve` refuses or an input holds values that are not finite.
        """
        sizes = [source.size for source in sources]
        resolved = self.resolve(sizes, params)
        for index, source in enumerate(sources):
            if not np.isfinite(source.pixels).all():
                raise InvalidInputError(
                    "The crop holds values that are not finite numbers: save it anew.", f"inputs.{index}"
                )
        return self._run(sources, resolved, context, Stages(self.stages(sizes, resolved), context.progress))

    def _run(
        self, sources: Sequence[Source], resolved: Resolved[Any], context: Context, stages: Stages
    ) -> Iterator[Picture]:
        yield from self.run(sources, resolved, replace(context, progress=stages))
        stages.finish()

    def memory_of(self, sizes: Sequence[Size], params: StillParams) -> int:
        """Bytes that a run needs at its peak, as far as the method declares it; else 0."""
        return 0 if self.memory is None else self.memory(sizes, self.fill(sizes, params))

"""Random phase methods, RPN and ADSN: their common parameters, checks and pictures."""

from collections.abc import Callable, Iterator, Sequence
from typing import Literal

import numpy as np
from pydantic import Field

from app.errors import InvalidInputError
from app.images.png_writer import PngWriter
from app.methods.context import Context, Progress
from app.methods.gaussian.params import SpotParams
from app.methods.inputs import refuse_other_size
from app.methods.model import Picture, Size, Source
from app.methods.output.pictures import log_modulus
from app.methods.outputs import shown_inputs, texture, views
from app.methods.params import ADD_SMOOTH, ADVANCED, Resolved
from app.methods.stages import Plan
from app.synthesis.arrays import Real
from app.synthesis.fourier.field import NoiseField
from app.synthesis.fourier.periodic import smooth_planes
from app.synthesis.fourier.spot import centre, make_spot
from app.synthesis.gaussian.modulus_phase import power
from app.synthesis.parallel import Team, row_blocks
from app.synthesis.sinks import Extent, Levels


class RandomPhaseParams(SpotParams):
    """Parameters of RPN and ADSN."""

    phase: Literal["add", "replace"] = Field(
        "add",
        title="Phase",
        description="'add' shifts the phases of all colours by the same random amount and keeps the colours right; "
        "'replace' gives all colours one common phase (the literature's “wrong RPN”), to show the false colours that "
        "come of it.",
        json_schema_extra=ADVANCED,
    )
    range: Literal["clip", "stretch"] = Field(
        "clip",
        title="Values out of range",
        description="How values darker than black or brighter than white are brought back: 'clip' cuts them off; "
        "'stretch' maps all values, the same way in every colour, so that the extreme ones just fit.",
        json_schema_extra=ADVANCED,
    )
    periodic: bool = Field(
        True,
        title="Periodic component",
        description="Take the jumps between opposite borders out of the crop first, as the articles do. Without this "
        "they come back as a cross of streaks: turn it off to see what it is for.",
        json_schema_extra=ADVANCED,
    )
    add_smooth: bool = ADD_SMOOTH


def check(sizes: Sequence[Size], resolved: Resolved[RandomPhaseParams]) -> None:
    """Refuse what cannot run: the smooth component has the crop's size and no other, and must have been taken out."""
    if not resolved.params.add_smooth:
        return
    if not resolved.params.periodic:
        raise InvalidInputError(
            "The smooth component can be added only after it was taken out: turn “Periodic component” on, or leave the "
            "smooth component out.",
            "parameters.add_smooth",
        )
    refuse_other_size(sizes[0], resolved)


Model = Callable[..., NoiseField]
"""`rpn_field` or `adsn_field`."""


class _Run:
    """One run: makes its pictures one by one."""

    def __init__(
        self, source: Source, resolved: Resolved[RandomPhaseParams], context: Context, team: Team, model: Model
    ) -> None:
        self._source, self._params, self._context, self._team = source, resolved.params, context, team
        self._height, self._width = resolved.height, resolved.width
        self._model = model
        self._peak = 2**context.depth - 1

    def pictures(self) -> Iterator[Picture]:
        field = self._field(self._context.progress).randomise()
        mean = field.mean
        yield self._texture(field)
        del field
        h = self._source.pixels
        yield self._picture("crop", "Crop", h.transpose(2, 0, 1))
        self._context.progress("periodic", 0)
        h = centre(h, self._height, self._width)
        smooth = smooth_planes(h, self._context.threads)
        p = np.empty_like(smooth)
        np.subtract(h.transpose(2, 0, 1), smooth, out=p)
        yield self._picture("periodic", "Periodic component", p)
        smooth += mean.astype(np.float32)[:, None, None]
        yield self._picture("smooth", "Smooth component, the mean added", smooth)
        del smooth
        if not self._params.periodic:
            p[:] = h.transpose(2, 0, 1)
        self._context.progress("input-spectrum", 0)
        squares = power(p, self._context.threads)  # before the spot, which takes p's place
        if p.shape[1:] == (self._height, self._width):
            yield self._picture("spot", "Spot", p)
        else:
            spot = make_spot(p, mean, self._height, self._width, self._params.alpha, self._params.window)
            yield self._write("spot", "Extended spot", self._height, self._width, spot.rows)
            del spot
        del p
        title = "Log-modulus of the periodic component" if self._params.periodic else "Log-modulus of the crop"
        yield log_modulus("input-spectrum", title, squares, h.shape[1], self._context)
        again = self._context.during("output-spectrum", (("spot", 2), ("output-spectrum", 8)))
        squares = self._field(again).power()
        yield log_modulus("output-spectrum", "Log-modulus of the texture", squares, self._width, self._context)

    def _texture(self, field: NoiseField) -> Picture:
        low, high = 0.0, float(self._source.peak)
        if self._params.range == "stretch":
            extent = Extent(self._source.peak)
            field.emit(extent, "range")
            low, high = extent.low, extent.high
        writer = PngWriter(self._width, self._height, len(field.mean), self._context.depth)
        field.emit(Levels(writer.write, len(field.mean), low, high, self._peak))
        return Picture("texture", "Texture", self._width, self._height, writer.finish(), kind="texture")

    def _field(self, progress: Progress) -> NoiseField:
        params = self._params
        return self._model(
            self._source.pixels,
            self._height,
            self._width,
            team=self._team,
            progress=progress,
            seed=params.seed,
            phase=params.phase,
            alpha=params.alpha,
            window=params.window,
            periodic=params.periodic,
            add_smooth=params.add_smooth,
        )

    def _picture(self, name: str, title: str, values: Real) -> Picture:
        height, width = values.shape[1:]
        return self._write(name, title, height, width, lambda first, last: values[:, first:last].copy())

    def _write(
        self,
        name: str,
        title: str,
        height: int,
        width: int,
        rows: Callable[[int, int], Real],
    ) -> Picture:
        """Write a picture of float rows (C, n, W) in the sample's range, cut off outside it."""
        writer = PngWriter(width, height, self._source.pixels.shape[2], self._context.depth)
        levels = Levels(writer.write, writer.channels, 0, self._source.peak, self._peak)

        def write(block: tuple[int, int]) -> None:
            levels(block[0], rows(*block))

        self._team.run(write, row_blocks(height), lambda part: self._context.progress(name, part))
        return Picture(name, title, width, height, writer.finish())


def run(
    sources: Sequence[Source], resolved: Resolved[RandomPhaseParams], context: Context, *, model: Model
) -> Iterator[Picture]:
    """The texture, then the steps that lead to it."""
    with Team(context.threads) as team:
        yield from _Run(sources[0], resolved, context, team, model).pictures()


def stages(sizes: Sequence[Size], resolved: Resolved[RandomPhaseParams]) -> Plan:
    """Those of the noise, and one for each picture after it."""
    stretching = (("range", 15),) if resolved.params.range == "stretch" else ()
    noise = (("spot", 10), ("random phase", 30), *stretching, ("texture", 30))
    return (
        *noise,
        ("crop", 2),
        ("periodic", 2),
        ("smooth", 2),
        ("input-spectrum", 1),
        ("spot", 2),
        ("output-spectrum", 12),
    )


def toroidal(params: RandomPhaseParams) -> bool:
    """Whether the texture tiles: the smooth component does not."""
    return not params.add_smooth


OUTPUTS = (
    texture(),
    *shown_inputs(),
    *views("periodic", "smooth", of=()),
    *views("spot", of=("alpha", "window", "periodic")),
    *views("input-spectrum", of=("periodic",), deep=False),
    *views("output-spectrum", of=("alpha", "window", "periodic", "add_smooth"), deep=False),
)

"""Structure index page: verdicts, a scale of the bundled photographs, formulas and limits."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

from fastapi import APIRouter, Request
from starlette.responses import Response

from app.errors import InvalidInputError
from app.experiments.meter import MICRO, STRUCTURED, Index, Reading, interpret
from app.experiments.model import Sample
from app.experiments.service import Service
from app.gallery.structure import FALSE_ALARM, FORMULAS, MARKS, MISS, STUDY, UNEVEN
from app.images.crop import Rectangle
from app.methods.explanations.references import RANDOM_PHASE_TEXTURES, SHARPNESS
from app.numbers import whole
from app.samples import read_catalogue
from app.settings import Settings
from app.web.deps import ServiceDep, SettingsDep
from app.web.form.address import input_values, sample_url
from app.web.form.inputs import crop_names, time_names
from app.web.templating import METER_END, meter_place, render

SIDE = 56.0  # of a picture on the scale, whose width is 1000
GAP = 4.0


router = APIRouter(include_in_schema=False)


@dataclass(frozen=True)
class Photograph:
    """A bundled photograph, its suggested crop and what the meter says of it."""

    sample: Sample
    title: str
    crop: Rectangle
    delta: float

    @property
    def interpret(self) -> Reading:
        return interpret(self.delta)

    @property
    def url(self) -> str:
        return sample_url(self.sample.id, input_values(1, self.crop))


@dataclass(frozen=True)
class Placement:
    """Where a photograph's picture lies on the scale, whose foot is at 0."""

    photograph: Photograph
    left: float
    top: float


def form_structure(service: Service, sample: Sample, values: Mapping[str, str]) -> Index | None:
    """Measure the crop that a form's fields name, for pages without a script; None if it cannot be measured."""
    with suppress(InvalidInputError, ValueError):
        crop = Rectangle.parse(",".join(values.get(name, "") for name in crop_names(1)))
        first = values.get(time_names(1)[0], "") if sample.moving else ""
        return service.meter.structure(sample, crop, frame=whole(first) if first else 0)
    return None


@router.get("/structure")
def structure_page(request: Request, service: ServiceDep, settings: SettingsDep) -> Response:
    photographs = sorted(_photographs(service, settings), key=lambda each: each.delta)
    places = place_pictures(photographs)
    named = {each.sample.id: each for each in photographs}
    context = {
        "photographs": photographs,
        "places": places,
        "height": 2 * GAP - min((place.top for place in places), default=0.0),
        "side": SIDE,
        "marks": MARKS,
        "limits": (0, MICRO, STRUCTURED, METER_END),
        "false_alarm": named.get(FALSE_ALARM),
        "miss": named.get(MISS),
        "uneven": named.get(UNEVEN),
        "formulas": FORMULAS,
        "study": STUDY,
        "references": (SHARPNESS, RANDOM_PHASE_TEXTURES),
    }
    return render(request, "structure.html", context)


def _photographs(service: Service, settings: Settings) -> list[Photograph]:
    """Those that have come in so far; a scene is no texture, a clip no photograph: neither has a place on the scale."""
    entries = {
        entry.id: entry for entry in read_catalogue(settings.samples_dir) if entry.kind not in ("scene", "moving")
    }
    return [
        Photograph(sample, entry.title, entry.crop, delta)
        for sample in service.samples.bundled()
        if (entry := entries.get(sample.id)) is not None
        and (delta := service.meter.structure(sample, entry.crop).delta) is not None
    ]


def place_pictures(photographs: Sequence[Photograph]) -> list[Placement]:
    """Put pictures side by side at their index, each in the lowest row that has room for it there."""
    ends: list[float] = []  # of the rows, from the lowest
    places = []
    for photograph in photographs:
        left = 10 * meter_place(photograph.delta) - SIDE / 2
        row = next((row for row, end in enumerate(ends) if left >= end + GAP), len(ends))
        ends[row : row + 1] = [left + SIDE]
        places.append(Placement(photograph, left, -(row + 1) * (SIDE + GAP)))
    return places

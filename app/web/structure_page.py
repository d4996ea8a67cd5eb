"""The page of the structure index: what it says, on a scale of the bundled photographs, its formulas and its limits."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

from fastapi import APIRouter, Request
from starlette.responses import Response

from app.errors import InvalidInputError
from app.experiments.meter import MICRO, STRUCTURED, Index, Reading, reading
from app.experiments.model import Sample
from app.experiments.service import Service
from app.images.crop import Rectangle
from app.methods.explanations.model import Formula
from app.methods.explanations.references import RANDOM_PHASE_TEXTURES, SHARPNESS
from app.numbers import whole
from app.samples import bundled
from app.settings import Settings
from app.web.deps import ServiceDep, SettingsDep
from app.web.form.inputs import crop_names, time_names
from app.web.templating import METER_END, meter_place, render

SIDE = 56.0  # of a picture on the scale, whose width is 1000
GAP = 4.0
MARKS = (0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4)
FALSE_ALARM, MISS, UNEVEN = "soil_ground010", "bark_fir", "lit_plaster"

FORMULAS = (
    Formula(
        r"\mathrm{TV}(p) = \sum_{x} |\dot{p}_1(x)| + |\dot{p}_2(x)|",
        r"The total variation: $p$ is the grey periodic component of the crop, smoothed by a periodic Gaussian of "
        r"deviation $\sigma = 2$ pixels; $\dot{p}_1$ and $\dot{p}_2$ are its steps from a pixel to the next one, "
        r"to the right and down, on the torus.",
    ),
    Formula(
        r"\mu_\sigma = (\alpha_1 + \alpha_2) \sqrt{\frac{2}{\pi}} \sqrt{N}, \quad \alpha_i = \|\dot{p}_i\|_2",
        r"The exact mean of the total variation over all Gaussian textures (ADSN) of $p$, which has $N$ pixels: every "
        r"step of such a texture is a normal variable, of deviation $\alpha_i / \sqrt{N}$. No texture need be drawn.",
    ),
    Formula(
        r"\delta_\sigma = \frac{\mu_\sigma - \mathrm{TV}(p)}{\mu_\sigma}",
        r"The structure index: the share of total variation that the crop lacks. It has no unit, and depends neither "
        r"on brightness nor on contrast nor, on average, on the crop's size.",
    ),
    Formula(
        r"z = \frac{\mu_\sigma - \mathrm{TV}(p)}{\sigma_{\mathrm{TV}}}",
        r"The same difference in standard deviations of the total variation of those textures. At $\sigma = 0$ this is "
        r"the sharpness index of Blanchet and Moisan. It grows with the crop's size and rewards sharp asphalt, so it "
        r"does not tell textures apart; the API gives it beside $\delta$.",
    ),
    Formula(
        r"\sigma_{\mathrm{TV}}^2 = \frac{2}{\pi} \sum_{i, j} \alpha_i \alpha_j \sum_{y} "
        r"\omega \left( \frac{\Gamma_{ij}(y)}{\alpha_i \alpha_j} \right), "
        r"\quad \omega(t) = t \, \arcsin(t) + \sqrt{1 - t^2} - 1",
        r"Their variance, exact as well: $\Gamma_{ij}$ is the periodic correlation of $\dot{p}_i$ and $\dot{p}_j$.",
    ),
)
STUDY = (  # by benchmarks/meter.py: the area under the ROC curve, and errors of thresholds set without the photograph
    (r"$\delta_2$, at 2 pixels: the meter", 0.990, 0.036),
    (r"$\delta_0$, not smoothed", 0.881, 0.402),
    (r"$\delta_1$, at 1 pixel", 0.994, 0.094),
    (r"$\delta_4$, at 4 pixels", 0.912, 0.242),
    (r"$z$ at $\sigma = 0$", 0.574, 0.411),
    (r"$z$ at $\sigma = 2$", 0.863, 0.292),
    (r"mean of $\delta_1, \delta_2, \delta_4$", 0.992, 0.067),
    (r"greatest of $\delta_1, \delta_2, \delta_4$", 0.984, 0.112),
    (r"greatest $\delta_2$ of four directions", 0.990, 0.036),
    ("the same in a band, of 1 to 2 pixels", 0.954, 0.071),
    ("unevenness of local energy, at 1 pixel", 0.816, 0.286),
)

router = APIRouter(include_in_schema=False)


@dataclass(frozen=True)
class Measured:
    """A bundled photograph, its suggested crop and what the meter says of it."""

    sample: Sample
    title: str
    crop: Rectangle
    delta: float

    @property
    def reading(self) -> Reading:
        return reading(self.delta)

    @property
    def url(self) -> str:
        return f"/samples/{self.sample.id}?crop={self.crop}"


@dataclass(frozen=True)
class Placed:
    """Where a photograph's picture lies on the scale, whose foot is at 0."""

    photograph: Measured
    left: float
    top: float


def form_structure(service: Service, sample: Sample, values: Mapping[str, str]) -> Index | None:
    """Measure the crop that a form's fields name, for pages without a script; None if it cannot be measured."""
    with suppress(InvalidInputError, ValueError):
        crop = Rectangle.parse(",".join(values.get(name, "") for name in crop_names(1)))
        first = values.get(time_names(1)[0], "") if sample.moving else ""
        return service.structure(sample.id, crop, frame=whole(first) if first else 0)
    return None


@router.get("/structure")
def structure_page(request: Request, service: ServiceDep, settings: SettingsDep) -> Response:
    photographs = sorted(_photographs(service, settings), key=lambda each: each.delta)
    places = placed(photographs)
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


def _photographs(service: Service, settings: Settings) -> list[Measured]:
    """Those that have come in so far; a scene is no texture, a clip no photograph: neither has a place on the scale."""
    entries = {entry.id: entry for entry in bundled(settings.samples_dir) if entry.kind not in ("scene", "moving")}
    return [
        Measured(sample, entry.title, entry.crop, delta)
        for sample in service.bundled_samples()
        if (entry := entries.get(sample.id)) is not None
        and (delta := service.structure(sample.id, entry.crop).delta) is not None
    ]


def placed(photographs: Sequence[Measured]) -> list[Placed]:
    """Put pictures side by side at their index, each in the lowest row that has room for it there."""
    ends: list[float] = []  # of the rows, from the lowest
    places = []
    for photograph in photographs:
        left = 10 * meter_place(photograph.delta) - SIDE / 2
        row = next((row for row, end in enumerate(ends) if left >= end + GAP), len(ends))
        ends[row : row + 1] = [left + SIDE]
        places.append(Placed(photograph, left, -(row + 1) * (SIDE + GAP)))
    return places

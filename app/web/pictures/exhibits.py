"""Exhibits on pages: the pictures of a finished experiment, or placeholders for one that is not there yet."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from app.errors import AppError
from app.experiments.model import Experiment, Sample, Status
from app.experiments.service import Service
from app.images.crop import Rectangle
from app.methods.explanations.model import Exhibit, Figure
from app.methods.registry import method
from app.web.form.address import form_url
from app.web.pictures.addresses import output_url
from app.web.pictures.panes import input_parts
from app.web.pictures.videos import Video, find_video
from app.web.templating import label

SAMPLE = "Sample"
CROP = "crop"
MOST_IN_A_ROW = 7
SMALL = 160  # pixels; what is smaller is shown at twice its size
WIDE = 1760  # pixels; pictures of several sizes that are together no wider stand in one row, a little smaller if needed


@dataclass(frozen=True)
class ExhibitPicture:
    """One picture or video; ``url`` is empty for one that is being made, and ``change`` for all but an exhibit's last.

    ``leads`` says that it is an exhibit's first and an input.
    """

    caption: str
    url: str
    page: str
    width: int
    height: int
    change: str = ""
    crop: tuple[Sample, Rectangle] | None = None
    delta: float | None = None
    state: str = ""
    leads: bool = False
    video: Video | None = None


def exhibit_pictures(service: Service, exhibit: Exhibit) -> list[ExhibitPicture]:
    """The pictures of one exhibit, in its order."""
    made = service.exhibition.find(exhibit)
    if made is None or made.status is not Status.SUCCEEDED:
        return _make_placeholders(service, exhibit, made)
    change = form_url(made)
    deltas = _deltas(made)
    found = [output for name in exhibit.show if (output := made.output(name)) is not None]
    return [
        ExhibitPicture(
            caption=_caption(exhibit, output.name, output.title, first=output is found[0]),
            url=output_url(made, output.name),
            page=f"/experiments/{made.id}",
            width=output.width,
            height=output.height,
            change=change if output is found[-1] else "",
            delta=deltas.get(output.name),
            leads=output is found[0] and _is_crop(output.name),
            video=find_video(made, output),
        )
        for output in found
    ]


def figure_view(service: Service, figure: Figure) -> dict[str, Any]:
    """What the macro `figure` of ``_partials/figure.html`` takes: pictures by exhibit, and how to lay them out."""
    groups = [exhibit_pictures(service, exhibit) for exhibit in figure.exhibits]
    pictures = [picture for group in groups for picture in group]
    alike = len({picture.width for picture in pictures}) == 1
    rows = [pictures] if alike else groups
    if alike:
        columns = _columns([group[0].leads for group in groups], len(pictures))
    return {
        "figure": figure,
        "groups": [(group, sum(picture.width for picture in group) <= WIDE) for group in rows],
        "layout": f"of-{columns}" if alike else "mixed",
        "scale": 2 if max(picture.width for picture in pictures) <= SMALL else 1,
    }


def _columns(starts: Sequence[bool], count: int) -> int:
    """Pictures of one row: all of them if they fit, else so that every row starts with a sample, else half of them."""
    if count <= MOST_IN_A_ROW:
        return count
    rows = sum(starts)
    if rows > 1 and count % rows == 0:
        return count // rows
    return min(MOST_IN_A_ROW, -(-count // 2))


def _caption(exhibit: Exhibit, name: str, title: str, *, first: bool) -> str:
    if name == "texture":
        plain = title if exhibit.method in exhibit.show else label(exhibit.method)  # a texton is no texture
        return exhibit.label or plain
    words = _input_title(exhibit, name) if _is_crop(name) else title.replace("the crop", SAMPLE.lower())
    return f"{words}, {exhibit.label}" if first and exhibit.label and "texture" not in exhibit.show else words


def _is_crop(name: str) -> bool:
    return name == CROP or name.removeprefix(f"{CROP}-").isdigit()


def _input_title(exhibit: Exhibit, name: str) -> str:
    """Name an input by its part in the method, or as a sample."""
    number = int(name.removeprefix(CROP).removeprefix("-") or 1)
    if titles := input_parts(method(exhibit.method)):
        return titles[number - 1]
    return SAMPLE if number == 1 else f"{SAMPLE} {number}"


def _deltas(experiment: Experiment) -> dict[str, float]:
    """The structure index of the first crop and of the texture, by output; empty where it was not measured."""
    structure = experiment.diagnostics.get("structure", {})
    pairs = (("crop", structure.get("inputs")), ("texture", structure.get("outputs")))
    return {name: values[0] for name, values in pairs if values}


def _make_placeholders(service: Service, exhibit: Exhibit, made: Experiment | None) -> list[ExhibitPicture]:
    """The samples' crops, where they are on show, and one place for all that is not there yet."""
    try:
        experiment = service.exhibition.prepare(exhibit)
    except AppError:
        return [ExhibitPicture(label(exhibit.method), "", "", 256, 256, state="Sample not available yet")]
    page = f"/experiments/{made.id}" if made is not None else ""
    size = experiment.parameters["width"], experiment.parameters["height"]
    texture = ExhibitPicture(
        exhibit.label or label(exhibit.method),
        "",
        page,
        *size,
        change=form_url(experiment),
        state=_state(made, service.exhibition.making),
    )
    return [*_crops(service, exhibit, experiment), texture]


def _crops(service: Service, exhibit: Exhibit, experiment: Experiment) -> Iterator[ExhibitPicture]:
    for number, source in enumerate(experiment.inputs, 1):
        name = CROP if number == 1 else f"{CROP}-{number}"
        if name in exhibit.show:
            sample = service.samples.get(source.sample)
            title, size = _input_title(exhibit, name), (source.crop.width, source.crop.height)
            yield ExhibitPicture(
                title, "", f"/samples/{sample.id}", *size, crop=(sample, source.crop), leads=number == 1
            )


def _state(made: Experiment | None, making: bool) -> str:
    if made is None:
        return "Being made" if making else "Not made yet"
    return "Being made" if not made.status.finished else made.error or "It was cancelled."

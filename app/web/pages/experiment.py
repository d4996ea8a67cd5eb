"""Experiment page in all its states, and the actions of its buttons."""

import secrets
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Form, Query, Request
from fastapi.responses import RedirectResponse
from starlette.responses import Response
from starlette.status import HTTP_303_SEE_OTHER

from app.experiments.exhibition import is_exhibit
from app.experiments.files.outputs import MP4_SUFFIX
from app.experiments.files.renditions import PREVIEW_NAME
from app.experiments.model import Experiment, Sample, Status
from app.experiments.preparation import NewExperiment, NewInput
from app.experiments.service import Service
from app.images.crop import Frames, Rectangle
from app.images.video.writers import name_repeated_edges
from app.methods.fields import fields
from app.methods.model import Method
from app.methods.params import MovingParams
from app.methods.registry import METHODS, method
from app.web.clients import client_of
from app.web.deps import ServiceDep, TokenDep, base_url, choose_owner, read_press, remember_owner
from app.web.form.address import form_url, input_values, sample_url
from app.web.form.inputs import max_inputs
from app.web.limits import EXPERIMENTS, take
from app.web.pages.snippets import snippets
from app.web.pictures.addresses import output_url
from app.web.pictures.panes import (
    crop_panes,
    describe_looping,
    describe_tiling,
    facts,
    gallery,
    input_titles,
    steps,
    texture_pane,
)
from app.web.pictures.videos import is_video
from app.web.templating import label, render

SEEDS = 1_000_000  # new seeds are below this: few enough digits to read them aloud

View = Annotated[Literal["side", "flip", "slider", "tiled", "steps"], Query()]
Tiles = Annotated[int, Query(ge=2, le=3)]

router = APIRouter(include_in_schema=False)


def experiment_address(experiment: Experiment) -> str:
    return f"/experiments/{experiment.id}"


@router.get("/experiments/{experiment_id}")
def experiment_page(
    request: Request,
    experiment_id: str,
    service: ServiceDep,
    token: TokenDep,
    view: View = "side",
    tiles: Tiles = 2,
) -> Response:
    experiment = service.experiments.get(experiment_id)
    base = base_url(request)
    context = common_context(service, experiment, token) | {
        "title": f"{label(experiment.method)} of {subject(service, experiment)}",
        "view": view,
        "tiles": tiles,
        "url": f"{base}/experiments/{experiment.id}",
        "preview": None,
    }
    if experiment.status is Status.SUCCEEDED:
        context |= {
            "preview": f"{base}{output_url(experiment, PREVIEW_NAME)}",
            "panes": [*crop_panes(experiment), texture_pane(experiment)],
            "gallery": gallery(experiment),
            "steps": steps(experiment),
            "facts": list(facts(experiment)),
            "others": [other for other in METHODS.values() if _shares_phase(other, experiment)],
            "downloads": list(_downloads(experiment)),
            "padding": _padding(experiment),
            "timings": list(_timings(experiment)),
            "total": f"{sum(experiment.timings.values()):.2f} s",
            "tiling": tiling_note([experiment]),
            "snippets": snippets(experiment, base),
        }
    return render(request, "experiment.html", context)


def common_context(service: Service, experiment: Experiment, token: str | None) -> dict[str, Any]:
    declared = method(experiment.method)
    return {
        "experiment": experiment,
        "snapshot": service.watching.snapshot(experiment.id),
        "method": declared,
        "sources": _sources(service, experiment),
        "subject": subject(service, experiment),
        "owned": service.experiments.owns(experiment, token),
        "kept_until": service.retention.end(experiment),
        "hidden": not experiment.listed and not is_exhibit(experiment),
        "rows": list(parameter_rows(experiment)),
        "edit_url": form_url(experiment),
    }


@dataclass(frozen=True)
class Source:
    """One input: what it is called here, the sample and what is shown of it."""

    title: str
    sample: Sample
    name: str
    crop: Rectangle
    frames: Frames

    @property
    def url(self) -> str:
        """Its sample's page, opened at the crop and the time range."""
        return sample_url(self.sample.id, input_values(1, self.crop, self.frames))

    @property
    def range(self) -> str:
        """Of a video, which of its frames."""
        if not self.sample.moving:
            return ""
        last = self.frames.first + self.frames.count - 1
        which = f"frames {self.frames.first}–{last}" if self.frames.count > 1 else f"frame {last}"
        return f"{which} of {self.sample.frames}"


def _sources(service: Service, experiment: Experiment) -> list[Source]:
    found = [service.samples.get(source.sample) for source in experiment.inputs]
    names = [sample.title or ("A video" if sample.moving else "A photograph") for sample in found]
    parts = zip(input_titles(experiment), found, names, experiment.inputs, strict=True)
    return [Source(title, sample, name, of.crop, of.frames) for title, sample, name, of in parts]


def subject(service: Service, experiment: Experiment) -> str:
    """What the textures are of, each sample once, as in "gravel and rippled sand"."""
    *others, last = dict.fromkeys(source.name[0].lower() + source.name[1:] for source in _sources(service, experiment))
    return f"{', '.join(others)} and {last}" if others else last


def parameter_rows(experiment: Experiment) -> Iterator[tuple[str, str]]:
    """Give every parameter with the label its form has, for people."""
    words = {True: "yes", False: "no"}
    for entry in fields(method(experiment.method).params):
        value = experiment.parameters.get(entry.name)
        empty = value is None or value == ""
        yield entry.label, "–" if empty else words[value] if isinstance(value, bool) else str(value)


def _downloads(experiment: Experiment) -> Iterator[tuple[str, str]]:
    if is_video(experiment):
        yield "WebM", output_url(experiment, "texture", download=True)
        yield "MP4", output_url(experiment, "texture-mp4", download=True)
        yield "Animated WebP", output_url(experiment, "preview", download=True)
        yield "Everything, ZIP", f"/api/v1/experiments/{experiment.id}/outputs.zip"
        return
    texture = partial(output_url, experiment, "texture", download=True)
    depths: tuple[Literal[8, 16], ...] = (16, 8) if experiment.depth == 16 else (8, 16)  # the sample's own first
    for depth in depths:
        yield f"PNG, {depth} bit", texture(file_format="png", depth=depth)
    yield "JPEG", texture(file_format="jpeg")
    yield "WebP", texture(file_format="webp")
    yield f"TIFF, {depths[0]} bit", texture(file_format="tiff", depth=depths[0])
    yield "Everything, ZIP", f"/api/v1/experiments/{experiment.id}/outputs.zip"


def _padding(experiment: Experiment) -> str:
    """Say how the MP4 differs from the texture in size; nothing if it does not."""
    texture, other = experiment.output("texture"), experiment.output(f"texture{MP4_SUFFIX}")
    if texture is None or other is None or (texture.width, texture.height) == (other.width, other.height):
        return ""
    verb = "are" if texture.width % 2 and texture.height % 2 else "is"
    return (
        f"The MP4 has {other.width} × {other.height} pixels: it can have even sides only, and its "
        f"{name_repeated_edges(texture.width, texture.height)} {verb} there twice. "
        "The WebM has the texture’s own size, and tiles without a seam if the texture does."
    )


def _timings(experiment: Experiment) -> Iterator[tuple[str, str, str]]:
    """Give each stage, its time in words, and its bar's length in percent of the longest stage's."""
    stages: dict[str, float] = {}
    for stage, seconds in experiment.timings.items():
        words = stage.replace("-", " ").capitalize()
        stages[words] = stages.get(words, 0.0) + seconds
    longest = max(stages.values(), default=0.0)
    for words, seconds in stages.items():
        shown = f"{seconds * 1000:.0f} ms" if seconds < 1 else f"{seconds:.1f} s"
        yield words, shown, f"{100 * seconds / longest if longest else 0:.1f}"


def _shares_phase(other: Method, experiment: Experiment) -> bool:
    """Whether another method would draw the same phase from these inputs."""
    declared = method(experiment.method)
    fits = len(other.inputs) <= len(experiment.inputs) <= max_inputs(other)
    return other.name != declared.name and other.phase and declared.phase and fits


def tiling_note(experiments: Sequence[Experiment]) -> str:
    """Say whether their textures tile in space, and videos loop in time."""
    declared = [method(experiment.method) for experiment in experiments]
    # Not validated: an old experiment's parameters may be none that a later version takes.
    params = [each.params.model_construct(**run.parameters) for each, run in zip(declared, experiments, strict=True)]
    seamless = [each.toroidal(chosen) for each, chosen in zip(declared, params, strict=True)]
    loops = [getattr(chosen, "loop", True) for chosen in params if isinstance(chosen, MovingParams)]
    return f"{describe_tiling(seamless)} {describe_looping(loops)}".rstrip()


@router.post("/experiments/{experiment_id}/again")
def again(
    request: Request,
    experiment_id: str,
    service: ServiceDep,
    token: TokenDep,
    name: Annotated[str, Form(alias="method")],
    seed: Annotated[str, Form()] = "",
    press: Annotated[str, Form()] = "",
) -> Response:
    """Run the same crop once more: with a new seed, or by another method with the same phase."""
    take(request, EXPERIMENTS)
    key = read_press(press)
    experiment = service.experiments.get(experiment_id)
    known = method(name).params.model_fields
    parameters = {key: value for key, value in experiment.parameters.items() if key in known}
    if seed == "new":
        parameters["seed"] = (int(key, 16) if key else secrets.randbits(64)) % SEEDS  # a press has one seed
    inputs = tuple(NewInput(source.sample, source.crop, source.frames) for source in experiment.inputs)
    owner = choose_owner(token, key)
    listed = experiment.listed or is_exhibit(experiment)
    wanted = NewExperiment(name, inputs, parameters, listed)
    run = service.submission.submit(wanted, owner, key, client=client_of(request).name)
    other = name != experiment.method
    response = RedirectResponse(
        f"/compare/{experiment.id}/{run.id}" if other else f"/experiments/{run.id}", HTTP_303_SEE_OTHER
    )
    remember_owner(request, response, owner)
    return response


@router.post("/experiments/{experiment_id}/cancel")
def cancel(experiment_id: str, service: ServiceDep, token: TokenDep) -> Response:
    """Cancel what waits or runs; one that finished in the meantime stays, for nobody asked to delete it."""
    if not service.experiments.get(experiment_id).status.finished:
        service.experiments.cancel_or_delete(experiment_id, token)
    return RedirectResponse(f"/experiments/{experiment_id}", HTTP_303_SEE_OTHER)


@router.post("/experiments/{experiment_id}/delete")
def delete(experiment_id: str, service: ServiceDep, token: TokenDep) -> Response:
    service.experiments.cancel_or_delete(experiment_id, token)
    return RedirectResponse("/archive", HTTP_303_SEE_OTHER)


@router.post("/experiments/{experiment_id}/{listing}")
def set_listed(
    experiment_id: str, listing: Literal["list", "unlist"], service: ServiceDep, token: TokenDep
) -> Response:
    service.experiments.set_listed(experiment_id, listing == "list", token)
    return RedirectResponse(f"/experiments/{experiment_id}", HTTP_303_SEE_OTHER)

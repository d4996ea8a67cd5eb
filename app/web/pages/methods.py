"""Method pages: the overview, and one page for each method."""

from dataclasses import dataclass

from fastapi import APIRouter, Request
from starlette.responses import Response

from app.errors import AppError
from app.experiments.model import Experiment
from app.experiments.service import Service
from app.gallery.exhibits import teaser
from app.gallery.groups import Group, groups
from app.methods.explanations.model import Exhibit
from app.methods.fields import FormField, fields
from app.methods.model import Method
from app.methods.registry import METHODS, method
from app.web.deps import ServiceDep, base_url
from app.web.form.address import form_url
from app.web.pages.snippets import snippets
from app.web.pictures.exhibits import ExhibitPicture, exhibit_pictures, figure_view
from app.web.templating import render

BIBTEX = "application/x-bibtex; charset=utf-8"

router = APIRouter(include_in_schema=False)


@dataclass(frozen=True)
class Card:
    """A method of the overview: a sample, and what the method makes of it."""

    method: Method
    pictures: list[ExhibitPicture]


@router.get("/methods")
def overview(request: Request, service: ServiceDep) -> Response:
    def cards(group: Group) -> list[Card]:
        return [Card(declared, exhibit_pictures(service, _pair(declared))) for declared in group.methods]

    return render(request, "methods.html", {"groups": [(group, cards(group)) for group in groups()]})


@router.get("/methods/{name}.bib")
def bibliography(name: str) -> Response:
    """The references of a method as a BibTeX file."""
    entries = "\n\n".join(reference.bibtex for reference in method(name).references)
    return Response(f"{entries}\n", media_type=BIBTEX)


@router.get("/methods/{name}")
def method_page(request: Request, name: str, service: ServiceDep) -> Response:
    declared = method(name)
    example = _example(service, declared)
    names = list(METHODS)
    place = names.index(name)
    context = {
        "method": declared,
        "rows": [(entry, _span(entry)) for entry in fields(declared.params)],
        "figures": [figure_view(service, figure) for figure in declared.explanation.figures],
        "run_url": form_url(example) if example else "/",
        "snippets": snippets(example, base_url(request))[:2] if example else (),
        "before": METHODS[names[place - 1]] if place else None,
        "after": METHODS[names[place + 1]] if place + 1 < len(names) else None,
    }
    return render(request, "method.html", context)


def _pair(declared: Method) -> Exhibit:
    """What stands for a method, as sample and texture."""
    first = teaser(declared)
    return Exhibit(first.method, first.inputs, first.parameters)


def _example(service: Service, declared: Method) -> Experiment | None:
    """The method's first exhibit, not begun; None until its sample has come in."""
    try:
        return service.exhibition.prepare(teaser(declared))
    except AppError:
        return None


def _span(entry: FormField) -> str:
    """What a parameter may be, in short.

    Examples
    --------
    >>> [_span(entry) for entry in fields(METHODS["rpn"].params) if entry.name in ("width", "alpha", "window")]
    ['1 – 1000000', '0 – 0.5', 'bump, gaussian']
    """
    if entry.kind == "choice":
        return ", ".join(entry.choices)
    if entry.kind == "switch":
        return "on, off"
    return f"{entry.minimum} – {entry.maximum}" if entry.minimum else ""

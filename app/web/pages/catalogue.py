"""Catalogue page: where random phase noise succeeds and fails; and the figures of the literature."""

from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import Response

from app.experiments.service import Service
from app.gallery.catalogue import FAILURES, SUCCESSES, Pair
from app.gallery.literature import FIGURES
from app.web.deps import ServiceDep
from app.web.pictures.exhibits import exhibit_pictures, figure_view
from app.web.templating import render

router = APIRouter(include_in_schema=False)


@router.get("/catalogue")
def catalogue(request: Request, service: ServiceDep) -> Response:
    context = {"successes": _views(service, SUCCESSES), "failures": _views(service, FAILURES)}
    return render(request, "catalogue.html", context)


@router.get("/figures")
def figures(request: Request, service: ServiceDep) -> Response:
    entries = [{"entry": entry, "view": figure_view(service, entry.figure)} for entry in FIGURES]
    return render(request, "figures.html", {"entries": entries})


def _views(service: Service, pairs: tuple[Pair, ...]) -> list[dict[str, Any]]:
    return [{"pair": pair, "pictures": exhibit_pictures(service, pair.exhibit)} for pair in pairs]

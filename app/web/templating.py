"""Jinja templates: the environment, its filters and globals."""

import re
from collections.abc import Mapping
from math import sqrt
from pathlib import Path
from typing import Any

from fastapi import Request
from fastapi.templating import Jinja2Templates
from starlette.responses import Response

from app.experiments.meter import MICRO, STRUCTURED, interpret
from app.methods.registry import METHODS
from app.settings import ROOT
from app.web.pictures.addresses import output_url, sample_image_url, sample_video_url
from app.web.prose import mathml, prose

TEMPLATES = Jinja2Templates(directory=Path(ROOT) / "templates")
METER_END = 0.4  # the index at which the bar is full; bricks lie at 0.3
TEMPLATES.env.trim_blocks = True
TEMPLATES.env.lstrip_blocks = True


def label(method: str) -> str:
    """Name a method briefly, as people do: by the part of its title that holds its name's words, or by its name.

    Examples
    --------
    >>> [label(name) for name in ("rpn", "mix", "modulus-phase", "rayleigh", "heeger-bergen", "efros-leung")]
    ['RPN', 'Mix', 'Modulus and phase', 'Rayleigh', 'Heeger–Bergen', 'Efros–Leung']
    """
    words = r"\W+(?:\w+\W+)?".join(method.split("-"))
    found = re.findall(rf"(?=\b({words})\b)", METHODS[method].title, re.IGNORECASE)
    name = min(found, key=len, default=method.replace("-", " "))
    return name[:1].upper() + name[1:]


def meter_place(delta: float) -> float:
    """Where a structure index stands on its bar, in percent: by its square root, for most photographs are near 0.

    Examples
    --------
    >>> [meter_place(delta) for delta in (-0.01, 0.1, 0.4, 0.6)]
    [0.0, 50.0, 100.0, 100.0]
    """
    return round(min(100.0, 100 * sqrt(max(delta, 0.0) / METER_END)), 1)


TEMPLATES.env.filters.update(label=label, reading=interpret, meter_place=meter_place, mathml=mathml, prose=prose)
TEMPLATES.env.globals.update(meter_limits=(MICRO, STRUCTURED), meter_end=METER_END)
TEMPLATES.env.globals.update(
    output_url=output_url, sample_image_url=sample_image_url, sample_video_url=sample_video_url
)


def render(request: Request, template: str, context: Mapping[str, Any], status: int = 200) -> Response:
    """Fill a page in. Pages change with every experiment, so nothing keeps a copy of one without asking.

    They are for who asked: some show the owner's buttons.
    """
    response = TEMPLATES.TemplateResponse(request, template, dict(context), status_code=status)
    response.headers["Cache-Control"] = "private, no-cache"
    return response

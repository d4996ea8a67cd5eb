"""The pages' template environment, and what every template is given."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fastapi import Request
from fastapi.templating import Jinja2Templates
from starlette.responses import Response

from app.methods.registry import METHODS
from app.settings import ROOT

TEMPLATES = Jinja2Templates(directory=Path(ROOT) / "templates")
TEMPLATES.env.trim_blocks = True
TEMPLATES.env.lstrip_blocks = True


def label(method: str) -> str:
    """Name a method as people do: in capitals if its title says so, as in "Random phase noise (RPN)".

    Examples
    --------
    >>> label("rpn")
    'RPN'
    """
    return method.upper() if method.upper() in METHODS[method].title else method.replace("-", " ").capitalize()


TEMPLATES.env.filters["label"] = label


def render(request: Request, template: str, context: Mapping[str, Any], status: int = 200) -> Response:
    """Fill a page in. Pages change with every experiment, so nothing keeps a copy of one without asking."""
    response = TEMPLATES.TemplateResponse(request, template, dict(context), status_code=status)
    response.headers["Cache-Control"] = "no-cache"
    return response

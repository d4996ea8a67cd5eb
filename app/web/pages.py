"""The pages a person sees: home, sample, archive and errors. They work without JavaScript; the modules in `static/js` make them better."""

from fastapi import APIRouter, Request
from starlette.responses import Response

from app.web.templating import render

router = APIRouter(include_in_schema=False)


def render_error(request: Request, status: int, title: str, detail: str) -> Response:
    """The page that says what went wrong and where to go from here."""
    return render(request, "error.html", {"status": status, "title": title, "detail": detail}, status)

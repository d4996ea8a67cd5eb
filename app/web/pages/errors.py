"""Error pages."""

from fastapi import Request
from starlette.responses import Response

from app.web.templating import render

WORDS = {
    403: "This is not yours",
    404: "There is nothing here",
    405: "This address does not do that",
    409: "It is too late for that",
    410: "This was deleted",
    413: "This is too large",
    415: "This is neither a photograph nor a clip",
    422: "This does not fit",
    500: "Something went wrong on our side",
    503: "All hands are busy",
}


def render_error(request: Request, status: int, title: str, detail: str) -> Response:
    """Show what went wrong and where to go from here; ``title`` is the protocol's name for it."""
    return render(
        request, "error.html", {"status": status, "title": WORDS.get(status, title), "detail": detail}, status
    )

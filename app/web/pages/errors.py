"""Error pages: a plain title for each status code, and what to do."""

from fastapi import Request
from starlette.responses import Response

from app.web.templating import render

WORDS = {
    403: "Not allowed",
    404: "Not found",
    405: "Method not allowed",
    409: "No longer possible",
    410: "Deleted",
    413: "File too large",
    415: "Unsupported file type",
    422: "Please correct the form",
    429: "Too many requests — wait a moment",
    500: "Something went wrong",
    503: "Server busy — try again shortly",
}


def render_error(request: Request, status: int, title: str, detail: str) -> Response:
    """Show what went wrong and where to go from here; ``title`` is the protocol's name for it."""
    return render(
        request, "error.html", {"status": status, "title": WORDS.get(status, title), "detail": detail}, status
    )

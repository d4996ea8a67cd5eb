"""Archive page: the public experiments, newest first."""

from urllib.parse import urlencode

from fastapi import APIRouter, Request
from starlette.responses import Response

from app.methods.registry import METHODS
from app.web.deps import (
    ServiceDep,
)
from app.web.templating import render

PER_PAGE = 24
TRAIL = 30  # pages of the archive that "Newer" finds its way back through


router = APIRouter(include_in_schema=False)


@router.get("/archive")
def archive(
    request: Request, service: ServiceDep, method: str | None = None, cursor: str | None = None, trail: str = ""
) -> Response:
    """List what is public; ``trail`` holds the cursors of the pages passed, for keyset paging only goes onwards."""
    chosen = method if method in METHODS else None
    page = service.experiments.page(limit=PER_PAGE, cursor=cursor, method=chosen)
    cursors = [part for part in trail.split(" ") if part]

    def address(to: str | None, through: list[str]) -> str:
        query = {"method": chosen, "cursor": to, "trail": " ".join(through[-TRAIL:])}
        query_string = urlencode({name: value for name, value in query.items() if value})
        return f"/archive?{query_string}" if query_string else "/archive"

    context = {
        "experiments": page.experiments,
        "methods": METHODS.values(),
        "chosen": chosen,
        "paged": bool(cursor),
        "older": address(page.cursor, [*cursors, cursor] if cursor else []) if page.cursor else None,
        "newer": address(cursors[-1] if cursors else None, cursors[:-1]) if cursor else None,
    }
    return render(request, "archive.html", context)

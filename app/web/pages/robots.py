"""Robots exclusion (RFC 9309), ``/robots.txt``: crawlers read pages and previews, and order no work."""

from fastapi import APIRouter
from starlette.responses import PlainTextResponse, Response

# Unlisted experiments are not named here: their pages say noindex, which only who may read them sees.
RULES = """User-agent: *
Allow: /api/v1/experiments/*/outputs/.preview
Disallow: /api/
Disallow: /compare/
Disallow: /samples/*?
"""

router = APIRouter(include_in_schema=False)


@router.get("/robots.txt")
async def robots() -> Response:
    return PlainTextResponse(RULES, headers={"Cache-Control": "public, max-age=86400"})

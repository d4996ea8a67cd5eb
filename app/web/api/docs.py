"""API documentation, ``/docs``: Swagger UI on the OpenAPI document, served from this host only."""

from importlib.resources import files
from pathlib import Path

from fastapi import APIRouter
from starlette.responses import HTMLResponse, Response

from app.web.api.records import API

SWAGGER_FILES = Path(str(files("fastapi_swagger"))) / "resources"
SWAGGER_URL = "/docs/swagger"
OPENAPI_URL = f"{API}/openapi.json"

router = APIRouter(include_in_schema=False)

_PAGE = f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>REST API · Microtexture</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="{SWAGGER_URL}/swagger-ui.css">
</head>
<body>
<nav class="swagger-ui"><div class="wrapper"><a class="link" href="/">← Microtexture</a></div></nav>
<noscript><p>This page needs JavaScript; the document itself is <a href="{OPENAPI_URL}">openapi.json</a>.</p></noscript>
<main id="swagger-ui" data-document="{OPENAPI_URL}"></main>
<script src="{SWAGGER_URL}/swagger-ui-bundle.js"></script>
<script src="/static/js/pages/docs.js"></script>
</body>
</html>
"""


@router.get("/docs")
async def docs() -> Response:
    return HTMLResponse(_PAGE)

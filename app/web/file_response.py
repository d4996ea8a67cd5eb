"""File responses: ETag, Range, If-None-Match (304) and Content-Disposition."""

import re
from pathlib import Path
from typing import Literal

from fastapi import Request
from starlette.exceptions import HTTPException
from starlette.responses import FileResponse, Response

FOREVER = "public, max-age=31536000, immutable"
FOREVER_FOR_ME = "private, max-age=31536000, immutable"
SUFFIXES = {
    "image/png": ".png",
    "image/jpeg": ".jpg",
    "image/webp": ".webp",
    "image/tiff": ".tif",
    "video/webm": ".webm",
    "video/mp4": ".mp4",
}
_RANGE = re.compile(r"bytes=(?:(?P<first>\d{1,18})-(?P<last>\d{1,18})?|-(?P<suffix>\d{1,18}))")


def matches(request: Request, tag: str) -> bool:
    """Whether ``If-None-Match`` says that the client has this already."""
    sent = request.headers.get("if-none-match", "")
    return sent.strip() == "*" or f'"{tag}"' in [part.strip().removeprefix("W/") for part in sent.split(",")]


def not_modified(tag: str, cache: str) -> Response:
    return Response(status_code=304, headers={"ETag": f'"{tag}"', "Cache-Control": cache})


def file_response(
    request: Request,
    path: Path,
    media_type: str,
    *,
    tag: str,
    filename: str,
    cache: str,
    disposition: Literal["inline", "attachment"] = "inline",
) -> Response:
    """Answer with the file, the part of it that was range_header for, or 304.

    Raises
    ------
    HTTPException
        416 if the range begins behind the file's end.
    """
    if matches(request, tag):
        return not_modified(tag, cache)
    _keep_usable_range(request, path.stat().st_size, tag)
    return FileResponse(
        path,
        headers={"ETag": f'"{tag}"', "Cache-Control": cache},
        media_type=media_type,
        filename=filename,
        content_disposition_type=disposition,
    )


def _keep_usable_range(request: Request, size: int, tag: str) -> None:
    """Hide a ``Range`` that RFC 9110 lets servers ignore: malformed, of several parts, or of another version."""
    range_header = request.headers.get("range")
    if range_header is None:
        return
    found = _RANGE.fullmatch(range_header.replace(" ", "").lower())
    backwards = found and found["last"] and int(found["last"]) < int(found["first"])
    if not found or backwards or request.headers.get("if-range", f'"{tag}"') != f'"{tag}"':
        request.scope["headers"] = [
            header for header in request.scope["headers"] if header[0] not in {b"range", b"if-range"}
        ]
        return
    if int(found["suffix"] or 0) == 0 if found["first"] is None else int(found["first"]) >= size:
        raise HTTPException(
            416, f"The range is not within the file's {size} bytes.", {"Content-Range": f"bytes */{size}"}
        )

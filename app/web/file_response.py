"""File responses: ETag, Range, If-None-Match (304) and Content-Disposition."""

import re
from datetime import datetime
from email.utils import format_datetime
from pathlib import Path
from typing import Annotated, Literal

from fastapi import Query, Request
from starlette.exceptions import HTTPException
from starlette.responses import FileResponse, Response

from app.errors import NotFoundError

Version = Annotated[
    str | None,
    Query(
        alias="v",
        max_length=64,
        description="Version of the bytes, as in the addresses on pages: while it fits, the answer is `immutable`; "
        "else caches ask, with its `ETag`, whether it is still the same.",
    ),
]
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


def cache_control(version: str | None, current: str, *, public: bool) -> str:
    """Say who may keep a file, and for how long: for ever under an address that names these very bytes only.

    Parameters
    ----------
    version : str, optional
        What the address says.
    current : str
        What it says if it was made of the file of today.
    public : bool
        Whether everybody may see it: caches that several people share keep nothing else.
    """
    keep = "max-age=31536000, immutable" if version == current else "no-cache"
    return f"{'public' if public else 'private'}, {keep}"


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
    modified: datetime,
    disposition: Literal["inline", "attachment"] = "inline",
) -> Response:
    """Answer with the file, the part of it that was asked for, or 304.

    ``modified``, in UTC, is when its original was made: the file itself may be a copy that is made again and again.

    Raises
    ------
    NotFoundError
        If somebody removed it meanwhile.
    HTTPException
        416 if the range begins behind the file's end.
    """
    if matches(request, tag):
        return not_modified(tag, cache)
    try:
        state = path.stat()
    except FileNotFoundError:
        raise NotFoundError("This file is not here any more: it was deleted a moment ago.") from None
    _keep_usable_range(request, state.st_size, tag)
    return FileResponse(
        path,
        stat_result=state,
        headers={"ETag": f'"{tag}"', "Cache-Control": cache, "Last-Modified": format_datetime(modified, usegmt=True)},
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

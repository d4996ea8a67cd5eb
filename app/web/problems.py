"""Error responses: RFC 9457 problem details under ``/api``, pages elsewhere; the status code of each error."""

from collections.abc import Callable, Mapping, Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect
from starlette.responses import JSONResponse, Response
from starlette.routing import Match

from app import errors
from app.experiments.failures import unavailability
from app.methods.fields import reason
from app.numbers import quote
from app.web.headers import API_PREFIX, security_headers
from app.web.request_id import HEADER, request_id

MEDIA_TYPE = "application/problem+json"
RETRY_SECONDS = 10
FAULTS = 20  # that an answer lists
LONGEST_PLACE = 40  # characters of a field's name that are said back

STATUS: dict[type[errors.AppError], int] = {
    errors.InvalidInputError: 422,
    errors.BrokenFileError: 422,
    errors.UnsupportedFormatError: 415,
    errors.TooLargeError: 413,
    errors.NotFoundError: 404,
    errors.DeletedError: 410,
    errors.ForbiddenError: 403,
    errors.ConflictError: 409,
    errors.CancelledError: 409,
    errors.TimeLimitError: 422,
    errors.QuotaError: 429,
    errors.BusyError: 503,
    errors.UnavailableError: 503,
}

_TITLES = {413: "Content Too Large", 422: "Unprocessable Content"}  # RFC 9110's names, which Python has from 3.13 on
_DETAILS = {
    400: "The request could not be read: check its body and its Content-Type.",
    404: "There is nothing at this address.",
    405: "This address does not answer this method; the Allow header names those that it does.",
    500: "Something went wrong on our side. It has been logged; trying again may help.",
}

RenderError = Callable[[Request, int, str, str], Response]


def status_of(error: errors.AppError) -> int:
    """Give the status code of an error's meaning."""
    return next((STATUS[kind] for kind in type(error).__mro__ if kind in STATUS), 500)


def retry_headers(error: errors.AppError) -> dict[str, str]:
    """Give the header that says when to ask again, of an error that passes."""
    if isinstance(error, errors.QuotaError):
        return {"Retry-After": str(error.retry_after)}
    return {"Retry-After": str(RETRY_SECONDS)} if status_of(error) == 503 else {}


def title(status: int) -> str:
    """Name a status code."""
    return _TITLES.get(status) or HTTPStatus(status).phrase


def problem(
    status: int,
    detail: str,
    *,
    faults: Sequence[Mapping[str, str]] = (),
    headers: Mapping[str, str] | None = None,
    part: str | None = None,
) -> Response:
    """Make an ``application/problem+json`` answer.

    ``faults`` name the fields at fault: ``{"field", "message"}``; ``part`` is what is unavailable.
    """
    body: dict[str, Any] = {"type": "about:blank", "title": title(status), "status": status, "detail": detail}
    if identifier := request_id():
        body["instance"] = f"urn:uuid:{identifier}"
    if faults:
        body["errors"] = [dict(fault) for fault in faults]
    if part is not None:
        body["part"] = part
    return JSONResponse(body, status, {"Cache-Control": "no-store", **(headers or {})}, media_type=MEDIA_TYPE)


def respond(
    request: Request,
    status: int,
    detail: str,
    *,
    faults: Sequence[Mapping[str, str]] = (),
    headers: Mapping[str, str] | None = None,
) -> Response:
    """Make a problem for a program, a page for a person: by the address that was asked for, and by who asks.

    A browser says when it asks for something to show in a tab: a link to a download leads into the API.
    """
    in_a_tab = request.headers.get("sec-fetch-dest") == "document"
    if request.scope["path"].startswith(API_PREFIX) and not in_a_tab:
        return problem(status, detail, faults=faults, headers=headers)
    render: RenderError = request.app.state.render_error
    response = render(request, status, title(status), detail)
    response.headers.update(headers or {})
    return response


async def _app_error(request: Request, error: Exception) -> Response:
    assert isinstance(error, errors.AppError)
    status = status_of(error)
    field = getattr(error, "field", None)
    return respond(
        request,
        status,
        error.message,
        faults=[{"field": field, "message": error.message}] if field else [],
        headers=retry_headers(error),
    )


async def _file_error(request: Request, error: Exception) -> Response:
    """Answer that the storage is away or full: nobody else is to blame that a file cannot be read or written."""
    assert isinstance(error, OSError)
    return await _app_error(request, unavailability(error))


async def _validation_error(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    found = error.errors()
    if any(fault["type"] == "json_invalid" for fault in found):
        position = found[0]["loc"][-1]
        return respond(request, 400, f"The body is not valid JSON: {found[0]['ctx']['error']} at character {position}.")
    if any(fault["loc"][0] == "path" for fault in found):
        return respond(request, 404, _DETAILS[404])
    faults = [{"field": _place(fault), "message": _message(fault)} for fault in found[:FAULTS]]
    more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
    return respond(request, 422, f"{faults[0]['message']}{more}", faults=faults)


def _place(fault: Mapping[str, Any]) -> str:
    place = ".".join(str(part) for part in fault["loc"][1:])
    return place if len(place) <= LONGEST_PLACE else f"{place[:LONGEST_PLACE]}…"


def _message(fault: Mapping[str, Any]) -> str:
    """Name the field, what is wrong with it and what came; of a missing one nothing came."""
    came = "" if fault["type"] == "missing" else f"; got {quote(fault['input'])}"
    return f"{_place(fault) or 'The body'}: {reason(fault['msg'])}{came}."


async def _http_error(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    status, headers = error.status_code, dict(error.headers or {})
    if status in {204, 304}:
        return Response(status_code=status, headers=headers)
    if status == 405:
        headers["Allow"] = ", ".join(_allowed_methods(request))
    own_words = error.detail and error.detail != HTTPStatus(status).phrase
    return respond(request, status, error.detail if own_words else _DETAILS.get(status, error.detail), headers=headers)


def _allowed_methods(request: Request) -> list[str]:
    """Every method this address answers: Starlette's own header names those of one route only."""
    methods = [
        method
        for method in ("GET", "POST", "PUT", "PATCH", "DELETE")
        if any(route.matches({**request.scope, "method": method})[0] is Match.FULL for route in request.app.routes)
    ]
    return ["GET", "HEAD", *methods[1:]] if methods[:1] == ["GET"] else methods


async def _unexpected_error(request: Request, _error: Exception) -> Response:
    """Answer without internals (the server logs them), with the headers that no middleware adds to this answer."""
    path = request.scope["path"]
    identifier = {HEADER: request_id()}
    words = f"{_DETAILS[500]} The log knows this request as {request_id()}."
    return respond(request, 500, words, headers=dict(security_headers(path)) | identifier)


async def _client_disconnected(_request: Request, _error: Exception) -> Response:
    """Answer a client that disconnected during upload; the response is never read and nothing is logged."""
    return Response(status_code=400)


def install(app: FastAPI, render_error: RenderError) -> None:
    """Register the handlers; ``render_error`` makes the page of an error outside ``/api``."""
    app.state.render_error = render_error
    app.add_exception_handler(errors.AppError, _app_error)
    app.add_exception_handler(OSError, _file_error)
    app.add_exception_handler(RequestValidationError, _validation_error)
    app.add_exception_handler(HTTPException, _http_error)
    app.add_exception_handler(ClientDisconnect, _client_disconnected)
    app.add_exception_handler(Exception, _unexpected_error)

"""Synthesis in one request, ``POST /api/v1/synthesize``: files in, an output back, nothing stored."""

import asyncio
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, Literal, TypeVar, cast

from fastapi import APIRouter, Request
from starlette.requests import ClientDisconnect
from starlette.responses import Response

from app.errors import InvalidInputError
from app.experiments.files.outputs import AnyFormat
from app.images.crop import Frames, Rectangle
from app.methods.effects import possible_output
from app.methods.outputs import OutputSpec
from app.methods.registry import METHODS
from app.web.api.openapi import form_parameters, problems
from app.web.api.records import API
from app.web.clients import client_of
from app.web.deps import ServiceDep
from app.web.file_response import SUFFIXES
from app.web.limits import EXPERIMENTS, take, take_upload
from app.web.uploads import Form, receive_form

router = APIRouter(prefix=API, tags=["experiments"])

PNG, WEBM = "image/png", "video/webm"
STILLS: dict[str, AnyFormat] = {
    PNG: "png",
    "image/jpeg": "jpeg",
    "image/webp": "webp",
    "image/tiff": "tiff",
}
VIDEOS: dict[str, AnyFormat] = {WEBM: "webm", "video/mp4": "mp4"}
FORMATS = STILLS | VIDEOS
_DEPTHS: dict[str, Literal[8, 16]] = {"8": 8, "16": 16}

FILES = ("file", "file-2", "file-3", "file-4")
CROPS = ("crop", "crop-2", "crop-3", "crop-4")
TIMES = ("time", "time-2", "time-3", "time-4")


_Part = TypeVar("_Part", Rectangle, Frames)


def _describe(number: int, what: str) -> str:
    return what if number == 1 else f"The same of input {number}, for methods that take several."


_FORM: dict[str, Any] = {
    "type": "object",
    "required": ["file", "method"],
    "properties": {
        "method": {"type": "string", "enum": list(METHODS), "description": "Name of a method."},
        **{
            name: {
                "type": "string",
                "contentMediaType": "application/octet-stream",
                "description": _describe(
                    number,
                    "PNG, JPEG, WebP or TIFF, 8 or 16 bits, grey or colour; or a video: MP4, WebM, GIF, animated WebP "
                    "or APNG.",
                ),
            }
            for number, name in enumerate(FILES, 1)
        },
        **{
            name: {
                "type": "string",
                "pattern": r"^\d{1,6},\d{1,6},\d{1,6},\d{1,6}$",
                "description": _describe(
                    number, "`x,y,width,height` in pixels of the upright picture; default: all of it."
                ),
                "examples": ["0,0,256,256"],
            }
            for number, name in enumerate(CROPS, 1)
        },
        **{
            name: {
                "type": "string",
                "pattern": r"^\d{1,6},\d{1,6}$",
                "description": _describe(
                    number,
                    "`first,count`: a range of a video's frames; default: all of them where the method takes a video, "
                    "else the first.",
                ),
                "examples": ["0,48"],
            }
            for number, name in enumerate(TIMES, 1)
        },
        "output": {
            "type": "string",
            "default": "texture",
            "description": "Name of the output that is the answer; `GET /api/v1/methods` lists those of every method. "
            "A parameter that changes nothing of it is refused.",
            "examples": ["texture", "spot"],
        },
        "format": {
            "type": "string",
            "enum": list(FORMATS.values()),
            "description": "Of the answer; default: what `Accept` prefers, else PNG, and WebM of a video.",
        },
        "depth": {
            "type": "string",
            "enum": list(_DEPTHS),
            "description": "Bits per channel, of PNG and TIFF; default: as the deepest of the photographs.",
        },
        **form_parameters(),
    },
}


@router.post(
    "/synthesize",
    summary="A texture, or another output, straight from photographs",
    response_class=Response,
    responses={
        200: {
            "description": "The output.",
            "content": {media: {"schema": {"type": "string", "format": "binary"}} for media in FORMATS},
        },
        **problems(409, 422, 429, 503),
    },
    openapi_extra={"requestBody": {"required": True, "content": {"multipart/form-data": {"schema": _FORM}}}},
)
async def synthesize(request: Request, service: ServiceDep) -> Response:
    """Every parameter of the method is a field of the form. Nothing of it is kept; hanging up cancels it.

    What would change nothing of the answer is refused, for it may have been meant for another one.
    """
    take_upload(request)
    take(request, EXPERIMENTS)
    async with receive_form(request, FILES) as form:
        arguments = _read_arguments(request, form)
        running = asyncio.ensure_future(service.transient.synthesize(**arguments, client=client_of(request).name))
        hung_up = asyncio.ensure_future(_wait_for_disconnect(request))
        try:
            await asyncio.wait({running, hung_up}, return_when=asyncio.FIRST_COMPLETED)
            if not running.done():
                raise ClientDisconnect
            picture, media_type = running.result()
        except InvalidInputError as error:
            raise InvalidInputError(error.message, _form_field(error.field)) from None
        finally:
            hung_up.cancel()
            running.cancel()
            await asyncio.wait({running, hung_up})
    name = f"{arguments['method']}-{arguments['output']}{SUFFIXES[media_type]}"
    headers = {"Content-Disposition": f'inline; filename="{name}"', "Cache-Control": "no-store", "Vary": "Accept"}
    return Response(picture, media_type=media_type, headers=headers)


def _read_arguments(request: Request, form: Form) -> dict[str, Any]:
    """Read the form as the service's arguments; what is left empty counts as left out."""
    fields = {name: value.strip() for name, value in form.fields.items() if value.strip()}
    if form.file is None:
        raise InvalidInputError("Send a picture or a clip in the form's field 'file'.", "file")
    for missing, name in pairwise(FILES):
        if name in form.files and missing not in form.files:
            raise InvalidInputError(f"The form has a file in '{name}' and none in '{missing}'.", missing)
    method = fields.pop("method", "")
    if method not in METHODS:
        raise InvalidInputError(
            f"Name a method in the field 'method'. The methods are: {', '.join(METHODS)}.", "method"
        )
    crops = _pop_parts(Rectangle.parse, CROPS, fields)
    times = _pop_parts(Frames.parse, TIMES, fields)
    output = possible_output(METHODS[method], fields.pop("output", "texture"))
    file_format = fields.pop("format", None)
    if file_format is not None and file_format not in FORMATS.values():
        raise InvalidInputError(f"The format is one of: {', '.join(FORMATS.values())}.", "format")
    depth = fields.pop("depth", None)
    if depth is not None and depth not in _DEPTHS:
        raise InvalidInputError("The depth is 8 or 16 bits per channel.", "depth")
    return {
        "uploads": [form.files[name] for name in FILES if name in form.files],
        "method": method,
        "crops": crops,
        "frames": times,
        "parameters": fields,
        "output": output.name,
        "file_format": file_format or _choose_format(request, output),
        "depth": None if depth is None else _DEPTHS[depth],
    }


def _choose_format(request: Request, output: OutputSpec) -> AnyFormat | None:
    """What the caller likes best of those that the output comes in; None if it comes in one only."""
    if output.media_type not in (PNG, WEBM):
        return None
    return negotiate_format(request.headers.get("accept", ""), moving=output.video)


def negotiate_format(accept: str, *, moving: bool) -> AnyFormat:
    """Choose the format that an ``Accept`` header likes best; PNG, or WebM, if it likes none or several as much.

    Examples
    --------
    >>> [negotiate_format(accept, moving=False) for accept in ("image/webp,image/png;q=0.8", "image/*", "video/mp4")]
    ['webp', 'png', 'png']
    >>> [negotiate_format(accept, moving=True) for accept in ("video/mp4", "image/webp,*/*")]
    ['mp4', 'webm']
    """
    formats, usual = (VIDEOS, VIDEOS[WEBM]) if moving else (STILLS, STILLS[PNG])
    likings: dict[AnyFormat, float] = {}
    for part in accept.lower().split(","):
        media, *options = (piece.strip() for piece in part.split(";"))
        if media in formats:
            quality = next((option[2:] for option in options if option.startswith("q=")), "1")
            try:
                likings[formats[media]] = float(quality)
            except ValueError:
                continue
    best = max(likings.values(), default=0.0)
    return usual if best <= 0 or likings.get(usual) == best else next(name for name in likings if likings[name] == best)


def _pop_parts(parse: Callable[[str], _Part], names: Sequence[str], fields: dict[str, str]) -> list[_Part | None]:
    """Read the fields of these names, and take them out; None for one that is left out, none at the end."""
    parts: list[_Part | None] = []
    for name in names:
        text = fields.pop(name, None)
        try:
            parts.append(None if text is None else parse(text))
        except InvalidInputError as error:
            raise InvalidInputError(error.message, name) from None
    while parts and parts[-1] is None:
        parts.pop()
    return parts


def _form_field(field: str | None) -> str | None:
    """Name the form's field that a field of the JSON body is here.

    Examples
    --------
    >>> fields = ("parameters.alpha", "inputs.0.crop", "inputs.2.crop", "inputs.1.frames", "inputs.1", "inputs")
    >>> [_form_field(field) for field in fields]
    ['alpha', 'crop', 'crop-3', 'time-2', 'file-2', 'file']
    """
    if field is None or not field.startswith("inputs"):
        return field and field.removeprefix("parameters.")
    _, index, part, *_ = [*field.split("."), "0", ""]
    names = {"crop": CROPS, "frames": TIMES}.get(part, FILES)
    return names[int(index)] if int(index) < len(names) else "method"


async def _wait_for_disconnect(request: Request) -> None:
    while cast(dict[str, Any], await request.receive())["type"] != "http.disconnect":
        pass

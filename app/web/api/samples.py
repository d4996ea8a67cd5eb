"""``/api/v1/samples``: photographs come in, their records and renditions go out."""

from typing import Annotated

from fastapi import APIRouter, Path, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse, Response

from app.errors import InvalidInputError
from app.web.api.bodies import IDENTIFIER
from app.web.api.records import API, SampleList, SampleRecord
from app.web.deps import ServiceDep, TokenDep, base_url, in_upload_thread
from app.web.files import FOREVER, SUFFIXES, file_response
from app.web.openapi import EXAMPLE_SAMPLE, OWNER, problems
from app.web.uploads import receive_form

router = APIRouter(prefix=f"{API}/samples", tags=["samples"])

SampleId = Annotated[
    str, Path(pattern=IDENTIFIER, description="Id of an uploaded or bundled sample.", examples=[EXAMPLE_SAMPLE])
]
_FORM = {
    "requestBody": {
        "required": True,
        "content": {
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "required": ["file"],
                    "properties": {
                        "file": {
                            "type": "string",
                            "contentMediaType": "application/octet-stream",
                            "description": "PNG, JPEG, WebP or TIFF, 8 or 16 bits, grey or colour.",
                        }
                    },
                }
            }
        },
    },
    "security": OWNER,
}


@router.get("", summary="The bundled samples")
def list_samples(request: Request, service: ServiceDep) -> SampleList:
    """List them. Uploaded samples are not listed: their ids are known to who uploaded them."""
    return SampleList(samples=[SampleRecord.of(sample, base_url(request)) for sample in service.bundled_samples()])


@router.post(
    "",
    status_code=201,
    summary="Upload a photograph",
    responses={
        201: {"headers": {"Location": {"description": "Address of the record.", "schema": {"type": "string"}}}},
        **problems(422, 503),
    },
    openapi_extra=_FORM,
)
async def upload_sample(request: Request, response: Response, service: ServiceDep, token: TokenDep) -> SampleRecord:
    """Decode it, turn it upright, convert it to sRGB and strip it of its metadata.

    A sample that no experiment uses is removed after a day.
    """
    async with receive_form(request) as form:
        if form.file is None:
            raise InvalidInputError("Send a picture in the form's field 'file'.", "file")
        if form.fields:
            name = next(iter(form.fields))
            raise InvalidInputError(f"The form has one field, 'file'; {name!r} is not known.", name)
        sample = await in_upload_thread(request, service.add_sample, form.file, token)
    record = SampleRecord.of(sample, base_url(request))
    response.headers["Location"] = record.url
    return record


@router.get("/{sample_id}", summary="The record of a sample", responses=problems(404))
def read_sample(sample_id: SampleId, request: Request, service: ServiceDep) -> SampleRecord:
    """Its size, depth and channels."""
    return SampleRecord.of(service.sample(sample_id), base_url(request))


@router.get(
    "/{sample_id}/image",
    name="sample_image",
    summary="A sample as a picture",
    response_class=FileResponse,
    responses={
        200: {
            "description": "JPEG if it is opaque, otherwise PNG.",
            "content": {
                media: {"schema": {"type": "string", "format": "binary"}} for media in ("image/jpeg", "image/png")
            },
        },
        206: {"description": "The range that was asked for."},
        304: {"description": "You have it already."},
        **problems(404, 416, 422),
    },
)
async def sample_image(
    sample_id: SampleId,
    request: Request,
    service: ServiceDep,
    size: Annotated[
        int | None,
        Query(
            ge=1, le=1_000_000, description="Bounds its longer side in pixels, rounded up to 256, 512, 1024 or 2048."
        ),
    ] = None,
    frame: Annotated[int, Query(ge=0, le=1_000_000, description="Of a video: which frame, from 0.")] = 0,
) -> Response:
    """Upright and in sRGB; at its own size if none is asked for. Of a video it is one frame."""
    sample = await run_in_threadpool(service.sample, sample_id)
    path, media_type = await in_upload_thread(request, service.rendition, sample_id, size, frame)
    tag = f"{sample.digest}-{frame}-{path.stat().st_size}"
    return file_response(
        request, path, media_type, tag=tag, filename=f"{sample_id}{SUFFIXES[media_type]}", cache=FOREVER
    )

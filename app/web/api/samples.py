"""Samples of the REST API, ``/api/v1/samples``: upload photographs and clips, read their records and images."""

from pathlib import Path as FilePath
from typing import Annotated, Any

from fastapi import APIRouter, Path, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse, Response

from app.errors import InvalidInputError
from app.experiments.files.renditions import VideoFormat, found_or_made, rendition_bound
from app.experiments.files.versions import made_tag, made_version, stored_version
from app.experiments.model import Sample
from app.numbers import FAR
from app.web.api.bodies import IDENTIFIER
from app.web.api.openapi import EXAMPLE_SAMPLE, OWNER, problems
from app.web.api.records import API, SampleList, SampleRecord
from app.web.deps import ServiceDep, TokenDep, base_url
from app.web.file_response import SUFFIXES, Version, cache_control, file_response
from app.web.limits import VIEWS, take, take_upload
from app.web.uploads import add_sample, receive_form

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
                            "description": "PNG, JPEG, WebP or TIFF, 8 or 16 bits, grey or colour; or a video: MP4, "
                            "WebM, GIF, animated WebP or APNG.",
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
    return SampleList(samples=[SampleRecord.of(sample, base_url(request)) for sample in service.samples.bundled()])


@router.post(
    "",
    status_code=201,
    summary="Upload a photograph or a clip",
    responses={
        201: {"headers": {"Location": {"description": "Address of the record.", "schema": {"type": "string"}}}},
        **problems(422, 429, 503),
    },
    openapi_extra=_FORM,
)
async def upload_sample(request: Request, response: Response, service: ServiceDep, token: TokenDep) -> SampleRecord:
    """Decode it, turn it upright, convert it to sRGB and strip it of its metadata.

    A sample that no experiment uses is removed after a day.
    """
    take_upload(request)
    async with receive_form(request) as form:
        if form.file is None:
            raise InvalidInputError("Send a picture in the form's field 'file'.", "file")
        if form.fields:
            name = next(iter(form.fields))
            raise InvalidInputError(f"The form has one field, 'file'; {name!r} is not known.", name)
        sample = await add_sample(request, form.file, token)
    record = SampleRecord.of(sample, base_url(request))
    response.headers["Location"] = record.url
    return record


@router.get("/{sample_id}", summary="The record of a sample", responses=problems(404))
def read_sample(sample_id: SampleId, request: Request, service: ServiceDep) -> SampleRecord:
    """Its size, depth and channels, and of a video how many frames it has."""
    return SampleRecord.of(service.samples.get(sample_id), base_url(request))


def _file(description: str, *media_types: str) -> dict[int | str, dict[str, Any]]:
    """Declare the answers of a route that gives a file out."""
    content = {media: {"schema": {"type": "string", "format": "binary"}} for media in media_types}
    return {
        200: {"description": description, "content": content},
        206: {"description": "The range that was asked for."},
        304: {"description": "You have it already."},
        **problems(404, 416, 422, 429, 503),
    }


@router.get(
    "/{sample_id}/image",
    name="sample_image",
    summary="A sample as a picture",
    response_class=FileResponse,
    responses=_file("JPEG if it is opaque, otherwise PNG.", "image/jpeg", "image/png"),
)
async def sample_image(
    sample_id: SampleId,
    request: Request,
    service: ServiceDep,
    size: Annotated[
        int | None,
        Query(ge=1, le=FAR, description="Bounds its longer side in pixels, rounded up to 256, 512, 1024 or 2048."),
    ] = None,
    frame: Annotated[int, Query(ge=0, le=FAR, description="Of a video: which frame, from 0.")] = 0,
    version: Version = None,
) -> Response:
    """Upright and in sRGB; at its own size if none is asked for. Of a video it is one frame."""
    sample = await run_in_threadpool(service.samples.get, sample_id)
    if not sample.bundled:
        take(request, VIEWS)
    path, media_type = await found_or_made(service.renditions, lambda renditions: renditions.image(sample, size, frame))
    if size is None and not sample.moving:
        return _answer(request, sample, path, media_type, sample.digest, version, stored_version(sample.digest))
    tag = made_tag(sample.digest, sample.height, frame, size and rendition_bound(size))
    return _answer(request, sample, path, media_type, tag, version, made_version(sample.digest))


@router.get(
    "/{sample_id}/video",
    name="sample_video",
    summary="A sample as a video",
    response_class=FileResponse,
    responses=_file("All of its frames.", "video/mp4", "video/webm"),
)
async def sample_video(
    sample_id: SampleId,
    request: Request,
    service: ServiceDep,
    file_format: Annotated[
        VideoFormat,
        Query(
            alias="format",
            description="MP4 (H.264) plays everywhere; WebM (VP9) has the very pixels of the sample, unless the video "
            "is too long for a lossless file.",
        ),
    ] = "mp4",
    version: Version = None,
) -> Response:
    """Upright, in sRGB and without sound; a sample that is a still picture has none."""
    sample = await run_in_threadpool(service.samples.get, sample_id)
    if not sample.bundled:
        take(request, VIEWS)
    path, media_type = await found_or_made(service.renditions, lambda renditions: renditions.video(sample, file_format))
    tag = made_tag(sample.digest, sample.height, f"{sample.rate:g}", file_format)
    return _answer(request, sample, path, media_type, tag, version, made_version(sample.digest))


def _answer(
    request: Request, sample: Sample, path: FilePath, media_type: str, tag: str, version: str | None, current: str
) -> Response:
    """Answer with a file of a sample; an upload is for those who know its address."""
    return file_response(
        request,
        path,
        media_type,
        tag=tag,
        filename=f"{sample.id}{SUFFIXES[media_type]}",
        cache=cache_control(version, current, public=sample.bundled),
        modified=sample.created_at,
    )

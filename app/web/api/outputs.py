"""Outputs of the REST API, ``/api/v1/experiments/{id}/outputs``: single files, conversions, and a ZIP of all."""

import io
import json
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path as FilePath
from typing import Annotated, Literal
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

from fastapi import APIRouter, Path, Query, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import FileResponse, Response, StreamingResponse

from app.errors import ConflictError
from app.experiments.exhibition import is_exhibit
from app.experiments.files.versions import made_tag, made_version, stored_version
from app.experiments.model import Experiment, Status
from app.web.api.experiments import ExperimentId, record_of
from app.web.api.openapi import problems
from app.web.api.records import API
from app.web.clients import client_of
from app.web.deps import ServiceDep
from app.web.file_response import SUFFIXES, Version, cache_control, file_response, matches, not_modified
from app.web.limits import CONVERSIONS, DEEP, VIEWS, take

router = APIRouter(prefix=f"{API}/experiments", tags=["experiments"])

OutputName = Annotated[
    str, Path(pattern=r"^\.?[a-z0-9-]{1,64}$", description="As in the record.", examples=["texture"])
]
DEPTHS: dict[str | None, Literal[8, 16]] = {"8": 8, "16": 16}
_CHUNK = 1 << 18
_PICTURES = {media: {"schema": {"type": "string", "format": "binary"}} for media in SUFFIXES}


def file_name(experiment: Experiment, output: str, suffix: str) -> str:
    """Name a file so that it still says what it is in a folder of downloads."""
    size = f"{experiment.parameters.get('width')}x{experiment.parameters.get('height')}"
    seed = experiment.parameters.get("seed")
    frames = experiment.parameters.get("frames")
    size += f"x{frames}" if frames else ""
    return f"{experiment.method}-{size}-seed{seed}-{experiment.id[:6]}-{output.removeprefix('.')}{suffix}"


@router.get(
    "/{experiment_id}/outputs/{name}",
    name="experiment_output",
    summary="An output",
    response_class=FileResponse,
    responses={
        200: {
            "description": "The bytes, named by the strong `ETag`: they change where an exhibit is made again or a "
            "converter is another version. Under the `v` that fits they are `immutable`.",
            "content": _PICTURES,
            "headers": {"ETag": {"description": "Strong.", "schema": {"type": "string"}}},
        },
        206: {"description": "The range that was asked for.", "content": _PICTURES},
        304: {"description": "You have it already."},
        **problems(404, 409, 410, 416, 422, 429, 503),
    },
)
async def experiment_output(
    experiment_id: ExperimentId,
    name: OutputName,
    request: Request,
    service: ServiceDep,
    format: Annotated[
        Literal["png", "jpeg", "webp", "tiff", "webm", "mp4"] | None,
        Query(description="Default: as it is stored. Of a video: webm or mp4."),
    ] = None,
    depth: Annotated[
        Literal["8", "16"] | None,
        Query(
            description="Bits per channel, of PNG and TIFF; default: as it is stored, at the depth of the deepest "
            "sample. At 16 bits what is stored at 8 is computed anew, with its seed."
        ),
    ] = None,
    download: Annotated[bool, Query(description="Ask browsers to save it instead of showing it.")] = False,
    version: Version = None,
) -> Response:
    """Supports `Range`, `If-None-Match` and `HEAD`."""
    experiment = await run_in_threadpool(service.experiments.get, experiment_id)
    output, path = await service.outputs.fetch(experiment_id, name)
    media_type, tag, current = output.media_type, output.digest, stored_version(output.digest)
    public = experiment.listed or is_exhibit(experiment)
    if format is not None or depth is not None:
        wanted = (experiment_id, name, format, DEPTHS.get(depth))
        source = await run_in_threadpool(service.outputs.find_source, *wanted)
        if source is not None and matches(request, made_tag(source.digest, format, depth)):
            cache = cache_control(version, made_version(source.digest), public=public)
            return not_modified(made_tag(source.digest, format, depth), cache)
        take(request, _kind(format, depth))
        source = source or await service.outputs.make_source(*wanted, client_of(request).name)
        tag, current = made_tag(source.digest, format, depth), made_version(source.digest)
        path, media_type = await service.outputs.render(source, format, DEPTHS.get(depth))
    return file_response(
        request,
        path,
        media_type,
        tag=tag,
        filename=file_name(experiment, name, SUFFIXES.get(media_type, path.suffix)),
        cache=cache_control(version, current, public=public),
        modified=experiment.finished_at or experiment.created_at,
        disposition="attachment" if download else "inline",
    )


@router.get(
    "/{experiment_id}/outputs.zip",
    name="experiment_zip",
    summary="Every output, in one file",
    response_class=StreamingResponse,
    responses={
        200: {
            "description": "A ZIP file with every listed output and the record.",
            "content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}},
        },
        **problems(404, 409, 410, 429),
    },
)
def experiment_zip(experiment_id: ExperimentId, request: Request, service: ServiceDep) -> Response:
    """Pack the pictures as they are, with `record.json`, which says how they were made."""
    experiment = service.experiments.get(experiment_id)
    if experiment.status is not Status.SUCCEEDED:
        raise ConflictError(f"The experiment has no outputs: it is {experiment.status}.")
    take(request, CONVERSIONS)
    record = record_of(request, service, experiment).model_dump(mode="json", exclude_unset=True)
    files = [
        (f"{output.name}{SUFFIXES.get(output.media_type, '')}", service.outputs.get(experiment_id, output.name)[1])
        for output in experiment.outputs
        if output.listed
    ]
    name = file_name(experiment, "outputs", ".zip")
    return StreamingResponse(
        _write_zip(json.dumps(record, indent=2), files, experiment.finished_at or datetime.now(UTC)),
        media_type="application/zip",
        headers={"Content-Disposition": f'attachment; filename="{name}"', "Cache-Control": "private, no-cache"},
    )


def _kind(file_format: str | None, depth: str | None) -> str:
    """Say as what a converted output counts: the pages themselves show those at 8 bits."""
    if depth == "16":
        return DEEP
    return VIEWS if file_format is None else CONVERSIONS


class _Sink(io.RawIOBase):
    """Where the ZIP is written to: keeps the bytes until they are sent."""

    def __init__(self) -> None:
        self.chunks: list[bytes] = []

    def writable(self) -> bool:
        return True

    def write(self, data: object) -> int:
        self.chunks.append(bytes(data))  # type: ignore[call-overload]
        return len(self.chunks[-1])

    def take(self) -> bytes:
        data = b"".join(self.chunks)
        self.chunks.clear()
        return data


def _write_zip(record: str, files: list[tuple[str, FilePath]], moment: datetime) -> Iterator[bytes]:
    """Write a ZIP file, a chunk at a time; pictures are compressed already."""
    sink = _Sink()
    with ZipFile(sink, "w") as archive:
        info = ZipInfo("record.json", moment.timetuple()[:6])
        info.compress_type = ZIP_DEFLATED
        archive.writestr(info, record)
        for name, path in files:
            info = ZipInfo(name, moment.timetuple()[:6])
            info.compress_type = ZIP_STORED
            with path.open("rb") as source, archive.open(info, "w", force_zip64=True) as target:
                while chunk := source.read(_CHUNK):
                    target.write(chunk)
                    yield sink.take()
    yield sink.take()

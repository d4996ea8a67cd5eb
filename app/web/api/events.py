"""Server-sent events (SSE), ``/api/v1/experiments/{id}/events``: progress of an experiment."""

from collections.abc import AsyncGenerator
from contextlib import aclosing
from functools import lru_cache
from typing import Annotated

from fastapi import APIRouter, Depends, Header, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response, StreamingResponse

from app.errors import DeletedError, NotFoundError
from app.experiments.model import Snapshot, Status
from app.experiments.watching import Watching
from app.web.api.experiments import ExperimentId
from app.web.api.openapi import problems
from app.web.api.records import API, ProgressRecord
from app.web.deps import ServiceDep
from app.web.event_stream import EventStream
from app.web.limits import hold_stream

router = APIRouter(prefix=f"{API}/experiments", tags=["experiments"])

LAST_ID = "end"
RETRY_MILLISECONDS = 2000
_EVENT = {
    "type": "object",
    "required": ["event", "data", "id"],
    "properties": {
        "event": {"enum": ["progress", "status"]},
        "data": {"type": "string", "contentMediaType": "application/json"},
        "id": {"type": "string"},
        "retry": {"type": "integer"},
    },
}
_COMMENT = b": nothing new\n\n"


@router.get(
    "/{experiment_id}/events",
    name="experiment_events",
    summary="Follow an experiment",
    dependencies=[Depends(hold_stream)],
    response_class=StreamingResponse,
    responses={
        200: {"description": "The events.", "content": {EventStream.media_type: {"itemSchema": _EVENT}}},
        204: {"description": "You have seen the end (`Last-Event-ID`)."},
        **problems(404, 410, 422, 429, 503),
    },
)
async def experiment_events(
    experiment_id: ExperimentId,
    request: Request,
    service: ServiceDep,
    last_event_id: Annotated[
        str | None, Header(description="As browsers send it when they connect again.", max_length=100)
    ] = None,
) -> Response:
    """Send an event `progress` for every change, and an event `status` after it whenever the status is another.

    The data of both is `{"status", "position", "progress", "stage", "elapsed"}`. Changes of the status come at once,
    others twice a second; a state that stays comes again every few seconds. Lines that begin with a colon say that the
    server is there still. The stream ends after a finished status, or when the server stops: connect again then.
    """
    await run_in_threadpool(service.experiments.get, experiment_id)
    if last_event_id == LAST_ID:  # browsers then stop connecting
        return Response(status_code=204)
    return EventStream(request, _events(service.watching, experiment_id))


async def _events(watching: Watching, experiment_id: str) -> AsyncGenerator[bytes, None]:
    """Write the events of one stream; what is written of a state is the same for all streams."""
    status: Status | None = None
    number = 0
    async with aclosing(watching.watch(experiment_id)) as snapshots:
        try:
            async for snapshot in snapshots:
                if snapshot is None:
                    yield _COMMENT
                    continue
                data = _encode(snapshot)
                events = b""
                for name in ("progress",) if snapshot.status is status else ("progress", "status"):
                    number += 1
                    final = name == "status" and snapshot.status.finished
                    retry = f"\nretry: {RETRY_MILLISECONDS}" if number == 1 else ""
                    events += b"event: %b\n%b\nid: %b\n\n" % (
                        name.encode(),
                        data,
                        f"{LAST_ID if final else number}{retry}".encode(),
                    )
                status = snapshot.status
                yield events
        except (NotFoundError, DeletedError):  # who connects again is told so
            return


@lru_cache(maxsize=1024)
def _encode(snapshot: Snapshot) -> bytes:
    """Write the line of a snapshot's data; once, however many streams wait for it."""
    return b"data: " + ProgressRecord.of(snapshot).model_dump_json().encode()

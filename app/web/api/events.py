"""Server-sent events (SSE), ``/api/v1/experiments/{id}/events``: progress of an experiment."""

from collections.abc import AsyncGenerator, AsyncIterator
from contextlib import aclosing
from typing import Annotated

from fastapi import APIRouter, Depends, Header, Request
from fastapi.sse import EventSourceResponse, ServerSentEvent
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException

from app.experiments.model import Snapshot, Status
from app.web.api.experiments import ExperimentId
from app.web.api.openapi import problems
from app.web.api.records import API, ProgressRecord
from app.web.deps import ServiceDep
from app.web.limits import hold_stream
from app.web.shutdown import unless_stopping

router = APIRouter(prefix=f"{API}/experiments", tags=["experiments"])

LAST_ID = "end"
RETRY_MILLISECONDS = 2000


async def _check_stream(
    experiment_id: ExperimentId,
    service: ServiceDep,
    last_event_id: Annotated[
        str | None, Header(description="As browsers send it when they connect again.", max_length=100)
    ] = None,
) -> None:
    """Answer errors before the stream begins, and 204 to who has seen its end: browsers then stop connecting."""
    await run_in_threadpool(service.experiments.get, experiment_id)
    if last_event_id == LAST_ID:
        raise HTTPException(204)


@router.get(
    "/{experiment_id}/events",
    name="experiment_events",
    summary="Follow an experiment",
    dependencies=[Depends(_check_stream), Depends(hold_stream)],
    response_class=EventSourceResponse,
    responses={204: {"description": "You have seen the end (`Last-Event-ID`)."}, **problems(404, 410, 422, 429)},
)
async def experiment_events(
    experiment_id: ExperimentId, request: Request, service: ServiceDep
) -> AsyncIterator[ServerSentEvent]:
    """Send an event `progress` for every change, and an event `status` after it whenever the status is another.

    The data of both is `{"status", "position", "progress", "stage", "elapsed"}`. The stream ends after a finished
    status, or when the server stops: connect again then.
    """
    status: Status | None = None
    number = 0
    async with aclosing(service.watching.watch(experiment_id)) as snapshots:
        while snapshot := await unless_stopping(request, _next(snapshots)):
            data = ProgressRecord.of(snapshot).model_dump(mode="json")
            names = ["progress"] if snapshot.status is status else ["progress", "status"]
            status = snapshot.status
            for name in names:
                number += 1
                identifier = LAST_ID if status.finished and name == "status" else str(number)
                yield ServerSentEvent(
                    event=name, id=identifier, retry=RETRY_MILLISECONDS if number == 1 else None, data=data
                )


async def _next(snapshots: AsyncGenerator[Snapshot]) -> Snapshot | None:
    return await anext(snapshots, None)

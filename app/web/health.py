"""Health checks and monitoring: ``/healthz``, ``/readyz`` and ``/metrics`` (Prometheus)."""

from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import JSONResponse, Response

from app.web.api.openapi import problems
from app.web.deps import ServiceDep
from app.web.middleware.metrics import Metrics
from app.web.problems import problem

router = APIRouter(tags=["service"])

_UNKEPT = {"Cache-Control": "no-store"}


def _status(word: str) -> dict[int | str, dict[str, Any]]:
    schema = {"type": "object", "required": ["status"], "properties": {"status": {"const": word}}}
    return {200: {"content": {"application/json": {"schema": schema}}}}


@router.get("/healthz", summary="Alive", responses=_status("alive"))
async def health() -> Response:
    """Say that the web process answers."""
    return JSONResponse({"status": "alive"}, headers=_UNKEPT)


@router.get("/readyz", summary="Able to take work", responses={**_status("ready"), **problems(503)})
def readiness(service: ServiceDep) -> Response:
    """Experiments can run; otherwise `part` names what is missing: database, storage, disk space or engine."""
    missing = service.availability.missing()
    if missing is None:
        return JSONResponse({"status": "ready"}, headers=_UNKEPT)
    return problem(503, missing.message, headers={"Retry-After": "1"}, part=missing.part)


@router.get(
    "/metrics",
    summary="Prometheus metrics",
    response_class=Response,
    responses={200: {"content": {"text/plain": {"schema": {"type": "string"}}}}},
)
def metrics(request: Request) -> Response:
    """Tell requests by route and status, their durations, experiments by status, and the queue."""
    collected: Metrics = request.app.state.metrics
    return Response(collected.text(), media_type=collected.content_type, headers=_UNKEPT)

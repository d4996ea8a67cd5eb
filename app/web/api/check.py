"""``POST /api/v1/check``: what an experiment would make and take, without running it."""

from fastapi import APIRouter, Depends
from starlette.concurrency import run_in_threadpool

from app.web.api.experiments import ExperimentBody, require_json
from app.web.api.records import API, PlanRecord
from app.web.deps import ServiceDep
from app.web.openapi import problems

router = APIRouter(prefix=API, tags=["experiments"])


@router.post(
    "/check", dependencies=[Depends(require_json)], summary="Check before running", responses=problems(404, 422)
)
async def check_experiment(body: ExperimentBody, service: ServiceDep) -> PlanRecord:
    """Say what it would make and how much memory it would take, or what is wrong with it; nothing is run."""
    return PlanRecord(**vars(await run_in_threadpool(lambda: service.check(body.requested()))))

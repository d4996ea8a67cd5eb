"""What the end of a task means for its job: three kinds of failure, never mixed."""

import logging

import pytest
from distributed.scheduler import KilledWorker

from app.errors import DATABASE, UnavailableError
from app.executor.dispatched import Dispatched, Verdict, verdict
from app.experiments.model import Lease

KILLED = KilledWorker("task", None, 0)  # type: ignore[arg-type] # which worker it was is not looked at
FAULT = RuntimeError("not for people")
AWAY = UnavailableError(DATABASE, "It is away.")


@pytest.mark.parametrize("embedded", [True, False])
@pytest.mark.parametrize(
    ("state", "status", "error", "expected"),
    [
        ({}, "finished", None, Verdict.RECORDED),
        ({}, "error", KILLED, Verdict.DIED),
        ({}, "error", FAULT, Verdict.RECORDED),
        ({}, "error", AWAY, Verdict.UNAVAILABLE),
        ({"begun": 1.0, "orphaned": True}, "cancelled", None, Verdict.DIED),
        ({"orphaned": True}, "cancelled", None, Verdict.RETURNED),
        ({"withdrawn": True}, "cancelled", None, Verdict.RETURNED),
        ({"gone": 1.0}, "cancelled", None, Verdict.RECORDED),
        ({"gone": 1.0}, "error", AWAY, Verdict.RECORDED),
        ({"out_of_time": True}, "cancelled", None, Verdict.OUT_OF_TIME),
        ({"out_of_time": True, "gone": 1.0}, "error", KILLED, Verdict.OUT_OF_TIME),
    ],
)
def test_an_attempt_is_charged_only_when_the_worker_died(
    state: dict[str, object], status: str, error: BaseException | None, expected: Verdict, embedded: bool
) -> None:
    run = Dispatched(Lease("job", 1), "tcp://worker", 0.0, **state)  # type: ignore[arg-type]
    assert verdict(run, status, error, embedded=embedded) is expected


@pytest.mark.parametrize(("embedded", "expected"), [(True, Verdict.RETURNED), (False, Verdict.LEFT_RUNNING)])
@pytest.mark.parametrize("status", ["cancelled", "lost"])
def test_what_a_scheduler_forgot_may_go_on_only_where_its_workers_are_others(
    status: str, embedded: bool, expected: Verdict
) -> None:
    assert verdict(Dispatched(Lease("job", 1), "tcp://worker", 0.0), status, None, embedded=embedded) is expected


def test_a_fault_outside_the_method_is_logged_with_its_traceback(caplog: pytest.LogCaptureFixture) -> None:
    verdict(Dispatched(Lease("job", 1), "tcp://worker", 0.0), "error", FAULT, embedded=True)
    assert [(each.levelno, each.message) for each in caplog.records] == [
        (logging.ERROR, "job job failed outside the method")
    ]
    assert caplog.records[0].exc_info is not None
    assert caplog.records[0].exc_info[1] is FAULT

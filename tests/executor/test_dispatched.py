"""What the end of a task means for its job: whether it runs again, and what people are told."""

import logging

import pytest
from distributed.scheduler import KilledWorker

from app.executor.dispatched import ATTEMPTS, Dispatched, verdict
from app.executor.messages import LOST
from app.experiments.failures import BROKEN

KILLED = KilledWorker("task", None, 0)  # type: ignore[arg-type] # which worker it was is not looked at
FAULT = RuntimeError("not for people")


@pytest.mark.parametrize(
    ("state", "status", "error", "deaths", "expected"),
    [
        ({}, "finished", None, 0, (False, None)),
        ({"failure": "too small"}, "finished", None, 0, (False, "too small")),
        ({}, "error", KILLED, ATTEMPTS - 1, (True, LOST)),
        ({}, "error", KILLED, ATTEMPTS, (False, LOST)),
        ({}, "error", FAULT, 0, (False, BROKEN)),
        ({}, "cancelled", None, 0, (True, None)),
        ({}, "lost", None, 0, (True, None)),
        ({"cancelled": 1.0}, "finished", None, 0, (False, None)),
        ({"cancelled": 1.0, "failure": "too small"}, "finished", None, 0, (False, None)),
        ({"cancelled": 1.0}, "error", KILLED, 1, (False, None)),
        ({"cancelled": 1.0}, "lost", None, 0, (False, None)),
        (
            {"out_of_time": True},
            "cancelled",
            None,
            0,
            (False, "Make the texture smaller: this run took longer than 7.5 seconds."),
        ),
        (
            {"out_of_time": True, "cancelled": 1.0},
            "error",
            KILLED,
            1,
            (False, "Make the texture smaller: this run took longer than 7.5 seconds."),
        ),
    ],
)
def test_a_job_runs_again_only_if_nobody_is_to_blame(
    state: dict[str, object],
    status: str,
    error: BaseException | None,
    deaths: int,
    expected: tuple[bool, str | None],
    caplog: pytest.LogCaptureFixture,
) -> None:
    run = Dispatched("job", "tcp://worker", 0.0, **state)  # type: ignore[arg-type]
    assert verdict(run, status, error, deaths=deaths, time_limit=7.5) == expected
    assert [(each.levelno, each.message) for each in caplog.records] == (
        [(logging.ERROR, "job job failed outside the method")] if error is FAULT else []
    )


def test_a_fault_outside_the_method_is_logged_with_its_traceback(caplog: pytest.LogCaptureFixture) -> None:
    verdict(Dispatched("job", "tcp://worker", 0.0), "error", FAULT, deaths=0, time_limit=1)
    assert caplog.records[0].exc_info is not None
    assert caplog.records[0].exc_info[1] is FAULT

"""What a worker does with a job: whatever it raises is reported in words, and progress stops what has to stop."""

import logging
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from app.errors import CancelledError, InvalidInputError, TimeLimitError
from app.executor import tasks
from app.executor.tasks import REPORT_SECONDS, Reporter, stop, work
from app.experiments.failures import BROKEN
from app.methods.context import Progress
from app.settings import Settings

TOPIC, ADDRESS = "the topic", "tcp://worker"


class Clock:
    def __init__(self) -> None:
        self.now = 50.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(tasks, "time", clock)
    return clock


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch, clock: Clock) -> Iterator[list[dict[str, Any]]]:
    """What the worker tells the service; all of it on the topic, and of this worker."""
    messages: list[dict[str, Any]] = []

    def log_event(topic: str, message: dict[str, Any]) -> None:
        assert topic == TOPIC
        assert message.pop("worker") == ADDRESS
        messages.append(message)

    monkeypatch.setattr(tasks, "get_worker", lambda: SimpleNamespace(address=ADDRESS, log_event=log_event))
    yield messages
    assert tasks._cancelled == set()


@pytest.fixture
def given_back(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    found: list[bool] = []
    monkeypatch.setattr(tasks, "give_back", lambda: found.append(True))
    return found


@pytest.mark.parametrize(
    ("error", "failure", "logged"),
    [
        (None, None, False),
        (CancelledError("The experiment was cancelled."), None, False),
        (InvalidInputError("The crop is too small.", "crop"), "The crop is too small.", False),
        (TimeLimitError("This run took longer."), "This run took longer.", False),
        (ZeroDivisionError("not for people"), BROKEN, True),
        (OSError(28, "No space left on device"), BROKEN, True),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, Exception) else None,
)
def test_what_a_job_raises_is_reported_in_words_and_memory_is_given_back(
    sent: list[dict[str, Any]],
    given_back: list[bool],
    caplog: pytest.LogCaptureFixture,
    error: Exception | None,
    failure: str | None,
    logged: bool,
) -> None:
    def run(settings: Settings, job: str, progress: Progress) -> None:
        if error is not None:
            raise error

    work(run, Settings(), "job", TOPIC)
    begun: list[dict[str, Any]] = [{"job": "job"}]
    assert sent == begun + ([] if failure is None else [{"job": "job", "failure": failure}])
    assert given_back == [True]
    assert [(each.levelno, each.message) for each in caplog.records] == [(logging.ERROR, "job job failed")] * logged
    assert all(each.exc_info is not None and each.exc_info[1] is error for each in caplog.records)


def test_a_job_that_is_to_stop_ends_at_its_next_call_and_can_run_again(
    sent: list[dict[str, Any]], given_back: list[bool]
) -> None:
    calls: list[str] = []

    def run(settings: Settings, job: str, progress: Progress) -> None:
        progress("first", 0.0)
        calls.append("first")
        if len(calls) == 1:
            stop(job)
        progress("second", 0.5)
        calls.append("second")

    work(run, Settings(), "job", TOPIC)
    assert calls == ["first"]
    work(run, Settings(), "job", TOPIC)
    assert calls == ["first", "first", "second"]
    assert [message for message in sent if "failure" in message] == []


def test_a_stop_is_for_its_own_job(sent: list[dict[str, Any]], given_back: list[bool]) -> None:
    stop("another")
    try:
        Reporter("job", TOPIC, 10.0)("stage", 0.5)
    finally:
        tasks._cancelled.clear()


@pytest.mark.parametrize(("after", "ends"), [(9.99, False), (10.0, False), (10.01, True)])
def test_a_job_that_is_out_of_time_ends_at_its_next_call(
    sent: list[dict[str, Any]], clock: Clock, after: float, ends: bool
) -> None:
    reporter = Reporter("job", TOPIC, 10.0)
    clock.now += after
    if not ends:
        reporter("stage", 0.5)
        return
    with pytest.raises(TimeLimitError, match="longer than 10 seconds"):
        reporter("stage", 0.5)


def test_progress_is_sent_at_most_so_often_and_with_its_values(sent: list[dict[str, Any]], clock: Clock) -> None:
    reporter = Reporter("job", TOPIC, 100.0)
    reporter("spot", 0.125)  # at once after the beginning, which was sent
    clock.now += REPORT_SECONDS
    reporter("spot", 0.25)
    clock.now += REPORT_SECONDS / 2
    reporter("spot", 0.5)
    clock.now += REPORT_SECONDS
    reporter("texture", 0.75)
    assert sent == [
        {"job": "job"},
        {"job": "job", "stage": "spot", "fraction": 0.25},
        {"job": "job", "stage": "texture", "fraction": 0.75},
    ]

"""An engine is alive only if it has workers."""

import logging

import pytest

from app.executor import supervision
from app.executor.backoff import Backoff
from app.executor.supervision import DESERTED_SECONDS, HOPELESS_SECONDS, Supervision
from tests.still_clock import Clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(supervision, "time", clock)
    return clock


def test_an_engine_without_workers_is_given_up_and_the_second_is_the_last(clock: Clock) -> None:
    found = Supervision()
    found.see(["tcp://a"])
    clock.now += 1000
    assert not found.deserted
    found.see([])
    assert found.deserted  # its workers were seen a thousand seconds ago
    assert not found.abandon()
    found.opened()
    clock.now += DESERTED_SECONDS + 1
    assert not found.deserted  # the next one is given more time
    clock.now += HOPELESS_SECONDS
    assert found.deserted
    assert found.abandon()


def test_a_worker_that_comes_makes_good(clock: Clock) -> None:
    found = Supervision()
    clock.now += DESERTED_SECONDS + 1
    assert found.deserted
    found.abandon()
    found.opened()
    found.see(["tcp://a"])
    found.see([])
    clock.now += DESERTED_SECONDS + 1
    assert found.deserted
    assert not found.abandon()


def test_who_comes_and_who_leaves_is_logged(clock: Clock, caplog: pytest.LogCaptureFixture) -> None:
    found = Supervision()
    with caplog.at_level(logging.INFO):
        found.see(["tcp://a", "tcp://b"])
        found.see(["tcp://b"])
        found.see([])
    assert [record.message for record in caplog.records[2:]] == [
        "the worker tcp://a is gone",
        "the worker tcp://b is gone",
        "the engine has no worker any more",
    ]
    assert {record.message for record in caplog.records[:2]} == {
        "the worker tcp://a is there",
        "the worker tcp://b is there",
    }


def test_pauses_double_up_to_the_longest_and_begin_anew_after_a_success() -> None:
    found = Backoff(0.5, 3.0)
    assert found.due
    assert [found.fail() for _ in range(4)] == [0.5, 1.0, 2.0, 3.0]
    assert found.failing
    assert not found.due
    found.recover()
    assert not found.failing
    assert found.fail() == 3.0
    found.succeed()
    assert found.due
    assert found.fail() == 0.5

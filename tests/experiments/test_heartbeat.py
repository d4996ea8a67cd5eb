"""A worker keeps its lease while it computes, whatever the method does, and learns within a second that it lost it."""

import threading
from collections.abc import Callable
from typing import Any

import pytest

from app.errors import DATABASE, CancelledError, TimeLimitError, UnavailableError
from app.experiments import heartbeat
from app.experiments.heartbeat import Heartbeat, patiently
from app.experiments.model import Lease

LEASE = Lease("job", 7)
PATIENCE = 20.0


class Queue:
    """As much of a queue as a heartbeat asks; ``held`` and ``away`` are the test's to change."""

    def __init__(self) -> None:
        self.held, self.away = True, False
        self.renewed: list[tuple[str | None, float]] = []
        self.asked = 0
        self.changed = threading.Event()

    def renew(self, lease: Lease, stage: str | None, fraction: float) -> bool:
        self.renewed.append((stage, fraction))
        return self.holds(lease)

    def holds(self, lease: Lease) -> bool:
        assert lease is LEASE
        self.asked += 1
        if self.away:
            raise UnavailableError(DATABASE, "It is away.")
        return self.held


@pytest.fixture
def queue(monkeypatch: pytest.MonkeyPatch) -> Queue:
    monkeypatch.setattr(heartbeat, "LOOK_SECONDS", 0.002)
    return Queue()


def beating(queue: Queue, time_limit: float = PATIENCE) -> Heartbeat:
    return Heartbeat(queue, LEASE, time_limit)  # type: ignore[arg-type] # as much of one as is asked


def until(condition: Callable[[], object]) -> None:
    moments = threading.Event()
    for _ in range(int(PATIENCE / 0.002)):
        if condition():
            return
        moments.wait(0.002)
    raise AssertionError("the condition never held")


def test_it_beats_before_the_method_begins_and_brings_the_newest_progress(queue: Queue) -> None:
    with beating(queue) as progress:
        assert queue.renewed == [(None, 0.0)]
        progress("spot", 0.25)
        progress("spot", 0.5)
        until(lambda: ("spot", 0.5) in queue.renewed)
        asked = queue.asked
        until(lambda: queue.asked > asked + 3)
        assert queue.renewed.count(("spot", 0.5)) == 1  # nothing new: it only looks, until the next beat is due


def test_it_beats_without_progress(queue: Queue, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(heartbeat, "BEAT_SECONDS", 0.0)
    with beating(queue):
        until(lambda: len(queue.renewed) > 5)


def test_who_lost_the_lease_is_told_at_the_next_call(queue: Queue) -> None:
    with beating(queue) as progress:
        progress("spot", 0.25)
        queue.held = False
        until(lambda: not progress.held)
        with pytest.raises(CancelledError, match="cancelled"):
            progress("spot", 0.5)


def test_who_has_no_lease_at_the_start_knows_it(queue: Queue) -> None:
    queue.held = False
    with beating(queue) as progress:
        assert not progress.held


def test_a_database_that_is_away_ends_nothing(queue: Queue, caplog: pytest.LogCaptureFixture) -> None:
    """It is said once; afterwards the lease is renewed as before."""
    with beating(queue) as progress:
        queue.away = True
        asked = queue.asked
        until(lambda: queue.asked > asked + 3)
        progress("spot", 0.25)
        queue.away = False
        until(lambda: ("spot", 0.25) in queue.renewed)
        assert progress.held
    assert len(caplog.records) == 1


def test_a_database_that_is_away_at_the_start_is_raised(queue: Queue) -> None:
    queue.away = True
    with pytest.raises(UnavailableError, match="It is away"), beating(queue):
        pass


def test_who_is_out_of_time_is_told_at_the_next_call(queue: Queue) -> None:
    with beating(queue, time_limit=0.0) as progress, pytest.raises(TimeLimitError, match="longer than 0 seconds"):
        until(lambda: progress("spot", 0.25))


def test_it_ends_with_the_run(queue: Queue) -> None:
    with beating(queue) as progress:
        pass
    progress._thread.join(PATIENCE)
    assert not progress._thread.is_alive()


@pytest.mark.parametrize("times", [0, 3])
def test_what_was_computed_is_offered_until_it_is_taken(monkeypatch: pytest.MonkeyPatch, times: int) -> None:
    monkeypatch.setattr(heartbeat, "FIRST_PAUSE", 0.001)
    refusals = iter(range(times))

    def record() -> str:
        if next(refusals, None) is not None:
            raise UnavailableError(DATABASE, "It is away.")
        return "taken"

    assert patiently(record) == "taken"


def test_patience_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(heartbeat, "PATIENCE_SECONDS", 0.0)

    def record() -> Any:
        raise UnavailableError(DATABASE, "It is away.")

    with pytest.raises(UnavailableError, match="It is away"):
        patiently(record)

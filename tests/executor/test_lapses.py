"""Leases lapse by what one sees, for no clock tells the time of day in the same way everywhere."""

import pytest

from app.executor import lapses
from app.executor.lapses import LEASE_SECONDS, Lapses
from app.experiments.model import Beat
from tests.still_clock import Clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(lapses, "time", clock)
    return clock


@pytest.mark.parametrize(("seconds", "lapsed"), [(LEASE_SECONDS - 0.01, False), (LEASE_SECONDS, True)])
def test_a_heartbeat_that_stands_still_for_long_enough_has_lapsed(clock: Clock, seconds: float, lapsed: bool) -> None:
    found, still = Lapses(), Beat("job", 3, 7)
    assert found.look([still]) == []
    clock.now += seconds
    assert found.look([still]) == [still] * lapsed


@pytest.mark.parametrize("moved", [Beat("job", 3, 8), Beat("job", 4, 7)])
def test_a_beat_or_another_lease_begins_anew(clock: Clock, moved: Beat) -> None:
    found = Lapses()
    found.look([Beat("job", 3, 7)])
    clock.now += LEASE_SECONDS - 1
    found.look([moved])
    clock.now += 1
    assert found.look([moved]) == []


def test_who_could_not_look_knows_nothing(clock: Clock) -> None:
    """The worker could not write either, and is given the time to do so."""
    found, still = Lapses(), Beat("job", 3, 7)
    found.look([still])
    found.forget()
    clock.now += 10 * LEASE_SECONDS
    assert found.look([still]) == []


def test_what_left_and_came_back_begins_anew(clock: Clock) -> None:
    found, still = Lapses(), Beat("job", 3, 7)
    found.look([still])
    found.look([])
    clock.now += LEASE_SECONDS
    assert found.look([still]) == []

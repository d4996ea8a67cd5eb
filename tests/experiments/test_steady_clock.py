"""A clock that somebody set is not believed for a day; one that runs, or that a time server corrects, is."""

from datetime import UTC, datetime, timedelta, tzinfo
from typing import Self

import pytest

from app.experiments import steady_clock
from app.experiments.steady_clock import DOUBT, TOLERANCE, SteadyClock, since_boot

HOUR = timedelta(hours=1)


class Machine:
    """A machine whose clock on the wall goes wrong by ``error``."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.passed = timedelta(days=3)
        self.error = timedelta(0)
        machine = self

        class Clock(datetime):
            @classmethod
            def now(cls, tz: tzinfo | None = None) -> Self:
                return cls.fromtimestamp(machine.wall.timestamp(), tz)

        monkeypatch.setattr(steady_clock, "datetime", Clock)
        monkeypatch.setattr(steady_clock, "since_boot", lambda: self.passed)

    @property
    def wall(self) -> datetime:
        return datetime(2026, 1, 1, tzinfo=UTC) + self.passed + self.error


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Machine:
    return Machine(monkeypatch)


@pytest.mark.parametrize("error", [timedelta(0), TOLERANCE / 2, -TOLERANCE / 2])
def test_a_clock_that_runs_is_believed(machine: Machine, error: timedelta) -> None:
    clock = SteadyClock(machine.wall, machine.passed)
    for _ in range(5):
        machine.passed += HOUR
        machine.error = error
        assert clock.steady()


@pytest.mark.parametrize("jump", [timedelta(days=402), timedelta(days=-2), 2 * TOLERANCE])
def test_a_jump_is_doubted_for_a_day(machine: Machine, jump: timedelta) -> None:
    clock = SteadyClock(machine.wall, machine.passed)
    machine.passed += HOUR
    machine.error = jump
    hours = int(DOUBT / HOUR)
    believed = []
    for _ in range(hours + 3):
        believed.append(clock.steady())
        machine.passed += HOUR
    assert believed == [False] * (hours + 1) + [True] * 2


def test_both_clocks_of_this_machine_run() -> None:
    assert since_boot() > timedelta(0)
    assert SteadyClock().steady()

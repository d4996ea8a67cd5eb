"""Which part is away is asked at most once a second, whoever wants to know."""

from typing import Any

import pytest

from app.errors import DATABASE, ENGINE, STORAGE, UnavailableError
from app.experiments import availability
from app.experiments.availability import FRESH_SECONDS, Availability


class Clock:
    def __init__(self) -> None:
        self.now = 1000.0

    def monotonic(self) -> float:
        return self.now


class Part:
    """A store, files or an engine, which may be away."""

    def __init__(self, name: str) -> None:
        self.name, self.away, self.asked = name, False, 0

    def ping(self) -> None:
        self.asked += 1
        if self.away:
            raise UnavailableError(self.name, f"The {self.name} is away.")

    probe = ping

    @property
    def ready(self) -> bool:
        return not self.away


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(availability, "time", clock)
    return clock


@pytest.mark.parametrize("away", [None, 0, 1, 2])
def test_the_part_that_is_away_is_named(clock: Clock, away: int | None) -> None:
    """Without an engine an experiment can still be recorded: it waits."""
    parts: Any = [Part(DATABASE), Part(STORAGE), Part(ENGINE)]
    if away is not None:
        parts[away].away = True
    found = Availability(*parts)
    missing, unwritable = found.missing(), found.unwritable()
    assert (missing and missing.part) == (None if away is None else parts[away].name)
    assert (unwritable and unwritable.part) == (None if away in (None, 2) else parts[away].name)


def test_an_answer_is_good_for_a_second(clock: Clock) -> None:
    parts: Any = [Part(DATABASE), Part(STORAGE), Part(ENGINE)]
    found = Availability(*parts)
    for _ in range(5):
        assert found.missing() is None
    parts[0].away = True
    assert found.missing() is None
    clock.now += FRESH_SECONDS + 0.01
    assert found.missing() is not None
    assert parts[0].asked == 2

"""Which part is away is asked at most once a second, whoever wants to know."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from app.errors import DATABASE, DISK_SPACE, ENGINE, STORAGE, UnavailableError
from app.experiments import availability
from app.experiments.availability import FRESH_SECONDS, Availability
from app.experiments.service import Service
from app.settings import Settings
from tests.experiments.running import OWNER, a_request
from tests.still_clock import Clock


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


def test_what_could_not_be_recorded_is_refused_before_any_of_it_is_written(
    make_service: Callable[..., Service], settings: Settings, upload: Path
) -> None:
    """Free space below the watermark is enough: nobody waits until the disk is full."""
    sample = make_service().samples.add(upload, None)
    full = make_service(settings.model_copy(update={"min_free_bytes": 1 << 60}))
    with pytest.raises(UnavailableError, match="too little room") as raised:
        full.submission.submit(a_request(sample), OWNER)
    assert raised.value.part == DISK_SPACE
    assert sum(full.experiments.counts().values()) == 0


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

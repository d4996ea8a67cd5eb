"""The timer gives every stage its own seconds, and passes all progress on."""

import pytest

from app.experiments import stage_timer
from app.experiments.stage_timer import StageTimer
from tests.experiments.test_diagnostics import silent
from tests.still_clock import Clock


def test_the_seconds_of_a_stage_are_those_between_its_first_call_and_the_next_stages(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A stage that comes again goes on; what is before the first one counts nowhere."""
    clock = Clock()
    monkeypatch.setattr(stage_timer, "time", clock)
    passed: list[tuple[str, float]] = []
    stages = StageTimer(lambda stage, fraction: passed.append((stage, fraction)))
    clock.now += 100
    calls = [
        ("reading", 0.0, 1.0),
        ("spot", 0.1, 2.0),
        ("spot", 0.2, 4.0),
        ("reading", 0.5, 8.0),
        ("writing", 1.0, 16.0),
    ]
    for stage, fraction, seconds in calls:
        stages(stage, fraction)
        clock.now += seconds
    assert stages.seconds() == {"reading": 9.0, "spot": 6.0, "writing": 16.0}
    assert passed == [(stage, fraction) for stage, fraction, _ in calls]
    clock.now += 32
    assert stages.seconds() == {"reading": 9.0, "spot": 6.0, "writing": 48.0}


def test_the_seconds_before_any_stage_are_nobodys(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(stage_timer, "time", clock)
    stages = StageTimer(silent)
    clock.now += 5
    assert stages.seconds() == {}

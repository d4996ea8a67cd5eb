"""What a progress raises ends the work: said once for every algorithm."""

from collections.abc import Callable

import pytest

Progress = Callable[[str, float], None]


class StopError(Exception):
    """Raised by the progress of `stops_at`."""


def stops_at(count: int, work: Callable[[Progress], object]) -> None:
    """Assert that work whose progress raises at its call number ``count`` ends with that error, and calls no more."""
    calls = []

    def progress(stage: str, part: float) -> None:
        calls.append(stage)
        if len(calls) == count:
            raise StopError

    with pytest.raises(StopError):
        work(progress)
    assert len(calls) == count

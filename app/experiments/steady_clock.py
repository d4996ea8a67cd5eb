"""Clock check: whether the wall's clock has run as steadily as the machine's own since one last looked."""

import time
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta

TOLERANCE = timedelta(minutes=10)  # what a time server may correct
DOUBT = timedelta(days=1)  # how long a clock that jumped is not believed


def since_boot() -> timedelta:
    """Time since the machine started, which nobody sets; sleep is part of it."""
    return timedelta(seconds=time.clock_gettime(time.CLOCK_BOOTTIME))


@dataclass
class SteadyClock:
    """Says whether an age may be believed: what is removed by age must not go because somebody set the clock."""

    _wall: datetime = field(default_factory=lambda: datetime.now(UTC))
    _machine: timedelta = field(default_factory=since_boot)
    _doubted: timedelta | None = None

    def steady(self) -> bool:
        """Whether the clock has not jumped since the last look, nor within the day before."""
        wall, machine = datetime.now(UTC), since_boot()
        if abs((wall - self._wall) - (machine - self._machine)) > TOLERANCE:
            self._doubted = machine
        self._wall, self._machine = wall, machine
        return self._doubted is None or machine - self._doubted > DOUBT

"""Lapses of leases: finds those whose heartbeat stands still, without asking any clock for the time of day."""

import time
from collections.abc import Sequence

from app.experiments.model import Beat

LEASE_SECONDS = 15.0  # how long a heartbeat may stand still


class Lapses:
    """Heartbeats as they were seen from here, by the monotonic clock.

    Only an unbroken row of looks counts: who could not look for a while cannot tell a dead worker from one that could
    not write either.
    """

    def __init__(self) -> None:
        self._seen: dict[str, tuple[Beat, float]] = {}

    def look(self, beats: Sequence[Beat]) -> list[Beat]:
        """Take in a look at all leases; those that stood still for `LEASE_SECONDS`."""
        now, seen = time.monotonic(), dict[str, tuple[Beat, float]]()
        for beat in beats:
            known = self._seen.get(beat.job)
            seen[beat.job] = known if known is not None and known[0] == beat else (beat, now)
        self._seen = seen
        return [beat for beat, since in seen.values() if now - since >= LEASE_SECONDS]

    def forget(self) -> None:
        """Begin anew, after a look that failed."""
        self._seen.clear()

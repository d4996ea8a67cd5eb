"""Moving windows in memory: a storage for the `limits` library that no clock and no number of clients disturbs.

The library's own counts by the wall clock, which may jump by days, and keeps an entry of every client for ever.
"""

import threading
import time
from collections import deque
from dataclasses import dataclass, field

from limits.storage.base import MovingWindowSupport, Storage

SWEEP_SECONDS = 60.0  # how often what is past is dropped, of clients that did not come back


@dataclass
class _Taken:
    """What one key took, oldest first, how much that is together, and for how long it counts."""

    entries: deque[tuple[float, int]] = field(default_factory=deque)
    total: int = 0
    kept: float = 0.0


class MonotonicWindows(Storage, MovingWindowSupport):
    """What was taken, by key: moments of the monotonic clock, each with an amount."""

    STORAGE_SCHEME = None  # of no address

    def __init__(self) -> None:
        super().__init__()
        self._taken: dict[str, _Taken] = {}
        self._lock = threading.RLock()
        self._swept = self.now()

    @staticmethod
    def now() -> float:
        """Seconds of the clock that the windows are in."""
        return time.monotonic()

    @property
    def base_exceptions(self) -> tuple[type[Exception], ...]:
        """Errors of the storage: there are none."""
        return ()

    def acquire_entry(self, key: str, limit: int, expiry: int, amount: int = 1) -> bool:
        """Take an amount if the window has room for it; whether it had."""
        with self._lock:
            if self.get_moving_window(key, limit, expiry)[1] + amount > limit:
                return False
            taken = self._taken.setdefault(key, _Taken())
            taken.entries.append((self.now(), amount))
            taken.total += amount
            taken.kept = expiry
            if self.now() - self._swept > SWEEP_SECONDS:
                self._sweep()
        return True

    def get_moving_window(self, key: str, limit: int, expiry: int) -> tuple[float, int]:
        """Give the moment of the oldest entry within the window, and what was taken within it."""
        with self._lock:
            now, taken = self.now(), self._taken.get(key, _Taken())
            while taken.entries and taken.entries[0][0] <= now - expiry:
                taken.total -= taken.entries.popleft()[1]
            return taken.entries[0][0] if taken.entries else now, taken.total

    def _sweep(self) -> None:
        self._swept = now = self.now()
        for key, taken in list(self._taken.items()):
            if not taken.entries or taken.entries[-1][0] <= now - taken.kept:
                self.clear(key)

    def clear(self, key: str) -> None:
        """Forget what was taken."""
        with self._lock:
            self._taken.pop(key, None)

    def reset(self) -> int:
        """Forget everything; how many keys there were."""
        with self._lock:
            count = len(self._taken)
            self._taken.clear()
        return count

    def check(self) -> bool:
        """Whether it works."""
        return True

    def incr(self, key: str, expiry: int, amount: int = 1) -> int:
        """Refuse: only moving windows are kept."""
        raise NotImplementedError("only moving windows are kept here")

    def get(self, key: str) -> int:
        """Refuse: only moving windows are kept."""
        raise NotImplementedError("only moving windows are kept here")

    def get_expiry(self, key: str) -> float:
        """Refuse: only moving windows are kept."""
        raise NotImplementedError("only moving windows are kept here")

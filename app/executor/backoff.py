"""Back-off: growing pauses between attempts."""

import time


class Backoff:
    """Pauses that double from the first one to the longest, until `succeed`.

    Parameters
    ----------
    first, longest : float
        Seconds.
    """

    def __init__(self, first: float, longest: float) -> None:
        self._first = first
        self._longest = longest
        self._pause = 0.0
        self._until = 0.0
        #: Whether the last attempt failed.
        self.failing = False

    def fail(self) -> float:
        """Note an attempt that failed; seconds until the next one is due."""
        self.failing = True
        self._pause = min(2 * self._pause or self._first, self._longest)
        self._until = time.monotonic() + self._pause
        return self._pause

    def recover(self) -> None:
        """Note that one may go on; if that fails again, the pauses go on growing."""
        self.failing = False

    def succeed(self) -> None:
        """Note an attempt that succeeded: the next pause is the first one again."""
        self.failing = False
        self._pause = self._until = 0.0

    @property
    def due(self) -> bool:
        """Whether an attempt may be made now."""
        return time.monotonic() >= self._until

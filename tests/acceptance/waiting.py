"""Waiting for the outside world: for a condition, never for a time."""

import time
from collections.abc import Callable
from typing import Any

PATIENCE = 60.0


def until(condition: Callable[[], Any], what: str, patience: float = PATIENCE) -> Any:
    """Wait for a condition; give back what it gave."""
    deadline = time.monotonic() + patience
    pause = 0.02
    while time.monotonic() < deadline:
        if found := condition():
            return found
        time.sleep(pause)
        pause = min(2 * pause, 0.2)
    raise AssertionError(f"waited {patience:.0f} s for {what}")

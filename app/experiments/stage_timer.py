"""Stage timer: the seconds that a run spends in each of its stages."""

import time

from app.methods.context import Progress


class StageTimer:
    """Progress callback that passes every call on, and measures the seconds of each stage."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._seconds: dict[str, float] = {}
        self._stage: str | None = None
        self._since = time.perf_counter()

    def __call__(self, stage: str, fraction: float) -> None:
        self._progress(stage, fraction)
        if stage != self._stage:
            self.seconds()
            self._stage = stage

    def seconds(self) -> dict[str, float]:
        """Measure the seconds by stage up to now."""
        now = time.perf_counter()
        if self._stage is not None:
            self._seconds[self._stage] = self._seconds.get(self._stage, 0.0) + now - self._since
        self._since = now
        return dict(self._seconds)

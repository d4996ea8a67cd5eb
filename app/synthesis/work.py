"""Work in stages that is shared out over threads and can be stopped."""

import threading
from collections.abc import Callable, Iterable
from typing import TypeVar

from app.synthesis.team import Team

Progress = Callable[[str, float], None]
T = TypeVar("T")


class Work:
    """Shares work out over a team; when the progress raises, the pieces that are running stop too."""

    def __init__(self, team: Team, progress: Progress) -> None:
        self._team, self._progress, self.threads = team, progress, team.threads
        self._stopped = threading.Event()

    def alive(self) -> None:
        """Raise if the work is to stop: for pieces of work to call between their steps."""
        if self._stopped.is_set():
            raise InterruptedError

    def run(self, stage: str, task: Callable[[T], object], items: Iterable[T]) -> None:
        """Call ``task(item)`` for every item, the progress going from 0 to 1 under the stage's name."""

        def done(part: float) -> None:
            try:
                self._progress(stage, part)
            except BaseException:
                self._stopped.set()
                raise

        done(0)
        self._team.run(task, items, done)

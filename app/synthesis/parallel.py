"""A few threads that share out blocks of work; numpy and scipy release the interpreter's lock inside them."""

import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, wait
from types import TracebackType
from typing import TypeVar

from .arrays import PartDone, Progress

T = TypeVar("T")

ROWS = 64  # rows of a block
PATIENCE = 0.2  # seconds between calls of ``done`` while a long task runs


class Team:
    """A pool of ``threads`` threads, to be used in a ``with`` statement."""

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self._pool = ThreadPoolExecutor(max(1, threads), thread_name_prefix="synthesis")

    def __enter__(self) -> "Team":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._pool.shutdown(wait=True, cancel_futures=True)

    def run(self, task: Callable[[T], object], items: Iterable[T], done: PartDone) -> None:
        """Call ``task(item)`` for every item in the pool, and ``done(part)`` in this thread, ``part`` going to 1.

        ``done`` is called at each item's end, and every now and then while one takes long.

        If a task or ``done`` raises, the tasks that have not begun are dropped, and the error is raised once the
        running ones have ended.
        """
        futures = [self._pool.submit(task, item) for item in items]
        try:
            for count, future in enumerate(futures):
                while not wait([future], PATIENCE).done:
                    done(count / len(futures))
                future.result()
                done((count + 1) / len(futures))
        except BaseException:
            wait([future for future in futures if not future.cancel()])
            raise


class Work:
    """Shares work out over a team; when the progress raises, the pieces that are running stop too."""

    def __init__(self, team: Team, progress: Progress) -> None:
        self._team, self._progress, self.threads = team, progress, team.threads
        self._stopped = threading.Event()

    def checkpoint(self) -> None:
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


def row_blocks(height: int, rows: int = ROWS) -> list[tuple[int, int]]:
    """First and last-plus-one row of every block."""
    return [(first, min(first + rows, height)) for first in range(0, height, rows)]

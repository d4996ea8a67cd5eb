"""Threads that share out blocks of work; numpy and scipy release the interpreter's lock inside them.

- `row_blocks` cuts an image into blocks of rows, the items of work.
- A `Team` is a pool of threads: `Team.run` computes a task for every item.
- `Work` is a team together with a progress: `Work.run` reports the progress of a named stage, and when that raises,
  tasks that are running end at their next `Work.checkpoint`. It is for tasks that take seconds.

What a task computes must depend on its item alone, so that no result depends on the number of threads.
"""

import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, wait
from types import TracebackType
from typing import TypeVar

from .arrays import PartDone, Progress

T = TypeVar("T")

ROWS = 64  # rows of a block
PATIENCE = 0.2  # seconds between two reports while a long task runs


class Team:
    """A pool of threads, to be used in a ``with`` statement.

    Parameters
    ----------
    threads : int
        How many; at least one is used.
    """

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self._pool = ThreadPoolExecutor(max(1, threads), thread_name_prefix="synthesis")

    def __enter__(self) -> "Team":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._pool.shutdown(wait=True, cancel_futures=True)

    def run(self, task: Callable[[T], object], items: Iterable[T], report: PartDone) -> None:
        """Compute a task for every item in the pool, and report in the calling thread.

        Parameters
        ----------
        task : callable ``(item)``
        items : iterable
        report : callable ``(part)``
            Called with the part of the items that is done, up to 1: at each item's end, and every `PATIENCE` seconds
            while one takes long.

        Raises
        ------
        BaseException
            What a task or ``report`` raises, once the running tasks have ended; those that have not begun are dropped.
        """
        futures = [self._pool.submit(task, item) for item in items]
        try:
            for count, future in enumerate(futures):
                while not wait([future], PATIENCE).done:
                    report(count / len(futures))
                future.result()
                report((count + 1) / len(futures))
        except BaseException:
            wait([future for future in futures if not future.cancel()])
            raise


class Work:
    """A team with a progress that can stop the tasks that are running.

    Parameters
    ----------
    team : Team
    progress : callable ``(stage, part)``
        Called in the calling thread; when it raises, running tasks end at their next `checkpoint`.
    """

    def __init__(self, team: Team, progress: Progress) -> None:
        self._team, self._progress, self.threads = team, progress, team.threads
        self._stopped = threading.Event()

    def checkpoint(self) -> None:
        """Raise `InterruptedError` if the work is to stop; tasks call this between their steps."""
        if self._stopped.is_set():
            raise InterruptedError

    def run(self, stage: str, task: Callable[[T], object], items: Iterable[T]) -> None:
        """Compute a task for every item, the progress of the stage going from 0 to 1.

        Parameters
        ----------
        stage : str
            Name of this pass in the progress.
        task : callable ``(item)``
        items : iterable

        Raises
        ------
        BaseException
            What a task or the progress raises; see `Team.run`.
        """

        def report(part: float) -> None:
            try:
                self._progress(stage, part)
            except BaseException:
                self._stopped.set()
                raise

        report(0)
        self._team.run(task, items, report)


def row_blocks(height: int, rows: int = ROWS) -> list[tuple[int, int]]:
    """Cut rows 0 … height − 1 into blocks: the first and the last-plus-one row of each.

    Examples
    --------
    >>> row_blocks(150)
    [(0, 64), (64, 128), (128, 150)]
    """
    return [(first, min(first + rows, height)) for first in range(0, height, rows)]

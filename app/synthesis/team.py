"""A few threads that share out blocks of work; numpy and scipy release the interpreter's lock inside them."""

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, wait
from types import TracebackType
from typing import TypeVar

T = TypeVar("T")

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

    def run(self, task: Callable[[T], object], items: Iterable[T], done: Callable[[float], None]) -> None:
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

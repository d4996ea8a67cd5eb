"""One executor under test, and what its callbacks were told."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import engine_jobs
import pytest

from app.executor.dask import DaskExecutor
from app.experiments.model import DEEP, Lease, Snapshot, Status
from app.settings import Settings
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.executor.inline import InlineExecutor

SUFFIX = f"{DEEP}texture"
SECONDS = 30.0  # none of what is waited for takes as long


class Bench:
    """One executor under test, with its jobs' marks and what it told the service."""

    def __init__(self, kind: str, executor: Any, queue: SqlQueue, directory: Path) -> None:
        self.kind = kind
        self.executor = executor
        self.queue = queue
        self.directory = directory
        self.told: list[str] = []
        self._changed = threading.Condition()
        executor.subscribe(self._on_change)

    def start(self) -> None:
        self.executor.start(self)

    # records

    def fail(self, lease: Lease, error: str, cause: str | None = None) -> None:
        self.queue.finish(lease, error)

    def stopped(self, job: str) -> bool:
        return not self.queue.states([job])

    # what a test does

    def job(self, name: str) -> str:
        return f"{name}!{self.directory}{SUFFIX}"

    def submit(self, *names: str) -> None:
        for name in names:
            self.queue.enqueue(self.job(name), "tests")
        self.executor.wake()

    def cancel(self, name: str) -> None:
        self.queue.cancel(self.job(name))
        self.executor.wake()

    def snapshot(self, name: str) -> Snapshot | None:
        return self.queue.states([self.job(name)]).get(self.job(name))

    def status(self, name: str) -> Status | None:
        return found.status if (found := self.snapshot(name)) is not None else None

    def go(self, name: str) -> None:
        (self.directory / f"{name}.go").touch()

    def started(self, name: str) -> list[int]:
        return engine_jobs.marks(self.directory, f"{name}.started")

    def done(self, name: str) -> list[int]:
        return engine_jobs.marks(self.directory, f"{name}.done")

    def until(self, condition: Callable[[], Any]) -> None:
        """Wait for a condition; looked at on every callback, and often besides, as marks on disk call nobody."""
        with self._changed:
            for _ in range(int(SECONDS / 0.02)):
                if condition():
                    return
                self._changed.wait(0.02)
        pytest.fail("what was waited for did not come")

    def end_of(self, name: str) -> str | None:
        """Wait until a job that was submitted has left the queue; its failure."""
        self.until(lambda: self.snapshot(name) is None)
        return self.queue.failure(self.job(name))

    def _on_change(self, job: str) -> None:
        with self._changed:
            self.told.append(job)
            self._changed.notify_all()


def a_bench(kind: str, directory: Path, **values: Any) -> Bench:
    """A bench not yet started, with two workers unless told otherwise."""
    settings = Settings(data_dir=directory, **({"workers": 2, "worker_memory": 300 << 20} | values))
    queue = SqlQueue(SqlStore(settings.sql_url).database)
    executor: Any
    if kind == "dask":
        executor = DaskExecutor(settings, engine_jobs.run, queue, lambda: None)
    else:
        executor = InlineExecutor(settings, engine_jobs.run, queue)
    return Bench(kind, executor, queue, directory)


@contextmanager
def running(bench: Bench) -> Iterator[Bench]:
    bench.start()
    try:
        yield bench
    finally:
        bench.executor.close()

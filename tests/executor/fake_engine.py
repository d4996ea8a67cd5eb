"""An engine without Dask: its tasks end when the test says so, and what it is asked fails where the test wants it."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from app.executor import dask
from app.executor.dask import DaskExecutor
from app.settings import Settings

PATIENCE = 20.0
WORKER = "tcp://worker"
LIMIT = 60.0  # seconds that a job may run


class Task:
    """A future that ends when the test says so."""

    def __init__(self, job: str) -> None:
        self.job = job
        self.status = "pending"
        self.error: Exception | None = None
        self.callback: Callable[[Any], None] = lambda task: None
        self.released = False

    def add_done_callback(self, callback: Callable[[Any], None]) -> None:
        self.callback = callback

    def exception(self) -> Exception | None:
        return self.error

    def release(self) -> None:
        self.released = True

    def end(self, status: str = "finished", error: Exception | None = None) -> None:
        self.status, self.error = status, error
        self.callback(self)


class Engine:
    """One worker with one thread; what it is asked is noted, and what is in ``failing`` raises."""

    def __init__(self) -> None:
        self.alive = True
        self.threads = {WORKER: 1}
        self.failing: set[str] = set()
        self.asked: list[tuple[str, Any]] = []
        self.tasks: dict[str, Task] = {}

    def _ask(self, what: str, value: Any) -> None:
        self.asked.append((what, value))
        if what in self.failing:
            raise OSError(f"{what} fails")

    def workers(self) -> dict[str, int]:
        self._ask("workers", None)
        return dict(self.threads)

    def submit(self, job: str, address: str) -> Task:
        self._ask("submit", job)
        self.tasks[job] = Task(job)
        return self.tasks[job]

    def forget(self, task: Task) -> None:
        self._ask("forget", task.job)

    def stop(self, job: str) -> None:
        self._ask("stop", job)

    def kill(self, address: str) -> None:
        self._ask("kill", address)

    def close(self) -> None:
        self._ask("close", None)

    def times(self, what: str) -> list[Any]:
        return [value for name, value in self.asked if name == what]


class Bench:
    """An executor whose engines are made by the test, and what it told the service."""

    def __init__(self, engines: list[Engine]) -> None:
        self.engines = engines
        self.opened: list[Engine] = []
        self.cannot_open = 0
        self.ended: list[tuple[str, str | None]] = []
        self.told: list[str] = []
        self.executor = DaskExecutor(Settings(data_dir=Path("unused"), time_limit=LIMIT), lambda *_: None)
        self.executor.subscribe(self.told.append)
        self._moments = threading.Event()

    def open(self, *_: Any, **__: Any) -> Engine:
        if self.cannot_open:
            self.cannot_open -= 1
            raise OSError("no scheduler answers")
        self.opened.append(self.engines[len(self.opened)])
        return self.opened[-1]

    def start(self) -> None:
        self.executor.start(lambda job, failure: self.ended.append((job, failure)))

    def until(self, condition: Callable[[], object]) -> None:
        for _ in range(int(PATIENCE / 0.005)):
            if condition():
                return
            self._moments.wait(0.005)
        pytest.fail("what was waited for did not come")


@contextmanager
def dispatching(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    """Make an executor with two engines, one after the other, that does not pause for long."""
    monkeypatch.setattr(dask, "TICK_SECONDS", 0.005)
    monkeypatch.setattr(dask, "WORKERS_SECONDS", 0.0)
    monkeypatch.setattr(dask, "FIRST_PAUSE_SECONDS", 0.001)
    monkeypatch.setattr(dask, "LONGEST_PAUSE_SECONDS", 0.004)
    bench = Bench([Engine(), Engine()])
    monkeypatch.setattr(dask, "Engine", bench.open)
    yield bench
    bench.executor.close()

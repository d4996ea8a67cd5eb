"""An engine without Dask: its tasks end when the test says so, and what it is asked fails where the test wants it."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from app.errors import UnavailableError
from app.executor import dask, keeper
from app.executor.dask import DaskExecutor
from app.executor.dispatched import Dispatched
from app.executor.endings import Endings
from app.experiments.model import DEEP, Lease, Snapshot
from app.settings import Settings
from app.store.queue import SqlQueue
from app.store.sql import SqlStore

PATIENCE = 20.0
WORKER = "tcp://worker"
SUFFIX = f"{DEEP}texture"
LIMIT = 60.0  # seconds that a job may run


class Task:
    """A future that ends when the test says so."""

    def __init__(self, lease: Lease) -> None:
        self.lease = lease
        self.job = lease.job.removesuffix(SUFFIX)
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
        self.name = "engine"
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

    def ask(self, address: str, function: Callable[..., Any], *arguments: Any) -> Any:
        return function(*arguments)

    def busy(self) -> dict[str, int]:
        return {}

    def submit(self, lease: Lease, address: str) -> Task:
        task = Task(lease)
        self._ask("submit", task.job)
        self.tasks[task.job] = task
        return task

    def forget(self, task: Task) -> None:
        self._ask("forget", task.job)

    def kill(self, address: str) -> None:
        self._ask("kill", address)

    def close(self) -> None:
        self._ask("close", None)

    def times(self, what: str) -> list[Any]:
        return [value for name, value in self.asked if name == what]


class Bench:
    """An executor whose engines are made by the test, and its queue; jobs are called by what stands before `SUFFIX`."""

    def __init__(self, engines: list[Engine], directory: Path) -> None:
        self.engines = engines
        self.opened: list[Engine] = []
        self.cannot_open = 0
        self.failed: list[tuple[str, str, str | None]] = []
        self.unwanted: set[str] = set()
        self.told: list[str] = []
        self.away: UnavailableError | None = None
        self.hopeless = threading.Event()
        settings = Settings(data_dir=directory, time_limit=LIMIT)
        self.store = SqlStore(settings.sql_url)
        self.queue = SqlQueue(self.store.database)
        self.executor = DaskExecutor(settings, lambda *_: None, self.queue, self.probe, self.hopeless.set)
        self.executor.subscribe(self.told.append)
        self.executor._records, self.executor._endings = self, Endings(self.queue, self, LIMIT)
        self._moments = threading.Event()

    def open(self, *_: Any, **__: Any) -> Engine:
        if self.cannot_open:
            self.cannot_open -= 1
            raise OSError("no scheduler answers")
        self.opened.append(self.engines[len(self.opened)])
        return self.opened[-1]

    def start(self) -> None:
        self.executor.start(self)

    def start_in_background(self) -> None:
        """Start without waiting for workers."""
        threading.Thread(target=self.start, daemon=True).start()

    def probe(self) -> None:
        if self.away is not None:
            raise self.away

    # records

    def fail(self, lease: Lease, error: str, cause: str | None = None) -> None:
        if self.queue.finish(lease):
            self.failed.append((lease.job.removesuffix(SUFFIX), error, cause))

    def stopped(self, job: str) -> bool:
        return job.removesuffix(SUFFIX) in self.unwanted

    # what a test does

    def submit(self, *names: str) -> None:
        for name in names:
            self.queue.enqueue(name + SUFFIX, "tests")
        self.executor.wake()

    def cancel(self, name: str) -> None:
        self.unwanted.add(name)
        self.queue.cancel(name + SUFFIX)
        self.executor.wake()

    def state(self, name: str) -> Snapshot | None:
        return self.queue.states([name + SUFFIX]).get(name + SUFFIX)

    def run_of(self, name: str) -> Dispatched:
        return next(run for run in self.executor._runs if run.lease.job == name + SUFFIX)

    def record(self, task: Task) -> None:
        """End a task as a worker does that has recorded its end."""
        self.queue.finish(task.lease)
        task.end()

    def until(self, condition: Callable[[], object]) -> None:
        for _ in range(int(PATIENCE / 0.005)):
            if condition():
                return
            self._moments.wait(0.005)
        pytest.fail("what was waited for did not come")


def messages(caplog: pytest.LogCaptureFixture) -> list[tuple[int, str]]:
    """What was logged, with its levels."""
    return [(record.levelno, record.message) for record in caplog.records]


@contextmanager
def dispatching(monkeypatch: pytest.MonkeyPatch, directory: Path) -> Iterator[Bench]:
    """Make an executor with three engines, one after the other, that does not pause for long."""
    monkeypatch.setattr(dask, "TICK_SECONDS", 0.005)
    monkeypatch.setattr(dask, "LOOK_SECONDS", 0.0)
    for module in (dask, keeper):
        monkeypatch.setattr(module, "FIRST_PAUSE_SECONDS", 0.001)
        monkeypatch.setattr(module, "LONGEST_PAUSE_SECONDS", 0.004)
    monkeypatch.setattr(keeper, "WORKERS_SECONDS", 0.0)
    bench = Bench([Engine(), Engine(), Engine()], directory)
    monkeypatch.setattr(keeper, "Engine", bench.open)
    yield bench
    bench.executor.close()
    bench.store.close()

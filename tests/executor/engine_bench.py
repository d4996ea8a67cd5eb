"""One executor under test, and what its callbacks were told."""

import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import engine_jobs
import pytest

from app.executor.dask import DaskExecutor
from app.settings import Settings
from tests.executor.inline import InlineExecutor

SECONDS = 30.0  # none of what is waited for takes as long


class Bench:
    """One executor under test, with its jobs' marks and what it told the service."""

    def __init__(self, kind: str, executor: Any, directory: Path) -> None:
        self.kind = kind
        self.executor = executor
        self.directory = directory
        self.ended: list[tuple[str, str | None]] = []
        self.told: list[str] = []
        self._changed = threading.Condition()
        executor.subscribe(self._on_change)

    def start(self) -> None:
        self.executor.start(self._on_end)

    def job(self, name: str) -> str:
        return f"{name}!{self.directory}"

    def submit(self, *names: str) -> None:
        for name in names:
            self.executor.submit(self.job(name))

    def cancel(self, name: str) -> None:
        self.executor.cancel(self.job(name))

    def snapshot(self, name: str) -> Any:
        return self.executor.snapshot(self.job(name))

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

    def ended_jobs(self, *names: str) -> list[str]:
        """Those of these jobs that have ended, in the order of their ends."""
        jobs = {self.job(name) for name in names}
        return [job for job, _ in self.ended if job in jobs]

    def end_of(self, name: str) -> str | None:
        """Wait for a job's end; its failure."""
        self.until(lambda: self.ended_jobs(name))
        failures = [failure for job, failure in self.ended if job == self.job(name)]
        assert len(failures) == 1
        return failures[0]

    def _on_end(self, job: str, failure: str | None) -> None:
        with self._changed:
            self.ended.append((job, failure))
            self._changed.notify_all()

    def _on_change(self, job: str) -> None:
        with self._changed:
            self.told.append(job)
            self._changed.notify_all()


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def a_bench(kind: str, directory: Path, **values: Any) -> Bench:
    """A bench not yet started, with two workers unless told otherwise."""
    settings = Settings(data_dir=directory, **({"workers": 2, "worker_memory": 300 << 20} | values))
    executor = {"dask": DaskExecutor, "inline": InlineExecutor}[kind](settings, engine_jobs.run)
    return Bench(kind, executor, directory)


@contextmanager
def running(bench: Bench) -> Iterator[Bench]:
    bench.start()
    try:
        yield bench
    finally:
        bench.executor.close()

"""Host: a whole service of real processes, as an operator would run it, on one of the databases and engines."""

import itertools
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import httpx
import psutil

from app.settings import ROOT
from tests.chaos.processes import Line, Supervised, clean_environment, until
from tests.chaos.servers import PostgreSQL
from tests.store.conftest import free_port

FAKETIME = next(iter(sorted(Path("/usr/lib").glob("*/faketime/libfaketime.so.1"))), None)
MIN_FREE = 16 << 20  # bytes


@dataclass(frozen=True)
class Kind:
    """What a host is made of."""

    database: Literal["sqlite", "postgresql"] = "sqlite"
    engine: Literal["embedded", "external"] = "embedded"
    webs: int = 1

    def __str__(self) -> str:
        return f"{self.database}, {self.engine} engine, {self.webs} web"


class Host:
    """The processes of a service, and what they lean on.

    Parameters
    ----------
    kind : Kind
    directory : Path
        Everything that it writes is below.
    """

    def __init__(self, kind: Kind, directory: Path) -> None:
        self.kind = kind
        self.data = directory / "data"
        self.clock = directory / "clock"
        self.data.mkdir(exist_ok=True)
        self.clock.write_text("+0")
        self.postgresql = PostgreSQL() if kind.database == "postgresql" else None
        self.environment = self._settings()
        self._logs = directory / "logs"
        self._logs.mkdir()
        self.scheduler: Supervised | None = None
        self.workers: list[Supervised] = []
        self.webs: list[Supervised] = []
        ports = [free_port() for _ in range(kind.webs)]
        self.addresses = [f"http://127.0.0.1:{port}" for port in ports]
        if kind.engine == "external":
            address = f"tcp://127.0.0.1:{free_port()}"
            self.environment["MICROTEXTURE_SCHEDULER"] = address
            scheduler = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--no-dashboard"]
            where = ["--host", "127.0.0.1", "--port", address.rpartition(":")[2]]
            self.scheduler = self._start("scheduler", [*scheduler, *where])
            worker = [sys.executable, "-m", "distributed.cli.dask_worker", address, "--nthreads", "1", "--no-dashboard"]
            self.workers = [self._start(f"worker-{i}", worker) for i in range(2)]
        for i, port in enumerate(ports):
            self.webs.append(self._start(f"web-{i}", self.program("serve", "--port", f"{port}")))

    def _settings(self) -> dict[str, str]:
        settings = clean_environment() | {
            "PYTHONPATH": str(ROOT),
            "MICROTEXTURE_DATA_DIR": str(self.data),
            "MICROTEXTURE_WORKERS": "2" if self.kind.webs == 1 else "1",
            "MICROTEXTURE_THREADS": "1",
            "MICROTEXTURE_CATALOGUE": "false",
            "MICROTEXTURE_LIMITS": "false",
            "MICROTEXTURE_QUEUE_LIMIT": "1000",
            "MICROTEXTURE_MIN_FREE_BYTES": f"{MIN_FREE}",
        }
        if self.postgresql is not None:
            settings["MICROTEXTURE_DATABASE_URL"] = self.postgresql.url
        if FAKETIME is not None:
            settings |= {
                "LD_PRELOAD": str(FAKETIME),
                "FAKETIME_TIMESTAMP_FILE": str(self.clock),
                "FAKETIME_CACHE_DURATION": "1",
                "FAKETIME_DONT_FAKE_MONOTONIC": "1",
            }
        return settings

    def program(self, *arguments: str) -> list[str]:
        return [str(Path(sys.executable).with_name("microtexture")), *arguments]

    def _start(self, name: str, command: list[str]) -> Supervised:
        return Supervised(name, command, self.environment, self._logs / f"{name}.log")

    def until_ready(self, seconds: float = 120.0) -> None:
        for address in self.addresses:
            until(lambda address=address: _status(f"{address}/readyz") == 200, f"{address}/readyz says 200", seconds)

    def lines(self) -> list[Line]:
        """All that the processes wrote, in the order in which it came."""
        written = (list(process.lines) for process in (*self.webs, *self.workers))
        return sorted(itertools.chain(*written), key=lambda line: line.at)

    def stop(self) -> None:
        problems = []
        for process in (*self.webs, *self.workers, self.scheduler):
            try:
                if process is not None:
                    process.stop()
            except AssertionError as error:
                problems.append(str(error))
        assert not problems, problems

    def close(self) -> None:
        if self.postgresql is not None:
            self.postgresql.close()

    # what can be killed

    def engine_workers(self) -> list[psutil.Process]:
        """The processes that compute: children of the fork server, or of the nannies of an external engine."""
        if self.workers:
            return [child for worker in self.workers for child in worker.children() if _is(child, "spawn_main")]
        return [
            child for web in self.webs for child in web.children() if _is(child, "forkserver") and not _forks(child)
        ]

    def fork_servers(self) -> list[psutil.Process]:
        return [child for web in self.webs for child in web.children() if _forks(child)]

    def decoders(self) -> list[psutil.Process]:
        return [child for web in self.webs for child in web.children() if _is(child, "app.images.intake.server")]


def _status(address: str) -> int | None:
    try:
        return httpx.get(address, timeout=10).status_code
    except httpx.HTTPError:
        return None


def _is(process: psutil.Process, module: str) -> bool:
    try:
        return any(module in word for word in process.cmdline())
    except psutil.NoSuchProcess:
        return False


def _forks(process: psutil.Process) -> bool:
    """Whether it is a fork server itself: what it forks has its command line, and it for a parent."""
    try:
        parent = process.parent()
        return _is(process, "forkserver") and not (parent is not None and _is(parent, "forkserver"))
    except psutil.NoSuchProcess:
        return False


@contextmanager
def running(kind: Kind, directory: Path) -> Iterator[Host]:
    """Start a host, wait until it is ready, and stop all of it at the end."""
    host = Host(kind, directory)
    try:
        host.until_ready()
        yield host
        host.stop()
    finally:
        for process in (*host.webs, *host.workers, host.scheduler):
            if process is not None:
                process.abandon()
        host.close()

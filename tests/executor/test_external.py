"""A worker of ours comes back when its scheduler does, and one that sees something else gets no job."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from engine_bench import SECONDS, a_bench, running

from app.errors import InvalidInputError
from app.executor import keeper
from app.executor.keeper import EngineKeeper
from app.settings import Settings
from tests.executor.fake_engine import WORKER, Engine
from tests.store.conftest import free_port

QUIET: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
PATHS = os.pathsep.join([str(Path(__file__).parent), str(Path(__file__).parents[2])])


@contextmanager
def process(*command: str, **environment: str) -> Iterator[subprocess.Popen[bytes]]:
    started = subprocess.Popen(
        [sys.executable, *command], env=os.environ | {"PYTHONPATH": PATHS} | environment, **QUIET
    )
    try:
        yield started
    finally:
        started.terminate()
        try:
            started.wait(SECONDS)
        finally:
            started.kill()


def scheduler(port: int) -> Any:
    options = ("--host", "127.0.0.1", "--no-dashboard", "--port", str(port))
    return process("-m", "distributed.cli.dask_scheduler", *options)


@pytest.mark.chaos
def test_a_worker_comes_back_when_its_scheduler_does_and_stops_when_told(tmp_path: Path) -> None:
    port = free_port()
    address = f"tcp://127.0.0.1:{port}"
    program = str(Path(sys.executable).parent / "microtexture")
    with process(program, "worker", MICROTEXTURE_SCHEDULER=address) as worker:
        with running(a_bench("dask", tmp_path, scheduler=address)) as bench:
            for number in (1, 2):
                with scheduler(port) as found:
                    bench.submit(f"quick-{number}")
                    assert bench.end_of(f"quick-{number}") is None
                    found.send_signal(signal.SIGKILL)
                    found.wait(SECONDS)
                bench.until(lambda: not bench.executor.ready)
        worker.send_signal(signal.SIGTERM)
        assert worker.wait(SECONDS) == 0


@pytest.fixture
def engine(monkeypatch: pytest.MonkeyPatch) -> Engine:
    engine = Engine()
    monkeypatch.setattr(keeper, "Engine", lambda *_, **__: engine)
    monkeypatch.setattr(keeper, "WORKERS_SECONDS", 0.0)
    return engine


def kept(prove: Callable[[Any], None], scheduler: str | None = None) -> EngineKeeper:
    settings = Settings(data_dir=Path("unused"), scheduler=scheduler)
    made = EngineKeeper(settings, lambda *_: None, lambda: None, lambda: None, prove)
    made.keep()
    return made


def test_a_worker_that_does_not_prove_itself_gets_no_job_until_it_does(
    engine: Engine, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It is asked again by and by, and the log says what is wrong with it."""
    monkeypatch.setattr(keeper, "REFUSED_SECONDS", 0.0)
    wrong = threading.Event()
    wrong.set()
    asked: list[object] = []

    def prove(ask: Callable[..., Any]) -> None:
        asked.append(ask)
        if wrong.is_set():
            raise InvalidInputError("It does not see the service's files.")

    found = kept(prove, scheduler="tcp://scheduler:8786")
    for _ in range(2):
        found.refresh()
        assert found.workers == {}
    assert f"the worker {WORKER} gets no job: It does not see the service's files." in caplog.text
    wrong.clear()
    for _ in range(2):
        found.refresh()
        assert found.workers == {WORKER: 1}
    assert len(asked) == 3  # one that has proven itself is not asked again


def test_our_own_workers_are_not_asked(engine: Engine) -> None:
    found = kept(lambda ask: pytest.fail("it was asked"))
    found.refresh()
    assert found.workers == {WORKER: 1}

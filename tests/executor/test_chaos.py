"""What the Dask executor survives: killed workers, hogs of memory, code that hangs, a scheduler that dies."""

import asyncio
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import psutil
import pytest
from engine_bench import SECONDS, Bench, a_bench, running

from app.experiments.model import ATTEMPTS, Status
from tests.store.conftest import free_port

pytestmark = pytest.mark.chaos


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    with running(a_bench("dask", tmp_path_factory.mktemp("chaos"))) as bench:
        yield bench


@pytest.fixture
def bench(shared: Bench, tmp_path: Path) -> Bench:
    shared.directory = tmp_path
    return shared


@contextmanager
def bystander(bench: Bench) -> Iterator[None]:
    """A job on the other worker, which must not notice anything."""
    bench.submit("polite-bystander")
    bench.until(lambda: bench.started("polite-bystander"))
    yield
    assert bench.status("polite-bystander") is Status.RUNNING
    bench.go("polite-bystander")
    assert bench.end_of("polite-bystander") is None
    assert len(bench.started("polite-bystander")) == 1


def test_a_job_whose_worker_is_killed_runs_once_more(bench: Bench) -> None:
    with bystander(bench):
        bench.submit("polite")
        bench.until(lambda: bench.started("polite"))
        os.kill(bench.started("polite")[0], signal.SIGKILL)
        bench.until(lambda: len(bench.started("polite")) == 2)
        bench.go("polite")
        assert bench.end_of("polite") is None
        assert len(set(bench.started("polite"))) == 2


@pytest.mark.parametrize("name", [f"killed-{ATTEMPTS}", "greedy"])
def test_a_job_that_kills_one_worker_after_the_other_fails_with_words_while_others_finish(
    bench: Bench, name: str
) -> None:
    """By a signal or for want of memory; its last attempt waits until it is alone."""
    bench.submit("polite", "quick-1", name)
    assert bench.end_of("quick-1") is None
    bench.until(lambda: len(bench.started(name)) == ATTEMPTS - 1)
    bench.until(lambda: bench.status(name) is Status.QUEUED)
    bench.go("polite")
    assert bench.end_of("polite") is None
    failure = bench.end_of(name)
    assert failure is not None
    assert "with nothing else beside it, most likely for want of memory" in failure
    assert "smaller" in failure
    assert len(bench.started(name)) == ATTEMPTS
    bench.submit("quick-2")
    assert bench.end_of("quick-2") is None


def test_code_that_hangs_is_stopped_within_seconds(bench: Bench) -> None:
    with bystander(bench):
        bench.submit("stubborn", "quick")
        bench.until(lambda: bench.started("stubborn"))
        bench.cancel("stubborn")
        assert bench.snapshot("stubborn") is None
        assert bench.end_of("stubborn") is None
        assert bench.end_of("quick") is None
    assert not psutil.pid_exists(bench.started("stubborn")[0])


def test_code_that_hangs_beyond_the_time_limit_is_stopped(tmp_path: Path) -> None:
    with running(a_bench("dask", tmp_path, workers=1, time_limit=1.0)) as bench:
        bench.submit("stubborn", "quick")
        failure = bench.end_of("stubborn")
        assert failure is not None
        assert "longer than 1 seconds" in failure
        assert bench.end_of("quick") is None


def test_an_embedded_scheduler_that_dies_is_replaced(tmp_path: Path) -> None:
    with running(a_bench("dask", tmp_path)) as bench:
        bench.submit("polite-1", "polite-2", "quick")
        bench.until(lambda: bench.started("polite-1") and bench.started("polite-2"))
        bench.cancel("polite-2")
        cluster = bench.executor._keeper.engine._cluster
        closing = asyncio.run_coroutine_threadsafe(cluster.scheduler.close(), cluster.loop.asyncio_loop)
        closing.exception(SECONDS)  # it may stumble over what it was doing: dead it is either way
        bench.until(lambda: not bench.executor.ready or len(bench.started("polite-1")) == 2)
        assert bench.end_of("quick") is None
        bench.until(lambda: len(bench.started("polite-1")) == 2)
        bench.go("polite-1")
        assert bench.end_of("polite-1") is None
        assert bench.end_of("polite-2") is None
        assert bench.executor.ready


def test_a_remote_scheduler_that_dies_is_waited_for(tmp_path: Path) -> None:
    port = free_port()
    with remote_cluster(port) as kill_scheduler:
        bench = a_bench("dask", tmp_path, scheduler=f"tcp://127.0.0.1:{port}")
        with running(bench):
            bench.submit("quick-1", "refused")
            assert bench.end_of("quick-1") is None
            assert bench.end_of("refused") == "The crop is too small: make it larger."
            bench.submit("polite", "quick-2")
            bench.until(lambda: bench.started("polite"))
            kill_scheduler()
            bench.until(lambda: not bench.executor.ready)
            bench.submit("quick-3")
            with remote_cluster(port):
                bench.go("polite")
                assert {bench.end_of(name) for name in ("polite", "quick-2", "quick-3")} == {None}
                assert bench.executor.ready


def test_closing_leaves_no_worker_behind(tmp_path: Path) -> None:
    with running(a_bench("dask", tmp_path)) as bench:
        bench.submit("stubborn-1", "polite-2")
        bench.until(lambda: bench.started("stubborn-1") and bench.started("polite-2"))
    workers = [*bench.started("stubborn-1"), *bench.started("polite-2")]
    bench.until(lambda: not any(psutil.pid_exists(worker) for worker in workers))
    assert {bench.status(name) for name in ("stubborn-1", "polite-2")} == {Status.QUEUED}


@contextmanager
def remote_cluster(port: int) -> Iterator[Callable[[], None]]:
    """A scheduler and one worker as an operator starts them; gives what kills the scheduler at once."""
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), str(Path(__file__).parents[2])])
    }
    program = [sys.executable, "-m", "distributed.cli.dask_scheduler"]
    where = ["--host", "127.0.0.1", "--no-dashboard"]
    scheduler = subprocess.Popen([*program, *where, "--port", f"{port}"], env=environment, **quiet)
    program = [sys.executable, "-m", "distributed.cli.dask_worker", f"tcp://127.0.0.1:{port}"]
    options = ["--nthreads", "1", "--host", "127.0.0.1", "--no-dashboard", "--death-timeout", f"{SECONDS:.0f}"]
    worker = subprocess.Popen([*program, *options], env=environment, **quiet)
    try:
        yield scheduler.kill
    finally:
        for process in (worker, scheduler):
            children: list[Any] = (
                [process, *psutil.Process(process.pid).children(recursive=True)] if process.poll() is None else []
            )
            for child in children:
                child.kill()
            process.wait()

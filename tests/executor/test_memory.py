"""The workers' allocator: runs reuse memory, and what a large one took is given back."""

from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest
from engine_bench import Bench, a_bench, running

from app.executor.memory import KEPT, MALLOC


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    with running(a_bench("dask", tmp_path_factory.mktemp("memory"), workers=1, worker_memory=1 << 30)) as bench:
        yield bench


@pytest.fixture
def bench(shared: Bench, tmp_path: Path) -> Bench:
    shared.directory = tmp_path
    return shared


def test_worker_processes_are_started_with_the_allocators_variables(bench: Bench) -> None:
    """In the environment of their program, which is where glibc reads them, and not only in Python's copy of it."""
    bench.submit("quick")
    assert bench.end_of("quick") is None
    environment = psutil.Process(bench.started("quick")[0]).environ()
    assert {name: environment.get(name) for name in MALLOC} == {name: str(value) for name, value in MALLOC.items()}
    assert {environment[f"{library}_NUM_THREADS"] for library in ("MKL", "OMP", "OPENBLAS")} == {"1"}


def test_a_second_run_finds_its_memory_in_place(bench: Bench) -> None:
    """Some 30 pages are new for a texture of 512², where all 33,000 were when each array was given back at once."""
    for name in ("textured-1", "textured-2"):
        bench.submit(name)
        assert bench.end_of(name) is None
    assert int((bench.directory / "textured-2.faults").read_text()) < 5000


def test_a_large_run_gives_its_memory_back(bench: Bench) -> None:
    bench.submit("large")
    assert bench.end_of("large") is None
    worker = psutil.Process(bench.started("large")[0])
    bench.until(lambda: worker.memory_info().rss < KEPT)  # its record comes a moment before

"""Executors that run the jobs of `engine_jobs`."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))  # worker processes take this over, and find the jobs there

from engine_bench import Bench, a_bench, running


@pytest.fixture(scope="module", params=["inline", "dask"])
def shared_bench(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    with running(a_bench(request.param, tmp_path_factory.mktemp(request.param))) as bench:
        yield bench


@pytest.fixture
def bench(shared_bench: Bench, tmp_path: Path) -> Bench:
    """An idle executor; the directory of marks is the test's own."""
    shared_bench.directory = tmp_path
    return shared_bench


@pytest.fixture
def threads_of(bench: Bench) -> int:
    """How many jobs run at once."""
    return 2 if bench.kind == "dask" else 1

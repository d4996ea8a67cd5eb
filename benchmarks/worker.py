"""Overhead of a worker process over the kernel: ``python -m benchmarks.worker``.

The same texture is computed in turn by a job of the engine, in its worker, and by a call in this process, and both are
timed inside. Page faults are those of the worker while the job runs: pages of 4 KiB that the system had to put there.
"""

import json
import resource
import statistics
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import psutil

from app.executor.dask import DaskExecutor
from app.experiments.model import DEEP, Lease
from app.methods.context import Context
from app.methods.model import Source
from app.methods.registry import method
from app.settings import Settings
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from benchmarks.kernel import MEGABYTE, sample

SIDE = 512  # of the sample
RATIO_AIM = 1.15
FAULTS_AIM = 1000  # at 512²
ROUNDS = {512: 15, 1024: 9, 4096: 5}
PATIENCE = 120.0
SUFFIX = f"{DEEP}texture"  # the name of a job that has no record of its own


class Measured(NamedTuple):
    """One run: its seconds, the pages it faulted in, and the process that it ran in."""

    seconds: float
    faults: int
    process: int


def measure(side: int, threads: int, everything: bool) -> Measured:
    """RPN from a sample of 512² to this size: the texture's PNG, or every picture."""
    rpn = method("rpn")
    source = Source(sample(SIDE), 255)
    params = rpn.params(seed=1, width=side, height=side)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    start = time.perf_counter()
    pictures = rpn.pictures([source], params, Context(8, threads, lambda stage, fraction: None))
    if everything:
        for _ in pictures:
            pass
    else:
        next(pictures)
    seconds = time.perf_counter() - start
    faults = resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before
    return Measured(seconds, faults, psutil.Process().pid)


def run(settings: Settings, lease: Lease) -> None:
    """Measure in a worker, and leave the result in the data directory under the job's name."""
    name = lease.job.removesuffix(SUFFIX)
    _, side, what = name.split("-")
    measured = measure(int(side), settings.threads, what == "all")
    (settings.data_dir / name).write_text(json.dumps(measured))
    queue_of(settings).finish(lease)


@lru_cache
def queue_of(settings: Settings) -> SqlQueue:
    return SqlQueue(SqlStore(settings.sql_url).database)


class Worker:
    """An engine with one worker process."""

    def __init__(self, settings: Settings) -> None:
        self._settings, self._count = settings, 0
        self._queue = queue_of(settings)
        self._engine = DaskExecutor(settings, run, self._queue, lambda: None)

    @contextmanager
    def open(self) -> Iterator["Worker"]:
        """Start the worker, and stop it in the end."""
        self._engine.start(self)
        try:
            yield self
        finally:
            self._engine.close()

    def fail(self, lease: Lease, error: str, cause: str | None = None) -> None:
        """Take a failure of the engine: none is expected."""
        raise RuntimeError(error)

    def stopped(self, job: str) -> bool:
        """Whether a job was cancelled: none is."""
        return False

    def measure(self, side: int, everything: bool) -> Measured:
        """`measure` as a job."""
        self._count += 1
        name = f"{self._count}-{side}-{'all' if everything else 'texture'}"
        self._queue.enqueue(name + SUFFIX, "benchmark")
        self._engine.wake()
        until = time.monotonic() + PATIENCE
        while self._queue.states([name + SUFFIX]):
            if time.monotonic() > until:
                raise RuntimeError("The worker did not come to an end.")
            time.sleep(0.005)
        return Measured(*json.loads((self._settings.data_dir / name).read_text()))


def compare(worker: Worker, side: int, threads: int, everything: bool) -> None:
    """Print one line: both in turn after a run of each that is not measured, the median of the ratios of neighbours."""
    first = worker.measure(side, everything)
    measure(side, threads, everything)
    pairs = [(worker.measure(side, everything), measure(side, threads, everything)) for _ in range(ROUNDS[side])]
    ratio = statistics.median(inside.seconds / direct.seconds for inside, direct in pairs)
    faults = statistics.median(inside.faults for inside, _ in pairs)
    inside, direct = (1e3 * statistics.median(each.seconds for each in runs) for runs in zip(*pairs, strict=True))
    kept = psutil.Process(first.process).memory_info().rss / MEGABYTE
    faults_aim = "" if side != SIDE else f" ≤ {FAULTS_AIM} {'ok' if faults <= FAULTS_AIM else 'MISSED'}"
    print(
        f"{f'512² → {side}², ' + ('every picture' if everything else 'texture'):30}{ratio:6.2f}  ≤ {RATIO_AIM} "
        f"{'ok' if ratio <= RATIO_AIM else 'MISSED':8}{inside:8.1f} ÷ {direct:7.1f} ms{first.faults:9}{faults:9.0f}"
        f"{faults_aim:14}{kept:7.0f} MB",
        flush=True,
    )


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory(prefix="microtexture-bench-") as directory:
        settings = Settings(data_dir=Path(directory), workers=1)
        print(
            f"kernel in a worker ÷ called directly, {settings.threads} threads, RGB; aim; median times; "
            "page faults of the first run, of later ones; memory of the idle worker afterwards"
        )
        with Worker(settings).open() as worker:
            for side in ROUNDS:
                for everything in (False, True):
                    compare(worker, side, settings.threads, everything)


if __name__ == "__main__":
    main()

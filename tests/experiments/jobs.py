"""Jobs without a service: a store, files and one small sample, as tests of a worker's side need them."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from app.experiments.model import DEEP, Experiment, ExperimentInput, Lease
from app.experiments.run import run_job
from app.images.crop import Rectangle
from app.images.png_writer import encode_png
from app.methods.registry import METHODS
from app.store.blobs import FileBlobs
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.records import a_sample, an_experiment

Breaking = Callable[[BaseException], None]
TIME_LIMIT = 60.0
CROP = Rectangle(2, 3, 20, 16)


def submit(store: SqlStore, blobs: FileBlobs, **values: Any) -> Experiment:
    """Store an experiment of a sample of noise, as it is before a worker begins it."""
    pixels = np.random.default_rng(1).integers(0, 256, (24, 32, 3), dtype=np.uint8)
    sample = replace(a_sample(), width=32, height=24, digest=blobs.put(encode_png(pixels)))
    store.add_sample(sample)
    parameters = METHODS["rpn"].params(width=24, height=18, seed=1).model_dump(mode="json")
    experiment = an_experiment(sample, inputs=(ExperimentInput(sample.id, CROP),), parameters=parameters, **values)
    store.add(experiment)
    return experiment


def lease_of(store: SqlStore, job: str) -> Lease:
    """Lease a job as an engine does; one at 16 bits is queued first."""
    queue = SqlQueue(store.database)
    if DEEP in job:
        queue.enqueue(job, "tests")
    lease = queue.lease("tests", alone=True)
    assert lease is not None
    assert lease.job == job
    return lease


def run_leased(store: SqlStore, blobs: FileBlobs, lease: Lease) -> None:
    """Run a job as a worker does."""
    run_job(store, SqlQueue(store.database), blobs, lease, threads=1, time_limit=TIME_LIMIT)


def run(store: SqlStore, blobs: FileBlobs, job: str) -> None:
    """Lease a job and run it."""
    run_leased(store, blobs, lease_of(store, job))


def waits(store: SqlStore, job: str) -> bool:
    """Whether a job is in the queue, or runs."""
    return job in SqlQueue(store.database).states([job])


def left_over(blobs: FileBlobs) -> list[Path]:
    """Temporary files that are still there."""
    return list(blobs.temporary_directory.iterdir())

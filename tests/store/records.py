"""Samples, experiments and outputs to put into a store."""

from dataclasses import replace
from datetime import UTC, datetime
from itertools import count
from typing import Any

from app.experiments.model import DEEP, Experiment, ExperimentInput, Lease, Output, Sample
from app.images.crop import Rectangle
from app.store.queue import SqlQueue
from app.store.sql import SqlStore

START = datetime(2026, 3, 1, 12, 0, 0, 123456, tzinfo=UTC)
NUMBERS = count()
MEASURED = {"structure": {"inputs": [0.01], "outputs": [-0.002]}, "facts": [{"name": "radius", "value": 3.5}]}
COMPUTED = {"version": "1", "cpu": "a processor (X86_V3)", "numpy": "2", "scipy": "1"}


def a_sample(**values: Any) -> Sample:
    number = next(NUMBERS)
    sample = Sample(640, 427, 3, 8, False, id=f"sample{number}", digest=f"{number:064x}", created_at=START)
    return replace(sample, **values)


def an_experiment(sample: Sample, **values: Any) -> Experiment:
    number = next(NUMBERS)
    inputs = (ExperimentInput(sample.id, Rectangle(1, 2, 30, 40)),)
    parameters = {"width": 64, "height": 32, "seed": 2**53 - 1, "alpha": 0.1, "window": "bump", "σ": None}
    experiment = Experiment(f"experiment{number}", "rpn", inputs, parameters, True, "0wner", START)
    return replace(experiment, **values)


def an_output(name: str = "texture", **values: Any) -> Output:
    return replace(Output(name, "Texture", 64, 32, bytes=5 << 30, digest=f"{next(NUMBERS):064x}"), **values)


def lease_of(store: SqlStore, job: str) -> Lease:
    """Lease this job, whatever waits before it; an output at 16 bits is queued first."""
    queue, others = SqlQueue(store.database), list[Lease]()
    if DEEP in job:
        queue.enqueue(job, "tests")
    try:
        while (lease := queue.lease("tests", alone=True)) is not None:
            if lease.job == job:
                return lease
            others.append(lease)
    finally:
        for other in others:
            queue.release(other)
    raise AssertionError(f"{job} does not wait")


def started(store: SqlStore, experiment: Experiment) -> Lease:
    """Lease and start an experiment that waits."""
    lease = lease_of(store, experiment.id)
    assert store.start(lease) is not None
    return lease


def succeeded(store: SqlStore, sample: Sample, **values: Any) -> Experiment:
    experiment = an_experiment(sample, **values)
    store.add(experiment)
    lease = started(store, experiment)
    made = [an_output(kind="texture"), an_output("crop"), an_output(".thumbnail-crop")]
    store.succeed(lease, made, {"b": 0.5, "a": 0.25}, MEASURED, COMPUTED)
    return store.get(experiment.id)

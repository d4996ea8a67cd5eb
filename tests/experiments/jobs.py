"""Jobs without a service: a store, files and one small sample, as tests of a worker's side need them."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from app.experiments.model import Experiment, ExperimentInput
from app.images.crop import Rectangle
from app.images.png_writer import encode_png
from app.methods.registry import METHODS
from app.store.blobs import FileBlobs
from app.store.sql import SqlStore
from tests.store.records import a_sample, an_experiment

Breaking = Callable[[BaseException], None]
CROP = Rectangle(2, 3, 20, 16)


def silent(stage: str, fraction: float) -> None:
    """Take progress and do nothing with it."""


def submit(store: SqlStore, blobs: FileBlobs, **values: Any) -> Experiment:
    """Store an experiment of a sample of noise, as it is before a worker begins it."""
    pixels = np.random.default_rng(1).integers(0, 256, (24, 32, 3), dtype=np.uint8)
    sample = replace(a_sample(), width=32, height=24, digest=blobs.put(encode_png(pixels)))
    store.add_sample(sample)
    parameters = METHODS["rpn"].params(width=24, height=18, seed=1).model_dump(mode="json")
    experiment = an_experiment(sample, inputs=(ExperimentInput(sample.id, CROP),), parameters=parameters, **values)
    store.add(experiment)
    return experiment


def left_over(blobs: FileBlobs) -> list[Path]:
    """Temporary files that are still there."""
    return list(blobs.temporary_directory.iterdir())

"""Submitting an experiment and waiting for it, as several tests do."""

import asyncio
from typing import Any

from app.experiments.model import Experiment, Sample
from app.experiments.preparation import NewExperiment, NewInput
from app.experiments.service import Service
from app.images.crop import Rectangle

OWNER = "the owner's token"
SECONDS = 30.0


def a_request(sample: Sample, **parameters: Any) -> NewExperiment:
    return NewExperiment("rpn", (NewInput(sample.id, Rectangle(4, 2, 40, 36)),), parameters)


def finished(service: Service, request: NewExperiment) -> Experiment:
    """Submit and wait."""
    experiment = asyncio.run(service.watching.wait(service.submission.submit(request, OWNER).id, SECONDS))
    assert experiment.status.finished
    return experiment

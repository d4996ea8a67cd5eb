"""What stands on a page for an exhibit that is not finished, in every state that it can be in."""

from dataclasses import replace
from datetime import UTC, datetime
from types import SimpleNamespace
from typing import Any

import pytest

from app.errors import NotFoundError
from app.experiments.model import Experiment, ExperimentInput, Status
from app.images.crop import Rectangle
from app.methods.explanations.model import Exhibit
from app.web.pictures.exhibits import exhibit_pictures

EXHIBIT = Exhibit("rpn", (("gravel", "0,0,32,32"),), show=("texture",))
PREPARED = Experiment(
    id="exhibit",
    method="rpn",
    inputs=(ExperimentInput("gravel", Rectangle(0, 0, 32, 32)),),
    parameters={"width": 64, "height": 48, "seed": 0},
    listed=False,
    owner="",
    created_at=datetime(2026, 1, 1, tzinfo=UTC),
)


def service(stored: Experiment | None, *, making: bool = False, lacks_sample: bool = False) -> Any:
    """A service in which the exhibit's experiment is as it is stored."""

    def prepare(exhibit: Exhibit) -> Experiment:
        if lacks_sample:
            raise NotFoundError("There is no such photograph.")
        return PREPARED

    return SimpleNamespace(exhibition=SimpleNamespace(find=lambda exhibit: stored, prepare=prepare, making=making))


@pytest.mark.parametrize(
    ("status", "error", "state"),
    [
        (Status.QUEUED, None, "Being made"),
        (Status.RUNNING, None, "Being made"),
        (Status.FAILED, "The crop is too small.", "The crop is too small."),
        (Status.CANCELLED, None, "It was cancelled."),
    ],
)
def test_an_exhibit_that_is_not_finished_says_why_and_leads_to_its_experiment(
    status: Status, error: str | None, state: str
) -> None:
    (texture,) = exhibit_pictures(service(replace(PREPARED, status=status, error=error), making=True), EXHIBIT)
    assert (texture.state, texture.page, texture.url) == (state, "/experiments/exhibit", "")
    assert (texture.width, texture.height) == (64, 48)


@pytest.mark.parametrize(("making", "state"), [(True, "Being made"), (False, "Not made yet")])
def test_one_that_nobody_has_begun_leads_nowhere(making: bool, state: str) -> None:
    (texture,) = exhibit_pictures(service(None, making=making), EXHIBIT)
    assert (texture.state, texture.page) == (state, "")
    assert texture.change.startswith("/samples/gravel?method=rpn&crop.x=0")


def test_one_whose_sample_is_not_there_says_so() -> None:
    (texture,) = exhibit_pictures(service(None, lacks_sample=True), EXHIBIT)
    assert (texture.state, texture.page, texture.change) == ("Sample not available yet", "", "")

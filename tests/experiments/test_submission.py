"""From a request of several inputs to a complete experiment."""

from datetime import UTC, datetime
from typing import Any

import pytest

from app.errors import InvalidInputError, TooLargeError
from app.experiments.model import Experiment, Sample
from app.experiments.submission import Allowed, NewExperiment, NewInput, prepare
from app.images.crop import Rectangle

SAMPLES = {
    name: Sample(name, "", width, height, channels, 8, False, datetime(2026, 3, 1, tzinfo=UTC))
    for name, (width, height, channels) in {"sand": (300, 200, 3), "wall": (120, 260, 1), "moss": (90, 80, 3)}.items()
}


def prepared(method: str, *names: str, crop: Rectangle | None = None, **parameters: Any) -> Experiment:
    inputs = tuple(NewInput(name, crop if place == len(names) - 1 else None) for place, name in enumerate(names))
    return prepare(
        NewExperiment(method, inputs, parameters),
        "owner",
        sample=SAMPLES.__getitem__,
        transparent=lambda sample, crop, frames: False,
        allowed=Allowed(1 << 20, 1 << 24, 1 << 30),
    )


@pytest.mark.parametrize("names", [("sand", "wall"), ("sand", "wall", "moss"), ("sand", "wall", "moss", "sand")])
def test_a_method_takes_as_many_inputs_as_it_declares(names: tuple[str, ...]) -> None:
    """Each with a crop of its own, the whole sample where none is named; the first one's size is the texture's."""
    experiment = prepared("mix", *names, crop=Rectangle(1, 2, 64, 32))
    assert [item.sample for item in experiment.inputs] == list(names)
    assert experiment.inputs[0].crop == Rectangle(0, 0, 300, 200)
    assert experiment.inputs[-1].crop == Rectangle(1, 2, 64, 32)
    assert (experiment.parameters["width"], experiment.parameters["height"]) == (300, 200)


@pytest.mark.parametrize(("method", "count", "wanted"), [("mix", 1, "2 to 4"), ("mix", 5, "2 to 4"), ("rpn", 2, "1")])
def test_too_few_or_too_many_inputs_are_refused_with_the_number_it_takes(method: str, count: int, wanted: str) -> None:
    with pytest.raises(InvalidInputError, match=f"takes {wanted} input") as refused:
        prepared(method, *["sand"] * count)
    assert refused.value.field == "inputs"


def test_the_crop_at_fault_is_named() -> None:
    with pytest.raises(InvalidInputError) as refused:
        prepared("mix", "sand", "moss", crop=Rectangle(50, 0, 64, 32))
    assert refused.value.field == "inputs.1.crop"


def test_a_method_may_choose_another_size_than_the_first_crops() -> None:
    """Swapping modulus and phase needs images of one size: what both have."""
    experiment = prepared("modulus-phase", "sand", "wall")
    assert (experiment.parameters["width"], experiment.parameters["height"]) == (120, 200)


@pytest.mark.parametrize(("method", "fits"), [("rpn", True), ("mix", False), ("dsn", False), ("texton", False)])
def test_a_texture_that_a_method_could_not_hold_in_memory_is_refused(method: str, fits: bool) -> None:
    """The service allows 67 megapixels, which RPN makes by blocks; others hold pictures of that size."""

    def large() -> Experiment:
        inputs = (NewInput("sand"),) * (2 if method == "mix" else 1)
        return prepare(
            NewExperiment(method, inputs, {"width": 8192, "height": 8192}),
            "owner",
            sample=SAMPLES.__getitem__,
            transparent=lambda sample, crop, frames: False,
            allowed=Allowed(1 << 26, 1 << 26, 1 << 30),
        )

    if fits:
        assert large().parameters["width"] == 8192
    else:
        with pytest.raises(TooLargeError, match=f"the method {method} makes at most 17"):
            large()

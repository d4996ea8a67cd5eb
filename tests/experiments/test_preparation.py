"""From a request of several inputs to a complete experiment."""

from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import pytest

from app.errors import InvalidInputError, TooLargeError
from app.experiments.model import Experiment, Sample
from app.experiments.preparation import NewExperiment, NewInput, memory_of, prepare
from app.images.crop import Frames, Rectangle
from app.methods.allowed import Allowed

SAMPLES = {
    name: Sample(width, height, channels, 8, False, id=name, digest="", created_at=datetime(2026, 3, 1, tzinfo=UTC))
    for name, (width, height, channels) in {"sand": (300, 200, 3), "wall": (120, 260, 1), "moss": (90, 80, 3)}.items()
}


ALLOWED = Allowed(1 << 20, 1 << 24, 1 << 30)


def prepared(method: str, *names: str, crop: Rectangle | None = None, **parameters: Any) -> Experiment:
    inputs = tuple(NewInput(name, crop if place == len(names) - 1 else None) for place, name in enumerate(names))
    return prepare(
        NewExperiment(method, inputs, parameters),
        "owner",
        sample=SAMPLES.__getitem__,
        transparent=lambda sample, crop, frames: False,
        allowed=ALLOWED,
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
    with pytest.raises(InvalidInputError, match="The crop 50,0,64,32 reaches outside the photograph, which") as refused:
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


CLIPS = {
    "sea": replace(SAMPLES["sand"], id="sea", width=64, height=48, frames=30, rate=15.0),
    "still": SAMPLES["moss"],
}


def filmed(
    method: str, name: str, time: Frames | None = None, allowed: Allowed = ALLOWED, **parameters: Any
) -> Experiment:
    return prepare(
        NewExperiment(method, (NewInput(name, None, time),), parameters),
        "owner",
        sample=CLIPS.__getitem__,
        transparent=lambda sample, crop, frames: False,
        allowed=allowed,
    )


def test_a_clip_is_taken_whole_or_in_part_and_the_video_is_as_long() -> None:
    whole, part = filmed("video-rpn", "sea"), filmed("video-rpn", "sea", Frames(5, 12))
    assert (whole.inputs[0].frames, whole.parameters["frames"]) == (Frames(0, 30), 30)
    assert (part.inputs[0].frames, part.parameters["frames"]) == (Frames(5, 12), 12)
    assert filmed("video-rpn", "sea", frames=40).parameters["frames"] == 40


def test_a_still_method_takes_one_frame_of_a_clip() -> None:
    assert filmed("rpn", "sea").inputs[0].frames == Frames(0, 1)
    assert filmed("rpn", "sea", Frames(7, 1)).inputs[0].frames == Frames(7, 1)


@pytest.mark.parametrize(
    ("method", "name", "frames", "field", "words"),
    [
        ("video-rpn", "still", None, "inputs.0.sample", "upload an MP4"),
        ("video-rpn", "sea", Frames(20, 11), "inputs.0.frames", "reaches outside the sample, which has 30 frames"),
        ("video-rpn", "sea", Frames(0, 0), "inputs.0.frames", "at least 1 frame"),
        ("video-rpn", "sea", Frames(3, 1), "inputs.0.frames", "at least 2 frames"),
        ("rpn", "sea", Frames(0, 2), "inputs.0.frames", "give a time range of 1 frame"),
        ("rpn", "still", Frames(1, 1), "inputs.0.frames", "which has 1 frame "),
    ],
)
def test_a_time_range_that_cannot_be_is_refused_where_it_stands(
    method: str, name: str, frames: Frames | None, field: str, words: str
) -> None:
    with pytest.raises(InvalidInputError, match=words) as refused:
        filmed(method, name, frames)
    assert refused.value.field == field


def test_a_video_of_too_many_pixels_or_bytes_is_refused_before_it_is_queued() -> None:
    """A frame may be as large as a picture; all of them together, and the memory they take, have limits too."""
    pixels = 64 * 48 * 30
    assert filmed("video-rpn", "sea", allowed=replace(ALLOWED, video_pixels=pixels))
    with pytest.raises(TooLargeError, match=r"30 frames of 64 × 48 .* ask for fewer frames"):
        filmed("video-rpn", "sea", allowed=replace(ALLOWED, video_pixels=pixels - 1))
    needed = memory_of(filmed("video-rpn", "sea"), CLIPS.__getitem__)
    assert filmed("video-rpn", "sea", allowed=replace(ALLOWED, memory=needed))
    with pytest.raises(TooLargeError, match=r"would need about .* MB of memory.*shorter or smaller crop"):
        filmed("video-rpn", "sea", allowed=replace(ALLOWED, memory=needed - 1))

"""What the page of an experiment says beside its pictures and films, also of experiments of the first version."""

from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import pytest

from app.experiments.model import Experiment, ExperimentInput, Output
from app.images.crop import Rectangle
from app.web.pictures.panes import (
    crop_panes,
    describe_looping,
    describe_tiling,
    facts,
    gallery,
    input_titles,
    steps,
    texture_pane,
)
from tests.web.versions import without_versions


def output(name: str, kind: Any = "view") -> Output:
    return Output(name, name.capitalize(), 8, 6, kind=kind, bytes=100, digest="0" * 64)


OLD = Experiment(
    id="old",
    method="rpn",
    inputs=(ExperimentInput("gravel", Rectangle(0, 0, 8, 6)),),
    parameters={"width": 8, "height": 6, "seed": 0},
    listed=True,
    owner="",
    created_at=datetime(2026, 1, 1, tzinfo=UTC),
    outputs=(output("texture"), output("crop"), output("spot"), output(".texture-deep", "texture")),
)


def film(name: str, form: str, kind: Any = "view", frames: int = 12) -> Output:
    return replace(output(name, kind), media_type=form, frames=frames, rate=24.0)


MOVING = replace(
    OLD,
    outputs=(
        film("texture", "video/webm", "texture"),
        film("texture-mp4", "video/mp4"),
        film("preview", "image/webp"),
        output("cube"),
        output("cells"),
        film("crop", "video/webm", frames=9),
        film("crop-mp4", "video/mp4", frames=9),
        output("crop-cube"),
    ),
)


def fact(about: str, title: str, value: float = 1.0, unit: str = "") -> dict[str, Any]:
    return {"output": about, "name": title.lower(), "title": title, "value": value, "unit": unit}


def test_an_experiment_of_the_first_version_has_its_pictures_and_no_numbers() -> None:
    """Its outputs have no kind and nothing was measured."""
    assert [(pane.title, pane.measured) for pane in [*crop_panes(OLD), texture_pane(OLD)]] == [
        ("Sample", False),
        ("RPN", False),
    ]
    assert gallery(OLD) == []
    assert [pane.title for pane in steps(OLD)] == ["Texture", "Crop", "Spot"]
    assert list(facts(OLD)) == []


def test_each_texture_has_its_own_index() -> None:
    """They are in the order of the textures among the outputs, whatever stands between."""
    outputs = (output("texture", "texture"), output("crop"), output("n-10", "texture"), output("n-100", "texture"))
    measured = {"structure": {"inputs": [0.3], "outputs": [0.01, 0.02, 0.03]}}
    made = replace(OLD, outputs=outputs, diagnostics=measured)
    assert texture_pane(made).delta == 0.01
    assert [(pane.title, pane.delta) for pane in gallery(made)] == [("N-10", 0.02), ("N-100", 0.03)]
    assert [pane.delta for pane in crop_panes(made)] == [0.3]
    assert all(pane.measured for pane in [*crop_panes(made), *gallery(made)])


def test_what_was_too_small_to_tell_was_measured_all_the_same() -> None:
    outputs = (output("texture", "texture"), output("crop"), output("n-10", "texture"))
    made = replace(OLD, outputs=outputs, diagnostics={"structure": {"inputs": [None], "outputs": [None, 0.2]}})
    assert [(pane.measured, pane.delta) for pane in [*crop_panes(made), texture_pane(made)]] == [(True, None)] * 2
    assert [(pane.measured, pane.delta) for pane in gallery(made)] == [(True, 0.2)]


def test_facts_name_their_picture_only_where_they_would_be_mistaken() -> None:
    found = [fact("spot", "Radius", 12.0, "pixels"), fact("crop", "Share", 0.5), fact("texture", "Share", 0.25)]
    made = replace(OLD, diagnostics={"facts": found})
    assert list(facts(made)) == [("Radius", "12 pixels"), ("Crop: share", "0.5"), ("Texture: share", "0.25")]


@pytest.mark.parametrize(
    ("seamless", "words"),
    [
        ([True], "The texture is toroidal"),
        ([False], "edges of this texture do not meet"),
        ([True, True], "These textures are toroidal"),
        ([False, True], "Only one of the two"),
        ([False, False], "edges of these textures do not meet"),
    ],
)
def test_whether_textures_tile_is_said_of_one_and_of_two(seamless: list[bool], words: str) -> None:
    assert words in describe_tiling(seamless)


def test_films_are_offered_as_webm_first_and_as_mp4_besides() -> None:
    """With the poster that is shown until they are there, and what a clock of frames must know."""
    crop, texture = (pane.video for pane in (crop_panes(MOVING)[0], texture_pane(MOVING)))
    address = "/api/v1/experiments/old/outputs"
    assert crop is not None
    assert [(without_versions(where), media_type) for where, media_type in crop.sources] == [
        (f"{address}/crop", "video/webm"),
        (f"{address}/crop-mp4", "video/mp4"),
    ]
    assert (without_versions(crop.poster), crop.frames, crop.rate) == (f"{address}/.poster-crop", 9, 24.0)
    assert texture is not None
    assert (without_versions(texture.poster), texture.frames) == (f"{address}/.poster-texture", 12)
    assert texture_pane(OLD).video is None


def test_the_steps_of_a_film_are_stills_and_begin_with_both_cubes() -> None:
    """What plays is in the player already."""
    assert [pane.title for pane in steps(MOVING)] == ["Crop-cube", "Cube", "Cells"]


@pytest.mark.parametrize(
    ("loops", "words"),
    [
        ([True], "Its last frame continues in the first"),
        ([False], "It does not loop"),
        ([True, True], "Their last frames continue"),
        ([True, False], "Only one of them loops"),
        ([False, False], "They do not loop"),
    ],
)
def test_whether_films_loop_is_said_of_one_and_of_two(loops: list[bool], words: str) -> None:
    assert words in describe_looping(loops)


def test_nothing_is_said_of_loops_where_nothing_moves() -> None:
    assert describe_looping([]) == ""


@pytest.mark.parametrize(
    ("method", "titles", "beside"),
    [
        ("rpn", ["Sample"], ["Other sample"]),
        ("mix", ["First sample", "Second sample"], ["First other sample", "Second other sample"]),
        ("modulus-phase", ["Modulus", "Phase"], ["Other modulus", "Other phase"]),
    ],
)
def test_inputs_are_named_by_their_part_in_the_method_where_they_have_one(
    method: str, titles: list[str], beside: list[str]
) -> None:
    """Those of a mixture are all alike."""
    made = replace(OLD, method=method, inputs=OLD.inputs * len(titles))
    assert input_titles(made) == titles
    assert input_titles(made, other=True) == beside

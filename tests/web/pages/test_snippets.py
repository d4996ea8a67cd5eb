"""The snippets of every method say what the experiment is, in three languages, and run."""

import ast
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from datetime import UTC, datetime
from itertools import cycle
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from app.cli.commands import application
from app.experiments.model import Experiment, ExperimentInput
from app.images.crop import Frames, Rectangle
from app.methods.effects import without_effect
from app.methods.fields import FormField, fields
from app.methods.model import Method, Size
from app.methods.registry import METHODS
from app.web.pages.snippets import WIDTH, snippets
from tests.methods.runs import SMALL

BASE = "https://texture.example.org"
EVERY = pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
# Every length that a text may have, so that wherever a line is broken, some text lies across the break.
WEIGHTS = [", ".join(["0.25"] * count) for count in range(1, 17)] + ["0,5; 0,5", "1e-3,1" + " " * 80 + ",1"]


def others(field: FormField) -> list[Any]:
    """Values of a parameter beside its default."""
    match field.kind:
        case "switch":
            return [field.default != "on"]
        case "choice":
            return [choice for choice in field.choices if choice != field.default]
        case "integer":
            return [int(field.minimum), int(field.maximum)]
        case "number":
            return [float(field.minimum), float(field.maximum) / 3, float(field.maximum)]
    return [""]


def experiments(method: Method) -> Iterator[Experiment]:
    """One with each value of each parameter, one with all of them at once, and those with texts of any length."""
    usual = {**method.params().model_dump(mode="json"), "width": 640, "height": 48}
    usual |= {"frames": 60} if method.moving else {}
    changes = [{field.name: value} for field in fields(method.params) for value in others(field)]
    changes.append({field.name: others(field)[-1] for field in fields(method.params)})
    changes += [{"weights": weights} for weights in WEIGHTS if "weights" in usual]
    crops = [Rectangle(10 * number, 0, 512, 384) for number in range(len(method.inputs) + method.more)]
    for place, change in enumerate(changes):
        count = len(method.inputs) + (method.more if place % 2 else 0)
        slots = [method.slot(index) for index in range(count)]
        inputs = tuple(
            ExperimentInput(f"sample-{index % 2}", crop, Frames(3, 48) if slot.moving else Frames(index % 2, 1))
            for index, (crop, slot) in enumerate(zip(crops, slots, strict=False))
        )
        yield Experiment("id", method.name, inputs, {**usual, **change}, True, "", datetime.now(UTC))


def without_texture(experiment: Experiment) -> set[str]:
    """The parameters that change nothing of the texture."""
    method = METHODS[experiment.method]
    sizes = [Size(source.crop.width, source.crop.height, 3, source.frames.count) for source in experiment.inputs]
    params = method.params.model_construct(**experiment.parameters)
    return set(without_effect(method, sizes, params, experiment.parameters.keys(), ["texture"]))


def texts(experiment: Experiment, base: str = BASE) -> dict[str, str]:
    return dict(snippets(experiment, base))


@EVERY
def test_the_python_snippet_is_python_and_asks_for_the_experiment(method: Method) -> None:
    for experiment in experiments(method):
        tree = ast.parse(texts(experiment)["Python"])
        request = next(node for node in tree.body if isinstance(node, ast.Assign))
        asked = ast.literal_eval(request.value)
        assert asked["method"] == method.name
        given = {name: value for name, value in experiment.parameters.items() if value is not None}
        assert asked["parameters"] == given
        for said, source in zip(asked["inputs"], experiment.inputs, strict=True):
            assert said["sample"] == source.sample
            assert Rectangle(**said["crop"]) == source.crop
            assert Frames(**said.get("frames", {})) == source.frames


@EVERY
def test_the_curl_snippet_sends_every_parameter_of_the_texture(method: Method) -> None:
    """What changes nothing of the texture would be refused beside it; by default values nothing is left out."""
    for experiment in experiments(method):
        *_, line = texts(experiment)["curl"].replace("\\\n", "").strip().split("\n")
        words = shlex.split(line)
        sent = dict(
            words[place + 1].split("=", 1) for place, word in enumerate(words) if word in ("-F", "--form-string")
        )
        for name, value in experiment.parameters.items():
            if name not in sent:
                assert value is None or name in without_texture(experiment)
            else:
                assert name not in without_texture(experiment)
                assert sent[name] == (str(value).lower() if isinstance(value, bool) else str(value))
        crops = [sent[name] for name in sent if name.startswith("crop")]
        assert crops == [str(source.crop) for source in experiment.inputs]


@pytest.mark.slow
@EVERY
def test_the_command_line_takes_the_options_of_its_snippet(method: Method) -> None:
    """What it then says is missing are the files."""
    for experiment in experiments(method):
        *_, line = texts(experiment)["Command line"].replace("\\\n", "").strip().split("\n")
        program, *words = shlex.split(line)
        assert program == "microtexture"
        done = CliRunner().invoke(application(with_method_options=True), words)
        assert (done.exit_code, done.stderr) == (2, f"microtexture: There is no file {words[1]}.\n")


def run_snippet(site: Any, record: dict[str, Any], language: str, directory: Path) -> None:
    """Run it as it stands; it writes the texture of the experiment."""
    text = texts(site.service.experiments.get(record["id"]), site.url)[language]
    command = [sys.executable, "-c", text] if language == "Python" else ["bash", "-euc", text]
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path}
    done = subprocess.run(
        command, cwd=directory, env=environment, check=False, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    (made,) = directory.glob("texture.*")
    assert made.read_bytes() == site.client.get(f"{record['url']}/outputs/texture").content


def inputs_at(*samples: str) -> list[dict[str, Any]]:
    return [
        {"sample": sample, "crop": {"x": place, "y": 0, "width": 44, "height": 40}}
        for place, sample in enumerate(samples)
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "language"), list(zip(METHODS.values(), cycle(("Python", "curl", "Command line")))), ids=METHODS
)
def test_a_snippet_of_every_method_runs(site: Any, clip: str, tmp_path: Path, method: Method, language: str) -> None:
    samples = [clip if slot.moving else "gravel_gray" for slot in method.inputs]
    parameters = {"seed": 5, **SMALL.get(method.name, {})}
    parameters |= {"grid": 6} if "grid" in parameters else {}
    record = site.finished(method=method.name, inputs=inputs_at(*samples), parameters=parameters)
    run_snippet(site, record, language, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("language", ["curl", "Command line", "Python"])
def test_a_snippet_with_a_text_runs_in_every_language(site: Any, tmp_path: Path, language: str) -> None:
    parameters = {"weights": "0.25, 0.5 ,0.25", "strip": 0, "width": 50}
    record = site.finished(method="mix", inputs=inputs_at(*["gravel_gray"] * 3), parameters=parameters)
    run_snippet(site, record, language, tmp_path)


@EVERY
def test_a_command_is_broken_only_where_the_next_field_would_not_fit(method: Method) -> None:
    """So that it is read without scrolling, and takes no more lines than it needs."""
    broken = 0
    for experiment in experiments(method):
        text = snippets(experiment, BASE)[0][1]
        lines = [line.removesuffix(" \\") for line in text[text.rindex("curl ") :].splitlines()]
        fields_of = [re.split(r" (?=-F |--form-string |'?https?://)", line.strip()) for line in lines]
        for line, words in zip(lines, fields_of, strict=True):
            assert len(words) == 1 or len(line) <= WIDTH
        for line, (first, *_) in zip(lines, fields_of[1:], strict=False):
            assert len(line) + len(first) >= WIDTH
        broken += len(lines) > 1
    assert broken

"""Code snippets of an experiment: the same run with curl, on the command line and in Python."""

import json
import shlex
from typing import Any

from app.experiments.model import Experiment
from app.images.crop import Frames
from app.methods.effects import without_effect
from app.methods.model import Size
from app.methods.registry import METHODS

WIDTH = 76  # characters of a line
SHORT = 60  # characters of a Python value that stays on its line, behind its name
INDENT = 4 * " "


def snippets(experiment: Experiment, base_url: str) -> tuple[tuple[str, str], ...]:
    """Write an experiment in three ways that give the same bytes when pasted, as (title, text).

    The same to the byte with this version, on any processor with AVX2: see docs/architecture.md.

    Parameters
    ----------
    experiment : Experiment
    base_url : str
        The service's public address, without a slash at its end.
    """
    files = _name_files(experiment)
    fetch = "".join(
        f"curl -fsS -o {name} {shlex.quote(f'{base_url}/api/v1/samples/{address}')}\n"
        for address, name in files.items()
    )
    return (
        ("curl", fetch + _curl(experiment, base_url, files)),
        ("Command line", fetch + _command(experiment, files)),
        ("Python", _python(experiment, base_url)),
    )


def _addresses(experiment: Experiment) -> list[str]:
    """Where the exact pixels of each input's sample are: all of a clip, or one picture."""
    method = METHODS[experiment.method]
    addresses = []
    for index, source in enumerate(experiment.inputs):
        if method.slot(index).moving:
            addresses.append(f"{source.sample}/video?format=webm")
        elif source.frames.first:
            addresses.append(f"{source.sample}/image?frame={source.frames.first}")
        else:
            addresses.append(f"{source.sample}/image")
    return addresses


def _name_files(experiment: Experiment) -> dict[str, str]:
    """Name a file for each sample, by its address; a sample of which there are two crops is fetched once."""
    suffixes = {address: ".webm" if "/video" in address else ".png" for address in _addresses(experiment)}
    return {
        address: f"sample{suffix}" if number == 1 else f"sample-{number}{suffix}"
        for number, (address, suffix) in enumerate(suffixes.items(), 1)
    }


def _texture(experiment: Experiment) -> str:
    return "texture.webm" if METHODS[experiment.method].moving else "texture.png"


def _without_none(parameters: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in parameters.items() if value is not None}


def _texture_parameters(experiment: Experiment) -> dict[str, Any]:
    """The parameters without those that change nothing of the texture, which is all that is asked for."""
    method, parameters = METHODS[experiment.method], dict(experiment.parameters)
    sizes = [Size(source.crop.width, source.crop.height, 3, source.frames.count) for source in experiment.inputs]
    # Not validated: an old experiment's parameters may be none that a later version takes.
    params = method.params.model_construct(**parameters)
    idle = without_effect(method, sizes, params, parameters.keys(), ["texture"])
    return {name: value for name, value in _without_none(parameters).items() if name not in idle}


def _form_text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _field(name: str, value: str) -> str:
    """One field for curl, which reads more than a text into a ``;``, unless told not to."""
    option = "--form-string" if ";" in value else "-F"
    return f"{option} {shlex.quote(f'{name}={value}')}"


def _curl(experiment: Experiment, base_url: str, files: dict[str, str]) -> str:
    entries: dict[str, Any] = {"method": experiment.method}
    method = METHODS[experiment.method]
    for index, (source, sample) in enumerate(zip(experiment.inputs, _addresses(experiment), strict=True)):
        suffix = f"-{index + 1}" if index else ""
        entries |= {f"file{suffix}": f"@{files[sample]}", f"crop{suffix}": source.crop}
        if method.slot(index).moving:
            entries[f"time{suffix}"] = source.frames
    entries |= _texture_parameters(experiment)
    words = [_field(name, _form_text(value)) for name, value in entries.items()]
    address = shlex.quote(f"{base_url}/api/v1/synthesize")
    return _wrap([f"curl -fsS -o {_texture(experiment)}", address, *words])


def _command(experiment: Experiment, files: dict[str, str]) -> str:
    parameters = _texture_parameters(experiment)
    size = f"{parameters.pop('width')}x{parameters.pop('height')}"
    names = " ".join(files[address] for address in _addresses(experiment))
    words = [f"microtexture synthesize {names} {_texture(experiment)}", f"--method {experiment.method}"]
    words += [f"--crop {source.crop}" for source in experiment.inputs]
    moving = [METHODS[experiment.method].slot(index).moving for index in range(len(experiment.inputs))]
    if any(moving):  # a still input's file has one frame
        times = [source.frames if moves else Frames() for source, moves in zip(experiment.inputs, moving, strict=True)]
        words += [f"--time {frames}" for frames in times]
    words.append(f"--size {size}")
    for name, value in parameters.items():
        option = name.replace("_", "-")
        if isinstance(value, bool):
            words.append(f"--{option}" if value else f"--no-{option}")
        else:
            words.append(f"--{option} {shlex.quote(str(value))}")
    return _wrap(words)


def _wrap(words: list[str]) -> str:
    lines = [words[0]]
    for word in words[1:]:
        if len(lines[-1]) + len(word) < WIDTH:
            lines[-1] += f" {word}"
        else:
            lines.append(f"  {word}")
    return " \\\n".join(lines)


def _python(experiment: Experiment, base_url: str) -> str:
    moving = METHODS[experiment.method].moving
    inputs: list[dict[str, Any]] = []
    for source in experiment.inputs:
        inputs.append({"sample": source.sample, "crop": vars(source.crop)})
        if moving or source.frames.first:
            inputs[-1]["frames"] = vars(source.frames)
    parameters = _without_none(dict(experiment.parameters))
    request = {"method": experiment.method, "inputs": inputs, "parameters": parameters, "listed": False}
    return f"""import time

import httpx

request = {_literal(request)}
with httpx.Client(base_url={_literal(base_url)}, timeout=60) as service:
    answer = service.post(
        "/api/v1/experiments", json=request, headers={{"Prefer": "wait=30"}}
    )
    experiment = answer.raise_for_status().json()
    address = f"/api/v1/experiments/{{experiment['id']}}"
    while experiment["status"] in ("queued", "running"):
        time.sleep(1)
        experiment = service.get(address).raise_for_status().json()
    texture = service.get(f"{{address}}/outputs/texture").raise_for_status()
with open({_literal(_texture(experiment))}, "wb") as file:
    file.write(texture.content)
"""


def _literal(value: Any, indent: str = "") -> str:
    """Write a value as Python with double quotes: on one line where it fits, else an entry a line."""
    if isinstance(value, dict):
        entries = [f"{_literal(key)}: {_literal(entry, indent + INDENT)}" for key, entry in value.items()]
        brackets = "{}"
    elif isinstance(value, list):
        entries = [_literal(entry, indent + INDENT) for entry in value]
        brackets = "[]"
    else:
        return json.dumps(value) if isinstance(value, str) else repr(value)
    line = ", ".join(entries).join(brackets)
    if "\n" not in line and len(indent) + len(line) < SHORT:
        return line
    lines = "".join(f"{indent}{INDENT}{entry},\n" for entry in entries)
    return f"{brackets[0]}\n{lines}{indent}{brackets[1]}"

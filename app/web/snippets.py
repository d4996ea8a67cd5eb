"""The same run elsewhere: an experiment as curl, as a command line and as Python."""

import json
import shlex
from textwrap import fill
from typing import Any

from app.experiments.model import Experiment

WIDTH = 76  # characters of a line
JOINED = "\N{NO-BREAK SPACE}"  # where no line is broken


def snippets(experiment: Experiment, base_url: str) -> tuple[tuple[str, str], ...]:
    """Write an experiment in three ways that give the same bytes when pasted, as (title, text).

    Parameters
    ----------
    experiment : Experiment
    base_url : str
        The service's public address, without a slash at its end.
    """
    files = _files(experiment)
    fetch = "".join(
        f"curl -fsS -o {name} {shlex.quote(f'{base_url}/api/v1/samples/{sample}/image')}\n"
        for sample, name in files.items()
    )
    return (
        ("curl", fetch + _curl(experiment, base_url, files)),
        ("Command line", fetch + _command(experiment, files)),
        ("Python", _python(experiment, base_url)),
    )


def _files(experiment: Experiment) -> dict[str, str]:
    """Name a file for each sample, by its id; a sample of which there are two crops is fetched once."""
    ids = dict.fromkeys(source.sample for source in experiment.inputs)
    return {sample: "sample.png" if number == 1 else f"sample-{number}.png" for number, sample in enumerate(ids, 1)}


def _said(parameters: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in parameters.items() if value is not None}


def _form(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _curl(experiment: Experiment, base_url: str, files: dict[str, str]) -> str:
    entries: dict[str, Any] = {"method": experiment.method}
    for number, source in enumerate(experiment.inputs, 1):
        suffix = "" if number == 1 else f"-{number}"
        entries |= {f"file{suffix}": f"@{files[source.sample]}", f"crop{suffix}": source.crop}
    entries |= _said(dict(experiment.parameters))
    words = [f"-F {shlex.quote(f'{name}={_form(value)}')}" for name, value in entries.items()]
    address = shlex.quote(f"{base_url}/api/v1/synthesize")
    return _wrapped(["curl -fsS -o texture.png", address, *words])


def _command(experiment: Experiment, files: dict[str, str]) -> str:
    parameters = _said(dict(experiment.parameters))
    size = f"{parameters.pop('width')}x{parameters.pop('height')}"
    names = " ".join(files[source.sample] for source in experiment.inputs)
    words = [f"microtexture synthesize {names} texture.png", f"--method {experiment.method}"]
    words += [f"--crop {source.crop}" for source in experiment.inputs]
    words.append(f"--size {size}")
    for name, value in parameters.items():
        option = name.replace("_", "-")
        if isinstance(value, bool):
            words.append(f"--{option}" if value else f"--no-{option}")
        else:
            words.append(f"--{option} {shlex.quote(str(value))}")
    return _wrapped(words)


def _wrapped(words: list[str]) -> str:
    lines = [words[0]]
    for word in words[1:]:
        if len(lines[-1]) + len(word) < WIDTH:
            lines[-1] += f" {word}"
        else:
            lines.append(f"  {word}")
    return " \\\n".join(lines)


def _python(experiment: Experiment, base_url: str) -> str:
    sources = "".join(
        f'        {{"sample": {_literal(source.sample)},\n         "crop": {_literal(vars(source.crop))}}},\n'
        for source in experiment.inputs
    )
    together = f'"parameters": {_literal(_said(dict(experiment.parameters)))}'.replace(": ", f":{JOINED}")
    parameters = fill(together, WIDTH, initial_indent=" " * 4, subsequent_indent=" " * 8).replace(JOINED, " ")
    return f"""import time

import httpx

request = {{
    "method": {_literal(experiment.method)},
    "inputs": [
{sources}    ],
{parameters},
    "listed": False,
}}
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
with open("texture.png", "wb") as file:
    file.write(texture.content)
"""


def _literal(value: Any) -> str:
    """Write a value as Python with double quotes."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_literal(key)}: {_literal(entry)}" for key, entry in value.items()) + "}"
    return json.dumps(value) if isinstance(value, str) else repr(value)

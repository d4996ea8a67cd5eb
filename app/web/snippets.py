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
    image = f"{base_url}/api/v1/samples/{experiment.inputs[0].sample}/image"
    return (
        ("curl", _curl(experiment, base_url, image)),
        ("Command line", _command(experiment, image)),
        ("Python", _python(experiment, base_url)),
    )


def _said(parameters: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in parameters.items() if value is not None}


def _form(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _curl(experiment: Experiment, base_url: str, image: str) -> str:
    entries = {"method": experiment.method, "crop": experiment.inputs[0].crop, **_said(dict(experiment.parameters))}
    words = [f"-F {shlex.quote(f'{name}={_form(value)}')}" for name, value in entries.items()]
    address = shlex.quote(f"{base_url}/api/v1/synthesize")
    return f"{_fetch(image)}\n" + _wrapped(["curl -fsS -o texture.png", address, "-F file=@sample.png", *words])


def _command(experiment: Experiment, image: str) -> str:
    parameters = _said(dict(experiment.parameters))
    size = f"{parameters.pop('width')}x{parameters.pop('height')}"
    words = ["microtexture synthesize sample.png texture.png", f"--method {experiment.method}"]
    words += [f"--crop {experiment.inputs[0].crop}", f"--size {size}"]
    for name, value in parameters.items():
        option = name.replace("_", "-")
        if isinstance(value, bool):
            words.append(f"--{option}" if value else f"--no-{option}")
        else:
            words.append(f"--{option} {shlex.quote(str(value))}")
    return f"{_fetch(image)}\n{_wrapped(words)}"


def _fetch(image: str) -> str:
    return f"curl -fsS -o sample.png {shlex.quote(image)}"


def _wrapped(words: list[str]) -> str:
    lines = [words[0]]
    for word in words[1:]:
        if len(lines[-1]) + len(word) < WIDTH:
            lines[-1] += f" {word}"
        else:
            lines.append(f"  {word}")
    return " \\\n".join(lines)


def _python(experiment: Experiment, base_url: str) -> str:
    crop = experiment.inputs[0].crop
    rectangle = {"x": crop.x, "y": crop.y, "width": crop.width, "height": crop.height}
    source = f'{{"sample": {_literal(experiment.inputs[0].sample)},\n      "crop": {_literal(rectangle)}}}'
    together = f'"parameters": {_literal(_said(dict(experiment.parameters)))}'.replace(": ", f":{JOINED}")
    parameters = fill(together, WIDTH, initial_indent=" " * 4, subsequent_indent=" " * 8).replace(JOINED, " ")
    return f"""import time

import httpx

request = {{
    "method": {_literal(experiment.method)},
    "inputs": [
        {source.replace("      ", " " * 9)}
    ],
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

"""The same run elsewhere: an experiment as curl, as a command line and as Python."""

import shlex
from pprint import pformat
from typing import Any

from app.experiments.model import Experiment


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
    lines = [
        f"curl -fsS -o sample.png {shlex.quote(image)}",
        f"curl -fsS -o texture.png {shlex.quote(base_url + '/api/v1/synthesize')}",
        "  -F file=@sample.png",
        *(f"  -F {shlex.quote(f'{name}={_form(value)}')}" for name, value in entries.items()),
    ]
    return lines[0] + "\n" + " \\\n".join(lines[1:])


def _command(experiment: Experiment, image: str) -> str:
    parameters = _said(dict(experiment.parameters))
    size = f"{parameters.pop('width')}x{parameters.pop('height')}"
    words = [
        "microtexture synthesize sample.png texture.png",
        f"--method {experiment.method}",
        f"--crop {experiment.inputs[0].crop}",
        f"--size {size}",
    ]
    for name, value in parameters.items():
        option = name.replace("_", "-")
        if isinstance(value, bool):
            words.append(f"--{option}" if value else f"--no-{option}")
        else:
            words.append(f"--{option} {shlex.quote(str(value))}")
    return f"curl -fsS -o sample.png {shlex.quote(image)}\n" + " \\\n  ".join(words)


def _python(experiment: Experiment, base_url: str) -> str:
    crop = experiment.inputs[0].crop
    body = {
        "method": experiment.method,
        "inputs": [
            {
                "sample": experiment.inputs[0].sample,
                "crop": {"x": crop.x, "y": crop.y, "width": crop.width, "height": crop.height},
            }
        ],
        "parameters": _said(dict(experiment.parameters)),
        "listed": False,
    }
    written = pformat(body, width=90, sort_dicts=False).replace("\n", "\n" + " " * 14)
    return f"""import time

import httpx

with httpx.Client(base_url={base_url!r}, timeout=60) as service:
    request = {written}
    answer = service.post("/api/v1/experiments", headers={{"Prefer": "wait=30"}}, json=request)
    experiment = answer.raise_for_status().json()
    while experiment["status"] in {{"queued", "running"}}:
        time.sleep(1)
        experiment = service.get(f"/api/v1/experiments/{{experiment['id']}}").json()
    texture = service.get(f"/api/v1/experiments/{{experiment['id']}}/outputs/texture")
    with open("texture.png", "wb") as file:
        file.write(texture.raise_for_status().content)
"""

"""Command line in this process: what every test of it types."""

from pathlib import Path

import numpy as np
from PIL import Image
from typer.testing import CliRunner, Result

from app.cli.commands import application
from app.settings import ROOT

SAND = ROOT / "samples" / "sand_desert009.png"
WATER = ROOT / "samples" / "sand_under_water.mp4"
CHINA = ROOT / "samples" / "scene_china.jpg"


def microtexture(*arguments: str | Path) -> Result:
    return CliRunner().invoke(application(with_method_options=True), [str(argument) for argument in arguments])


def synthesize(*arguments: str | Path) -> Result:
    return microtexture("synthesize", *arguments)


def pixels(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)

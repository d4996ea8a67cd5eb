"""Diagnostics of an experiment: the structure index of its crops and textures, and the facts its method found."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from app.images.crop import Rectangle, crop_to_centre
from app.images.read import read_crop
from app.images.video.reader import read_first_frame
from app.methods.context import Progress
from app.methods.model import Picture, Source
from app.synthesis.arrays import Real
from app.synthesis.structure import measure_delta

DIGITS = 6  # of a number in the record


def diagnose(sources: Sequence[Source], staged: Sequence[tuple[Picture, Path]], progress: Progress) -> dict[str, Any]:
    """Measure an experiment.

    Parameters
    ----------
    sources : sequence of Source
        Its inputs.
    staged : sequence of (Picture, Path)
        Its pictures and the files they are in.
    progress : Progress
        Called between measurements with the part of them that is done.

    Returns
    -------
    dict
        ``structure``: the structure index δ of every input and of every texture, in the order of the outputs, of a
        video that of its first frame; None where there are too few pixels to tell;
        ``facts``: what the method found out, each with the name of its output.
    """
    textures = [(picture, path) for picture, path in staged if picture.kind == "texture"]
    total = len(sources) + len(textures)
    inputs: list[float | None] = []
    outputs: list[float | None] = []
    for source in sources:
        progress("structure", len(inputs) / total)
        inputs.append(_round(measure_delta(source.pixels)))
    for picture, path in textures:
        progress("structure", (len(inputs) + len(outputs)) / total)
        outputs.append(_round(measure_delta(_pixels(picture, path))))
    facts = [{"output": picture.name, **asdict(fact)} for picture, _ in staged for fact in picture.facts]
    return {"structure": {"inputs": inputs, "outputs": outputs}, "facts": facts}


def _round(delta: float | None) -> float | None:
    return None if delta is None else round(delta, DIGITS)


def _pixels(picture: Picture, path: Path) -> Real:
    """The part of a texture that is measured."""
    area = crop_to_centre(Rectangle(0, 0, picture.width, picture.height))
    if picture.frames == 1:
        return read_crop(path, area)
    frame = read_first_frame(path)[area.y : area.y + area.height, area.x : area.x + area.width]
    return frame.astype(np.float32)

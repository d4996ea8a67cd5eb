"""Every output is declared before a run: what is declared is what comes of it."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from app.methods.effects import COMMON, outputs_of, without_effect
from app.methods.fields import fields
from app.methods.model import Method, Source
from app.methods.registry import METHODS
from tests.methods.runs import VARIANTS, inputs_of, run_small, small

DEPTH_AT = 24  # where a PNG file says its bits per channel
# Values that differ from the defaults, for parameters of which none can be made up from their bounds.
OTHERS: Mapping[str, Sequence[Any]] = {
    "alpha": (0.3, 0.0),
    "order": (3,),
    "radius": (3.0,),
    "cut": (5,),
    "weights": ("0.2,0.8",),
    "strip": (3,),
    "scales": (2,),
    "orientations": (3,),
    "iterations": (2,),
    "half_patch": (2,),
    "tolerance": (0.5,),
    "grid": (6,),
    "sharpness": (8.0,),
    "interval": (3,),
    "candidates": (3,),
}


def made(method: Method, sources: Sequence[Source], scratch: Path, **parameters: Any) -> dict[str, tuple[Any, bytes]]:
    """Every picture by its name, with its file."""
    return {
        picture.name: (picture, picture.data.read_bytes() if isinstance(picture.data, Path) else picture.data)
        for picture in run_small(method, sources, scratch=scratch, **parameters)
    }


@pytest.mark.parametrize(("name", "parameters", "count"), VARIANTS, ids=str)
def test_the_announced_outputs_are_those_that_come(
    name: str, parameters: Mapping[str, Any], count: int, tmp_path: Path
) -> None:
    """By name, kind, type and order; and those come at 16 bits of which it is said, every still texture among them."""
    method = METHODS[name]
    sources = inputs_of(method, count)
    announced = outputs_of(method, small(method, **parameters), count)
    pictures = made(method, sources, tmp_path, depth=16, **parameters)
    assert [output.name for output in announced] == list(pictures)
    for output, (picture, data) in zip(announced, pictures.values(), strict=True):
        assert (picture.kind, picture.media_type) == (output.kind, output.media_type)
        if output.media_type == "image/png":
            assert output.deep == (data[DEPTH_AT] == 16), output.name
        if output.kind == "texture":
            assert output.deep or output.video
    possible = [output.name for output in method.outputs]
    assert len(set(possible)) == len(possible)
    assert all(bool(output.condition) for output in method.outputs if output not in announced)


def other_values(method: Method) -> list[tuple[str, Any]]:
    found: list[tuple[str, Any]] = []
    for entry in fields(method.params):
        if entry.name in COMMON:
            continue
        default = method.params.model_fields[entry.name].default
        if entry.kind == "switch":
            found.append((entry.name, not default))
        elif entry.kind == "choice":
            found += [(entry.name, choice) for choice in entry.choices if choice != default]
        else:
            found += [(entry.name, value) for value in OTHERS[entry.name]]
    return found


CHANGES = [(name, *change, {}) for name, method in METHODS.items() for change in other_values(method)]
# With other parameters than the defaults beside them.
CHANGES += [
    ("dsn", "radius", 3.0, {"spot": "disc"}),
    ("dsn", "alpha", 0.3, {"spot": "disc", "radius": 5.0}),
    ("dsn", "order", 3, {"convergence": True}),
    ("rpn", "window", "gaussian", {"alpha": 0.0}),
    ("patchwork", "reach", "near", {"sharpness": 3.0, "grid": 4}),
    ("patchwork", "reach", "near", {"sharpness": 3.0, "grid": 4, "blend": "sharp"}),
    ("patchwork", "sharpness", 8.0, {"blend": "sharp"}),
    ("video-patchwork", "reach", "near", {"sharpness": 3.0, "grid": 4}),
    ("video-patchwork", "reach", "near", {"sharpness": 3.0, "grid": 4, "arrangement": "mosaic"}),
    ("video-patchwork", "sharpness", 8.0, {"arrangement": "mosaic"}),
    ("video-transfer", "reach", "all", {"sharpness": 8.0, "grid": 6}),
    ("heeger-bergen", "edges", "mirror", {"iterations": 2}),
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "parameter", "value", "beside"), CHANGES)
@pytest.mark.parametrize("larger", [False, True], ids=["of the crop's size", "larger"])
def test_a_parameter_changes_what_it_is_announced_to_change_and_nothing_else(
    name: str, parameter: str, value: Any, beside: Mapping[str, Any], larger: bool, tmp_path: Path
) -> None:
    """And is without effect where it is said to be: what is refused as doing nothing does nothing."""
    method = METHODS[name]
    sources = inputs_of(method, len(method.inputs))
    fixed = name in {"modulus-phase", "rayleigh", "transfer", "video-transfer"} or parameter == "add_smooth"
    size = {} if fixed or not larger else {"width": 70, "height": 61}
    base: dict[str, Any] = {**size, **beside}
    if parameter == "range":  # of what leaves the range there must be some
        sources = [Source((3 * (source.pixels - 128) + 128).clip(0, 255), 255) for source in sources]
    before = made(method, sources, tmp_path, **base)
    after = made(method, sources, tmp_path, **{**base, parameter: value})
    changed = {
        each for each in before.keys() | after.keys() if before.get(each, (0, 0))[1] != after.get(each, (0, 0))[1]
    }
    expected = {output.name for output in method.outputs if output.changed_by(parameter)}
    assert changed <= expected
    sizes = [source.size for source in sources]
    params = small(method, **{**base, parameter: value})
    idle = bool(without_effect(method, sizes, params, {parameter}, [output.name for output in method.outputs]))
    assert bool(changed) != idle
    if not idle:
        texture = without_effect(method, sizes, params, {parameter}, ["texture"])
        assert bool(texture) == ("texture" not in changed)

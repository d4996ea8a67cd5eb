"""The command line gives any output by name, or all of them, at the depth of the photograph."""

import json
from pathlib import Path
from typing import Any

import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image

from app.images.png_writer import encode_png
from app.methods.registry import METHODS
from tests.command_line import CHINA, SAND, WATER, microtexture, pixels, synthesize

CROP = ("--crop", "0,0,40,30")


@pytest.fixture
def deep(tmp_path: Path) -> Path:
    """A photograph of 16 bits."""
    directory = tmp_path / "photographs"
    directory.mkdir()
    path = directory / "deep.png"
    path.write_bytes(encode_png(np.random.default_rng(4).integers(0, 65536, (40, 48, 3), dtype=np.uint16)))
    return path


@pytest.mark.parametrize(
    ("options", "output"),
    [
        (("--method", "dsn", "--convergence"), "dsn-10"),
        (("--method", "dsn", "--convergence"), "adsn"),
        (("--method", "rpn", "--size", "x2", "--alpha", "0.3"), "spot"),
        (("--method", "efros-leung", "--half-patch", "2", "--size", "12x12"), "copy-map"),
        (("--method", "rayleigh"), "rpn"),
    ],
)
def test_an_output_by_name_is_that_of_all(tmp_path: Path, options: tuple[str, ...], output: str) -> None:
    out, directory = tmp_path / "out.png", tmp_path / "all"
    assert synthesize(SAND, out, *CROP, *options, "--output", output).exit_code == 0
    assert synthesize(SAND, "--all", directory, *CROP, *options).exit_code == 0
    assert out.read_bytes() == (directory / f"{output}.png").read_bytes()


def test_all_outputs_come_with_a_record_of_how_they_were_made(tmp_path: Path) -> None:
    directory = tmp_path / "all"
    options = ("--method", "mix", "--strip", "3", "--weights", "1,3", "--crop", "0,0,40,30", "--crop", "2,2,40,30")
    done = synthesize(SAND, CHINA, "--all", directory, *options)
    assert done.exit_code == 0, done.output
    assert f"{directory}: 7 outputs and record.json, mix, seed 0" in done.stdout
    record = json.loads((directory / "record.json").read_text(encoding="utf-8"))
    assert [output["name"] for output in record["outputs"]] == [
        "texture", "crop", "crop-2", "mix-1", "mix-2", "mix-3", "strip",
    ]  # fmt: skip
    assert {path.name for path in directory.iterdir()} == {"record.json", *(each["file"] for each in record["outputs"])}
    for output in record["outputs"]:
        with Image.open(directory / output["file"]) as picture:
            assert picture.size == (output["width"], output["height"])
        assert (directory / output["file"]).stat().st_size == output["bytes"]
    assert record["parameters"] | {"strip": 3, "weights": "1,3", "width": 40} == record["parameters"]
    assert [each["file"] for each in record["inputs"]] == [str(SAND), str(CHINA)]
    assert len(record["diagnostics"]["structure"]["outputs"]) == 4
    assert record["depth"] == 8
    assert record["environment"].keys() == {"version", "cpu", "numpy", "scipy"}


def test_facts_are_in_the_record(tmp_path: Path) -> None:
    assert synthesize(SAND, "--all", tmp_path / "all", *CROP, "--method", "texton").exit_code == 0
    record = json.loads((tmp_path / "all" / "record.json").read_text(encoding="utf-8"))
    assert "radius-50" in [fact["name"] for fact in record["diagnostics"]["facts"]]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--method", "dsn", "--convergence"), "convergence (“Convergence”) changes dsn-10"),
        (("--method", "dsn", "--radius", "3"), "radius"),
        (("--alpha", "0.3"), "larger"),
        (("--output", "crop", "--range", "stretch"), "range"),
        (("--output", "nothing"), "texture, crop, periodic, smooth, spot, input-spectrum, output-spectrum"),
        (("--method", "dsn", "--output", "dsn-10"), "only where “Convergence” is on"),
        (("--output", "crop", "--depth", "16"), "8 bits per channel"),
        (("--output", "output-spectrum", "--depth", "16"), "8 bits per channel"),
    ],
)
def test_what_changes_nothing_is_one_line_and_exit_code_2(tmp_path: Path, options: tuple[str, ...], said: str) -> None:
    done = synthesize(SAND, tmp_path / "out.png", *CROP, *options)
    assert (done.exit_code, done.stderr.count("\n")) == (2, 1), done.output
    assert said in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_path_is_refused_where_only_the_texture_is_asked_for(tmp_path: Path) -> None:
    done = synthesize(SAND, CHINA, tmp_path / "out.png", *CROP, *CROP, "--method", "mix", "--strip", "8")
    assert done.exit_code == 2
    assert "strip (“Steps of the path”) changes mix-1" in done.stderr
    assert synthesize(SAND, CHINA, tmp_path / "out.png", *CROP, *CROP, "--method", "mix", "--strip", "0").exit_code == 0


@pytest.mark.parametrize("options", [("--output", "spot"), ("--depth", "12")])
def test_all_takes_no_name_and_no_strange_depth(tmp_path: Path, options: tuple[str, ...]) -> None:
    done = synthesize(SAND, "--all", tmp_path / "all", *CROP, *options)
    assert (done.exit_code, done.stderr.count("\n")) == (2, 1)
    assert list(tmp_path.iterdir()) == []


def test_files_that_are_there_are_replaced_only_on_request(tmp_path: Path) -> None:
    directory = tmp_path / "all"
    directory.mkdir()
    (directory / "spot.png").write_bytes(b"precious")
    (directory / "other.txt").write_bytes(b"mine")
    refused = synthesize(SAND, "--all", directory, *CROP)
    assert refused.exit_code == 2
    assert "spot.png is there already" in refused.stderr
    assert {path.name for path in directory.iterdir()} == {"spot.png", "other.txt"}
    assert synthesize(SAND, "--all", directory, *CROP, "--overwrite").exit_code == 0
    assert pixels(directory / "spot.png").shape == (30, 40, 3)
    assert (directory / "other.txt").read_bytes() == b"mine"


def test_a_run_that_fails_leaves_no_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("app.cli.run.write_record", failing)
    assert synthesize(SAND, "--all", tmp_path / "all", *CROP).exit_code == 1
    assert list(tmp_path.iterdir()) == []


def test_a_directory_that_cannot_be_is_refused_before_any_work(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"")
    for directory in (tmp_path / "file", tmp_path / "no" / "such"):
        done = synthesize(SAND, "--all", directory, *CROP)
        assert (done.exit_code, done.stderr.count("\n")) == (2, 1)


@pytest.mark.parametrize(
    ("name", "options", "kind"),
    [
        ("out.png", (), np.uint16),
        ("out.tif", (), np.uint16),
        ("out.tif", ("--depth", "8"), np.uint8),
        ("out.png", ("--depth", "8"), np.uint8),
        ("out.jpg", (), np.uint8),
        ("out.webp", (), np.uint8),
        ("out.tif", ("--output", "smooth"), np.uint16),
        ("out.png", ("--output", "input-spectrum"), np.uint8),
    ],
)
def test_a_photograph_of_16_bits_gives_files_of_16_bits_where_they_hold_them(
    tmp_path: Path, deep: Path, name: str, options: tuple[str, ...], kind: type
) -> None:
    out = tmp_path / name
    assert synthesize(deep, out, *options).exit_code == 0
    made = tifffile.imread(out) if out.suffix == ".tif" else imagecodecs.imread(out)
    assert made.dtype == kind
    assert (len(np.unique(made)) > 256) == (kind == np.uint16)


@pytest.mark.parametrize(("options", "kind"), [((), np.uint16), (("--depth", "8"), np.uint8)])
def test_all_of_its_outputs_have_its_bits(tmp_path: Path, deep: Path, options: tuple[str, ...], kind: type) -> None:
    assert synthesize(deep, "--all", tmp_path / "all", *options).exit_code == 0
    for name in ("texture", "crop", "periodic", "spot"):
        assert imagecodecs.imread(tmp_path / "all" / f"{name}.png").dtype == kind


@pytest.mark.parametrize("order", [0, 1])
def test_of_several_photographs_the_deepest_decides(tmp_path: Path, deep: Path, order: int) -> None:
    photographs = [deep, SAND] if order else [SAND, deep]
    out = tmp_path / "out.png"
    assert synthesize(*photographs, out, *CROP, *CROP, "--method", "mix").exit_code == 0
    assert imagecodecs.imread(out).dtype == np.uint16


@pytest.mark.parametrize(
    ("output", "name"),
    [("preview", "o.webp"), ("cube", "o.png"), ("crop", "o.mp4"), ("texture-mp4", "o.mp4"), ("average", "o.tif")],
)
def test_outputs_of_a_video_are_those_of_all(tmp_path: Path, output: str, name: str) -> None:
    options = ("--method", "video-rpn", "--crop", "0,0,48,32", "--time", "0,6")
    assert synthesize(WATER, tmp_path / name, *options, "--output", output).exit_code == 0
    assert synthesize(WATER, "--all", tmp_path / "all", *options).exit_code == 0
    written = {path.name for path in (tmp_path / "all").iterdir()}
    assert {"texture.webm", "texture-mp4.mp4", "preview.webp", "cube.png", "record.json"} <= written
    suffixes = {Path(name).suffix, ".png" if name.endswith(".tif") else ""}
    whole = next(path for path in (tmp_path / "all").glob(f"{output}*") if path.suffix in suffixes)
    if ".tif" in name:
        assert np.array_equal(tifffile.imread(tmp_path / name), imagecodecs.imread(whole))
    else:
        assert (tmp_path / name).read_bytes() == whole.read_bytes()


@pytest.mark.parametrize("name", METHODS)
def test_methods_tells_of_every_output_of_one(name: str) -> None:
    text = microtexture("methods", name).stdout
    for output in METHODS[name].outputs:
        assert output.name in text
    for parameter in METHODS[name].params.model_fields:
        assert f"--{parameter.replace('_', '-')}" in text
    (document,) = json.loads(microtexture("methods", name, "--json").stdout)["methods"]
    assert [output["name"] for output in document["outputs"]] == [output.name for output in METHODS[name].outputs]


def test_a_method_that_is_not_there_is_said_to_be_none() -> None:
    done = microtexture("methods", "fractal")
    assert (done.exit_code, done.stderr.count("\n")) == (2, 1)

"""The command line: its options come from the methods, its errors are single lines, its files are whole or absent."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import tifffile
from PIL import Image

from app.images.video.reader import read_video
from app.methods.registry import METHODS
from tests.command_line import CHINA, SAND, WATER, pixels, synthesize
from tests.methods.runs import SMALL


def test_help_answers_without_loading_numerics_or_web() -> None:
    script = (
        "import sys; sys.argv = ['microtexture', '--help']\n"
        "from app.cli import main\n"
        "try: main()\n"
        "except SystemExit as end: assert not end.code\n"
        "slow = {'numpy', 'scipy', 'fastapi', 'pydantic', 'sqlalchemy', 'uvicorn'}\n"
        "print('loaded:', *sorted(slow & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert "synthesize" in done.stdout
    assert done.stdout.splitlines()[-1] == "loaded:"


def test_every_parameter_of_every_method_is_an_option_with_its_help() -> None:
    text = " ".join(synthesize("--help").output.split())
    for method in METHODS.values():
        for name, field in method.params.model_fields.items():
            assert f"--{name.replace('_', '-')}" in text
            assert " ".join((field.description or "").split()[:4]) in text


def test_the_example_of_the_issue_makes_a_texture_of_the_asked_size(tmp_path: Path) -> None:
    out = tmp_path / "out.png"
    done = synthesize(SAND, out, "--method", "rpn", "--crop", "10,20,256,256", "--size", "1024x768", "--seed", "7")
    assert done.exit_code == 0, done.output
    assert pixels(out).shape == (768, 1024, 3)
    assert "1024 × 768" in done.output
    assert "seed 7" in done.output


def test_the_same_seed_gives_the_same_bytes_and_another_seed_others(tmp_path: Path) -> None:
    files = [tmp_path / name for name in ("a.png", "b.png", "c.png")]
    for file, seed in zip(files, "778", strict=True):
        assert synthesize(SAND, file, "--crop", "0,0,64,64", "--seed", seed).exit_code == 0
    first, second, third = (file.read_bytes() for file in files)
    assert first == second != third


def test_a_size_may_be_a_multiple_of_the_crop(tmp_path: Path) -> None:
    out = tmp_path / "out.png"
    assert synthesize(CHINA, out, "--crop", "0,0,43,31", "--size", "x1.5").exit_code == 0
    assert pixels(out).shape == (47, 65, 3), "halves are rounded up, as the form does"


@pytest.mark.parametrize(
    ("name", "kind"), [("o.png", "PNG"), ("o.jpg", "JPEG"), ("o.JPEG", "JPEG"), ("o.webp", "WEBP"), ("o.tif", "TIFF")]
)
def test_the_extension_chooses_the_format(tmp_path: Path, name: str, kind: str) -> None:
    assert synthesize(CHINA, tmp_path / name, "--crop", "0,0,40,30").exit_code == 0
    with Image.open(tmp_path / name) as image:
        assert (image.format, image.size) == (kind, (40, 30))


def test_sixteen_bits_are_written_where_asked(tmp_path: Path) -> None:
    out = tmp_path / "out.tif"
    assert synthesize(CHINA, out, "--crop", "0,0,40,30", "--depth", "16").exit_code == 0
    deep = tifffile.imread(out)
    assert deep.dtype == np.uint16
    assert len(np.unique(deep)) > 256


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--method", "fractal"], "rpn, adsn"),
        (["--crop", "1,2,3"], "x,y,width,height"),
        (["--crop", "600,0,100,100"], "reaches outside"),
        (["--size", "big"], "1024x1024"),
        (["--size", "64x64", "--width", "64"], "either"),
        (["--seed", "-1"], "Seed"),
        (["--alpha", "0.7"], "0.5"),
        (["--window", "square"], 'one of: bump, gaussian; got "square"'),
        (["--size", "x2", "--add-smooth"], "own size"),
        (["--size", "99999x99999"], "megapixels"),
        (["--width", "1" + "0" * 400], "Width is a whole number from 1 to 1000000"),
        (["--seed", "9" * 5000], "Seed is a whole number from 0 to 9007199254740991"),
        (["--alpha", "1e999"], "Transition α is a number from 0 to 0.5"),
        (["--crop", "0,0,9," + "9" * 5000], "four whole numbers"),
        (["--time", "0," + "9" * 5000], "two whole numbers"),
        (["--size", "x" + "9" * 5000], "1024x1024"),
        (["--depth", "12"], "8 or 16"),
    ],
)
def test_a_wrong_request_is_one_line_on_stderr_and_exit_code_2(tmp_path: Path, arguments: list[str], said: str) -> None:
    out = tmp_path / "out.png"
    done = synthesize(CHINA, out, *arguments)
    assert done.exit_code == 2
    assert done.stderr.startswith("microtexture: ")
    assert done.stderr.count("\n") == 1
    assert said in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["out.gif", "out", "no/such/out.png"])
def test_a_file_that_cannot_be_written_is_refused_before_any_work(tmp_path: Path, name: str) -> None:
    done = synthesize(CHINA, tmp_path / name)
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1


def test_sixteen_bits_do_not_fit_into_a_jpeg(tmp_path: Path) -> None:
    assert "PNG and TIFF" in synthesize(CHINA, tmp_path / "out.jpg", "--depth", "16").stderr


def test_a_file_that_is_there_is_replaced_only_on_request(tmp_path: Path) -> None:
    out = tmp_path / "out.png"
    out.write_bytes(b"precious")
    refused = synthesize(CHINA, out, "--crop", "0,0,40,30")
    assert (refused.exit_code, out.read_bytes()) == (2, b"precious")
    assert "--overwrite" in refused.stderr
    assert synthesize(CHINA, out, "--crop", "0,0,40,30", "--overwrite").exit_code == 0
    assert pixels(out).shape == (30, 40, 3)


@pytest.mark.parametrize("content", [b"", b"not a picture", SAND.read_bytes()[:5000]])
def test_a_file_that_is_no_whole_photograph_is_refused(tmp_path: Path, content: bytes) -> None:
    photo = tmp_path / "photo.png"
    photo.write_bytes(content)
    done = synthesize(photo, tmp_path / "out.png")
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "out.png").exists()


def test_a_photograph_alone_is_not_enough_and_is_left_alone() -> None:
    before = CHINA.read_bytes()
    done = synthesize(CHINA, "--overwrite")
    assert (done.exit_code, done.stderr) == (
        2,
        "microtexture: Name a photograph, or a clip, and then the file to write.\n",
    )
    assert CHINA.read_bytes() == before


def test_more_photographs_than_the_method_takes_are_refused(tmp_path: Path) -> None:
    done = synthesize(CHINA, SAND, tmp_path / "out.png")
    assert done.exit_code == 2
    assert "takes 1 input" in done.stderr


@pytest.mark.parametrize("name", METHODS)
def test_every_method_runs(tmp_path: Path, name: str) -> None:
    method = METHODS[name]
    out = tmp_path / ("out.webm" if method.moving else "out.png")
    files = [WATER if slot.moving else still for slot, still in zip(method.inputs, (SAND, CHINA), strict=False)]
    crops = [word for _ in files for word in ("--crop", "20,10,64,48")]
    small = [f"--{parameter}={value}" for parameter, value in SMALL.get(name, {}).items()]
    times = ["--time", "3,12"] if method.moving else []
    done = synthesize(*files, out, "--method", name, *crops, *times, *small, "--seed", "3")
    assert done.exit_code == 0, done.output
    assert (next(read_video(out)) if method.moving else pixels(out)).shape == (48, 64, 3)


def test_several_photographs_are_taken_in_their_order_each_with_its_crop(tmp_path: Path) -> None:
    """A mixture that has all of its weight on one sample has that sample's mean, but for the few values cut off."""
    boxes = {SAND: (0, 0, 64, 64), CHINA: (300, 40, 64, 64)}
    crops = [word for box in boxes.values() for word in ("--crop", ",".join(map(str, box)))]
    for place, (photo, (x, y, width, height)) in enumerate(boxes.items()):
        out = tmp_path / f"{place}.png"
        weights = ",".join("01"[place == other] for other in range(2))
        assert synthesize(*boxes, out, "--method", "mix", *crops, "--weights", weights).exit_code == 0
        crop = np.asarray(Image.open(photo).convert("RGB"))[y : y + height, x : x + width]
        assert np.abs(pixels(out).mean((0, 1)) - crop.mean((0, 1))).max() < 1


@pytest.mark.parametrize(("method", "option"), [("rpn", "order"), ("mix", "half-patch"), ("efros-leung", "alpha")])
def test_an_option_of_another_method_is_refused_with_words(tmp_path: Path, method: str, option: str) -> None:
    photos = [SAND] * len(METHODS[method].inputs)
    done = synthesize(*photos, tmp_path / "out.png", "--method", method, f"--{option}", "0.1")
    assert done.exit_code == 2
    assert done.stderr.startswith(f'microtexture: The method {method} has no parameter "{option.replace("-", "_")}"')


def test_help_lists_options_under_the_methods_that_have_them() -> None:
    text = synthesize("--help").output
    *_, last = text.split("Options of efros-leung:")
    assert "--half-patch" in last
    assert "--order" not in last
    assert text.index("--seed") < text.index("Options of ")


def test_a_missing_photograph_is_named(tmp_path: Path) -> None:
    assert "nowhere.jpg" in synthesize(tmp_path / "nowhere.jpg", tmp_path / "out.png").stderr


def test_transparent_pixels_in_the_crop_are_refused_and_beside_it_are_not(tmp_path: Path) -> None:
    photo = tmp_path / "photo.png"
    image = Image.open(CHINA).convert("RGBA").crop((0, 0, 200, 100))
    image.putalpha(Image.linear_gradient("L").point(lambda value: 255 if value > 100 else 0).resize((200, 100)))
    image.save(photo)
    assert "transparent" in synthesize(photo, tmp_path / "out.png").stderr
    assert synthesize(photo, tmp_path / "out.png", "--crop", "0,60,100,40").exit_code == 0

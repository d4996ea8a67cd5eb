"""A start without the files of the pages: one line that says so and a status, from whatever copy of the code."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from app.samples import require_files
from app.settings import ROOT

pytestmark = pytest.mark.slow


def a_copy(directory: Path) -> Path:
    """Copy the code and what it serves, as a checkout has them."""
    for name in ("app", "templates", "static", "samples"):
        shutil.copytree(ROOT / name, directory / name, ignore=shutil.ignore_patterns("__pycache__"))
    return directory


def serve(copy: Path, **settings: str) -> subprocess.CompletedProcess[str]:
    """Start the service of a copy at an address that no machine has, so that it ends in any case."""
    program = "import sys; sys.path.insert(0, sys.argv.pop(1)); from app.cli import main; main()"
    command = [sys.executable, "-c", program, str(copy), "serve", "--host", "192.0.2.1", "--port", "1"]
    variables = os.environ | {"MICROTEXTURE_DATA_DIR": str(copy / "data")} | settings
    return subprocess.run(command, cwd=copy, env=variables, capture_output=True, text=True, check=False, timeout=60)


@pytest.mark.parametrize(
    ("form", "missing"),
    [
        ("a checkout", "templates"),
        ("a checkout", "samples"),
        ("a wheel", "static"),
        ("a wheel", "samples/catalogue.json"),
        ("a wheel", "samples/sand_desert009.png"),
    ],
)
def test_a_start_without_its_files_says_so_in_one_line(tmp_path: Path, form: str, missing: str) -> None:
    copy = files = a_copy(tmp_path)
    if form == "a wheel":
        files = copy / "app" / "assets"
        files.mkdir()
        for name in ("templates", "static", "samples"):
            (copy / name).rename(files / name)
    path = files / missing
    path.unlink() if path.is_file() else shutil.rmtree(path)
    done = serve(copy)
    assert done.returncode == 1
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith("microtexture: A file of Microtexture is missing; install the wheel anew")
    assert str(path) in line
    assert not (copy / "data").exists()


def test_a_wheel_of_the_code_alone_says_so_too(tmp_path: Path) -> None:
    """As a build without the files made it, or a copy of the package into another project."""
    shutil.copytree(ROOT / "app", tmp_path / "app", ignore=shutil.ignore_patterns("__pycache__"))
    done = serve(tmp_path)
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1
    assert str(tmp_path / "templates" / "base.html") in done.stderr


def test_a_directory_of_samples_that_is_not_there_is_refused(tmp_path: Path) -> None:
    done = serve(a_copy(tmp_path), MICROTEXTURE_SAMPLES_DIR=str(tmp_path / "photographs"))
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1
    assert str(tmp_path / "photographs") in done.stderr


def test_an_operators_own_samples_need_no_catalogue(tmp_path: Path) -> None:
    require_files(tmp_path)

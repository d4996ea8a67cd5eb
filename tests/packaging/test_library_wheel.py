"""The library's wheel: the numerics under the name `microtexture`, with numpy and scipy and no checkout in sight."""

import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from email.message import Message
from email.parser import HeaderParser
from pathlib import Path

import numpy as np
import pytest

from app.settings import ROOT
from app.synthesis import __version__
from app.synthesis.gaussian.rpn import rpn
from tests.packaging.environments import Environment, build, environment

pytestmark = pytest.mark.slow

LIBRARY = ROOT / "app" / "synthesis"
DOCTESTS = """
import doctest, pkgutil, sys
from importlib import import_module
import microtexture
modules = [import_module(found.name) for found in pkgutil.walk_packages(microtexture.__path__, "microtexture.")]
results = [doctest.testmod(module) for module in modules]
print(len(modules), sum(result.attempted for result in results))
sys.exit(sum(result.failed for result in results))
"""
CALLS = {
    "gaussian": """
        from microtexture.gaussian.adsn import adsn
        texture = adsn(crop, 40, 48, seed=3)
    """,
    "gaussian, moving": """
        from microtexture.gaussian.video_rpn import video_rpn
        texture = next(iter(video_rpn(np.stack([crop, crop[::-1]]), seed=3)))
    """,
    "pyramid": """
        from microtexture.pyramid.heeger_bergen import heeger_bergen
        texture = heeger_bergen(crop, 40, 48, seed=3)
    """,
    "sampling": """
        from microtexture.sampling.efros_leung import efros_leung
        texture, _, _ = efros_leung(crop[:12, :12], 16, 16, seed=3, half_patch=1)
    """,
    "patchwork": """
        from microtexture.patchwork.patchwork import patchwork
        texture = patchwork(crop, 40, 48, grid=8, seed=3)
    """,
    "structure": """
        from microtexture.structure import structure_index
        texture = structure_index(crop).delta
    """,
}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(LIBRARY, "wheel", tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def library(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """The library's wheel beside numpy and scipy alone."""
    directory = tmp_path_factory.mktemp("library")
    seen = directory / "numpy and scipy"
    seen.mkdir()
    for package in (np, sys.modules["scipy"]):
        packages = Path(str(package.__file__)).parents[1]
        for path in packages.glob(f"{package.__name__}*"):  # the package, its libraries, its metadata
            (seen / path.name).symlink_to(path)
    return environment(directory, wheel, [str(seen)])


@pytest.fixture(scope="module")
def metadata(wheel: Path) -> Message:
    with zipfile.ZipFile(wheel) as opened:
        return HeaderParser().parsestr(opened.read(f"microtexture-{__version__}.dist-info/METADATA").decode())


def in_wheel(wheel: Path) -> set[str]:
    with zipfile.ZipFile(wheel) as opened:
        return set(opened.namelist())


def python(text: str) -> list[str]:
    """The examples of Python in a document."""
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_the_wheel_holds_the_numerics_and_nothing_else(wheel: Path) -> None:
    modules = {f"microtexture/{path.relative_to(LIBRARY).as_posix()}" for path in LIBRARY.rglob("*.py")}
    held = {name for name in in_wheel(wheel) if ".dist-info/" not in name}
    assert held == modules | {"microtexture/py.typed"}


def test_the_source_distribution_makes_the_same_wheel(wheel: Path, tmp_path: Path) -> None:
    with tarfile.open(build(LIBRARY, "sdist", tmp_path / "archives")) as archive:
        archive.extractall(tmp_path / "sources", filter="data")
    (project,) = (tmp_path / "sources").iterdir()
    assert in_wheel(build(project, "wheel", tmp_path / "wheels")) == in_wheel(wheel)


def test_the_library_needs_numpy_and_scipy_only_as_the_service_does(metadata: Message) -> None:
    service = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert metadata.get_all("Requires-Dist") == [
        need for need in service["dependencies"] if need.startswith(("numpy", "scipy"))
    ]
    assert metadata["Requires-Python"] == service["requires-python"]
    assert (metadata["Name"], metadata["Version"]) == ("microtexture", __version__)
    assert (LIBRARY / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()


def test_its_environment_has_nothing_of_the_service(library: Environment) -> None:
    for name in ("app", "fastapi", "pydantic", "distributed", "PIL", "sqlalchemy"):
        done = library.run("python", "-c", f"import {name}")
        assert f"No module named '{name}'" in done.stderr


def test_every_doctest_runs_there(library: Environment) -> None:
    done = library.run("python", "-c", DOCTESTS)
    assert done.returncode == 0, done.stdout + done.stderr
    modules, examples = map(int, done.stdout.split())
    assert modules == len(list(LIBRARY.rglob("*.py"))) - 1  # the package itself
    assert examples > 50


@pytest.mark.parametrize("family", CALLS)
def test_every_family_makes_something_of_a_crop_there(library: Environment, family: str) -> None:
    lines = [line.strip() for line in CALLS[family].strip().splitlines()]
    lines = [
        "import numpy as np",
        "crop = np.random.default_rng(0).random((32, 36, 3), np.float32)",
        *lines,
        "texture = np.asarray(texture)",
        "assert np.isfinite(texture).all() and texture.size, texture",
        "print('done')",
    ]
    done = library.run("python", "-c", "\n".join(lines))
    assert done.stdout == "done\n", done.stderr


def test_the_examples_of_the_documents_run_there_and_give_the_texture_of_the_service(library: Environment) -> None:
    (example,) = (text for text in python((LIBRARY / "README.md").read_text(encoding="utf-8")))
    assert example in python((ROOT / "README.md").read_text(encoding="utf-8"))
    done = library.run("python", "-c", f"{example}\nnp.save('texture.npy', texture)")
    assert done.returncode == 0, done.stderr
    crop = np.random.default_rng(0).random((256, 256, 3), np.float32)
    np.testing.assert_array_equal(np.load(library.work / "texture.npy"), rpn(crop, 1024, 1024, seed=7))


def test_a_type_checker_reads_the_types_of_the_installed_library(library: Environment) -> None:
    program = library.work / "program.py"
    program.write_text("from microtexture.structure import is_too_small\nreveal_type(is_too_small)\n")
    command = [sys.executable, "-m", "mypy", "--config-file=", "--follow-imports=silent", "--python-executable"]
    done = subprocess.run(
        [*command, library.programs / "python", program.name],
        cwd=library.work,
        env=library.variables,
        capture_output=True,
        text=True,
        check=False,
    )
    assert 'Revealed type is "def (height: int, width: int) -> bool"' in done.stdout

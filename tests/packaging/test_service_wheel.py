"""The service's wheel: it holds all that the service serves, and nothing else, and runs where no checkout is."""

import json
import re
import socket
import subprocess
import tarfile
import time
import zipfile
from collections.abc import Iterator
from email.parser import HeaderParser
from pathlib import Path

import httpx
import numpy as np
import pytest
from PIL import Image

from app.methods.registry import METHODS
from app.settings import ROOT
from app.synthesis import __version__
from tests.packaging.environments import Environment, build

pytestmark = pytest.mark.slow

PATIENCE = 60.0  # seconds
SHIPPED = {
    "app": {".py"},
    "templates": {".html"},
    "static": {".js", ".css", ".svg"},
    "samples": {".png", ".jpg", ".mp4", ".json", ".md"},
}


def shipped() -> dict[str, set[str]]:
    """The files of the checkout that the service is made of, by directory."""
    return {
        directory: {
            path.relative_to(ROOT / directory).as_posix()
            for path in (ROOT / directory).rglob("*")
            if path.suffix in suffixes
        }
        for directory, suffixes in SHIPPED.items()
    }


def in_wheel(wheel: Path) -> set[str]:
    with zipfile.ZipFile(wheel) as opened:
        return set(opened.namelist())


def expected_in_wheel() -> set[str]:
    files = {f"app/{name}" for name in shipped().pop("app")}
    for directory, names in shipped().items():
        if directory != "app":
            files |= {f"app/assets/{directory}/{name}" for name in names}
    return files


@pytest.fixture(scope="module")
def site(service: Environment) -> Iterator[httpx.Client]:
    """The installed service, serving from an empty directory."""
    with socket.create_server(("127.0.0.1", 0)) as reserved:
        port = reserved.getsockname()[1]
    log = service.work / "server.log"
    command = [str(service.programs / "microtexture"), "serve", "--port", str(port)]
    variables = service.variables | {"MICROTEXTURE_WORKERS": "1", "MICROTEXTURE_CATALOGUE": "false"}
    with log.open("w") as output:
        process = subprocess.Popen(command, cwd=service.work, env=variables, stdout=output, stderr=output)
    try:
        with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=PATIENCE) as client:
            deadline = time.monotonic() + PATIENCE
            while not is_ready(client):
                assert process.poll() is None, log.read_text()
                assert time.monotonic() < deadline, log.read_text()
                time.sleep(0.05)
            yield client
    finally:
        process.terminate()
        process.wait(PATIENCE)


def is_ready(client: httpx.Client) -> bool:
    try:
        return client.get("/readyz").status_code == 200
    except httpx.TransportError:
        return False


def test_the_wheel_holds_the_files_of_the_service_and_nothing_else(service_wheel: Path) -> None:
    held = {name for name in in_wheel(service_wheel) if ".dist-info/" not in name}
    assert held == expected_in_wheel()


def test_the_source_distribution_makes_the_same_wheel(service_wheel: Path, tmp_path: Path) -> None:
    archives, sources, wheels = (tmp_path / name for name in ("archives", "sources", "wheels"))
    with tarfile.open(build(ROOT, "sdist", archives)) as archive:
        archive.extractall(sources, filter="data")
    (project,) = sources.iterdir()
    assert {path.name for path in project.iterdir()} == {
        *SHIPPED, "pyproject.toml", "PKG-INFO", "README.md", "CHANGELOG.md", "LICENSE", ".gitignore"
    }  # fmt: skip
    assert in_wheel(build(project, "wheel", wheels)) == in_wheel(service_wheel)


def test_the_wheel_says_what_it_is(service_wheel: Path) -> None:
    with zipfile.ZipFile(service_wheel) as opened:
        (metadata,) = (name for name in opened.namelist() if name.endswith(".dist-info/METADATA"))
        said = HeaderParser().parsestr(opened.read(metadata).decode())
    assert (said["Name"], said["Version"]) == ("microtexture-service", __version__)
    assert said["License-Expression"] == "BSD-3-Clause"
    assert "Programming Language :: Python :: 3.13" in said.get_all("Classifier", [])


def test_the_installed_package_is_the_one_that_runs(service: Environment) -> None:
    done = service.run("python", "-c", "import app.settings; print(app.settings.ROOT)")
    assert done.stdout.strip() == str(service.packages / "app" / "assets"), done.stderr


def test_the_installed_service_shows_its_home_page_with_its_styles_and_scripts(site: httpx.Client) -> None:
    page = site.get("/")
    assert page.status_code == 200
    files = set(re.findall(r'(?:href|src)="(/static/[^"]+)"', page.text))
    assert {Path(name).suffix for name in files} >= {".css", ".js", ".svg"}
    for name in files:
        assert site.get(name).content == (ROOT / name.lstrip("/")).read_bytes(), name


def test_the_installed_service_makes_a_texture_of_a_bundled_sample(site: httpx.Client) -> None:
    """Bundled and uploaded samples go through the decoding process, the experiment through a worker process."""
    deadline = time.monotonic() + PATIENCE
    while "sand_desert009" not in {sample["id"] for sample in site.get("/api/v1/samples").json()["samples"]}:
        assert time.monotonic() < deadline
        time.sleep(0.05)
    crop = {"x": 0, "y": 0, "width": 64, "height": 64}
    request = {
        "method": "rpn",
        "inputs": [{"sample": "sand_desert009", "crop": crop}],
        "parameters": {"width": 96, "height": 80, "seed": 7},
    }
    experiment = site.post("/api/v1/experiments", json=request, headers={"Prefer": "wait=60"}).json()
    assert experiment["status"] == "succeeded", experiment
    texture = next(output for output in experiment["outputs"] if output["name"] == "texture")
    assert (texture["width"], texture["height"]) == (96, 80)
    assert site.get(texture["url"]).content.startswith(b"\x89PNG")
    assert site.get(f"/experiments/{experiment['id']}").status_code == 200


def test_the_installed_command_synthesizes(service: Environment) -> None:
    photograph = ROOT / "samples" / "sand_desert009.png"
    arguments = ("--method", "adsn", "--crop", "0,0,64,64", "--size", "96x80", "--seed", "7")
    done = service.run("microtexture", "synthesize", photograph, "texture.png", *arguments)
    assert done.returncode == 0, done.stderr
    with Image.open(service.work / "texture.png") as texture:
        assert texture.size == (96, 80)
        assert np.asarray(texture).std() > 1


def test_the_installed_command_lists_the_methods(service: Environment) -> None:
    done = service.run("microtexture", "methods", "--json")
    assert [method["name"] for method in json.loads(done.stdout)["methods"]] == list(METHODS)
    assert service.run("microtexture", "--version").stdout == f"microtexture {__version__}\n"

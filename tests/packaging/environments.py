"""Environments as somebody has them who never saw the checkout: built wheels beside the locked dependencies."""

import os
import subprocess
import sys
import venv
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uv import find_uv_bin


@dataclass(frozen=True)
class Environment:
    """A Python environment and an empty directory to work in."""

    directory: Path
    work: Path

    @property
    def programs(self) -> Path:
        return self.directory / "bin"

    @property
    def packages(self) -> Path:
        return next((self.directory / "lib").glob("python*/site-packages"))

    @property
    def variables(self) -> dict[str, str]:
        """The variables of this process without those that would show the way back to the checkout."""
        return {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "MICROTEXTURE_"))}

    def run(self, program: str, *arguments: str | Path, **options: Any) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [self.programs / program, *arguments],
            cwd=self.work,
            env=self.variables,
            capture_output=True,
            text=True,
            check=False,
            **options,
        )


def dependencies() -> list[str]:
    """Where this process finds what is installed; an editable install's path, the checkout, is none of these."""
    return [path for path in sys.path if Path(path).name in ("site-packages", "dist-packages")]


def environment(directory: Path, wheel: Path, seen: Iterable[str]) -> Environment:
    """Make an environment with a wheel in it, which sees the directories ``seen`` but not the checkout."""
    made = Environment(directory / "environment", directory / "work")
    made.work.mkdir(parents=True)
    venv.create(made.directory, with_pip=False, symlinks=True)
    install = [find_uv_bin(), "pip", "install", "--quiet", "--offline", "--no-config", "--no-deps", "--no-cache"]
    subprocess.run([*install, "--python", made.programs / "python", wheel], check=True)
    (made.packages / "dependencies.pth").write_text("".join(f"{path}\n" for path in seen), encoding="utf-8")
    return made


def build(project: Path, target: str, directory: Path) -> Path:
    """Build a distribution, ``"wheel"`` or ``"sdist"``, of the project in a directory."""
    command = [sys.executable, "-m", "hatchling", "build", "--target", target, "--directory", str(directory)]
    subprocess.run(command, cwd=project, check=True, capture_output=True)
    (built,) = directory.iterdir()
    return built

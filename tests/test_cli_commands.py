"""Commands beside `synthesize`, how it is interrupted, and settings that are wrong."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from app.methods.registry import METHODS
from app.settings import Settings
from tests.command_line import SAND, microtexture


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    return {**os.environ, "MICROTEXTURE_DATA_DIR": str(tmp_path / "data")}


@pytest.mark.slow
def test_an_interrupt_ends_it_with_130_and_leaves_no_file(tmp_path: Path, environment: dict[str, str]) -> None:
    """Interrupted while the method runs: its progress callback is where the signal is sent.

    What was started in the background of a shell, as these tests may be, ignores interrupts, and so would its child.
    """
    script = (
        "import os, signal, sys\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "import app.cli.progress as progress\n"
        "progress.Bar.__call__ = lambda *_: os.kill(os.getpid(), signal.SIGINT)\n"
        "from app.cli import main\n"
        "main()"
    )
    arguments = [
        sys.executable,
        "-c",
        script,
        "synthesize",
        str(SAND),
        str(tmp_path / "out.png"),
        "--size",
        "1024x1024",
    ]
    done = subprocess.run(arguments, capture_output=True, text=True, env=environment, check=False)
    assert done.returncode in (130, -signal.SIGINT)
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_methods_lists_every_method() -> None:
    done = microtexture("methods")
    assert all(name in done.stdout for name in METHODS)
    document = json.loads(microtexture("methods", "--json").stdout)
    assert [method["name"] for method in document["methods"]] == list(METHODS)
    assert "alpha" in document["methods"][0]["parameters"]["properties"]


@pytest.mark.slow
def test_prune_says_what_went(environment: dict[str, str]) -> None:
    done = subprocess.run(
        [sys.executable, "-c", "from app.cli import main; main()", "prune", "--older-than", "30d"],
        capture_output=True,
        text=True,
        env=environment,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "Removed 0 experiments, 0 samples and 0 files.\n"), done.stderr


@pytest.mark.parametrize("age", ["soon", "30", "-1d", "30y", ""])
def test_prune_refuses_an_age_it_cannot_read(age: str) -> None:
    done = microtexture("prune", f"--older-than={age}")
    assert done.exit_code == 2
    assert "30d" in done.stderr


NUMERIC_SETTINGS = [name for name, field in Settings.model_fields.items() if field.annotation in (int, float)]


@pytest.mark.parametrize("value", ["-1", "1" + "0" * 400, "inf", "nan"])
@pytest.mark.parametrize("name", NUMERIC_SETTINGS)
def test_a_wrong_setting_is_named(monkeypatch: pytest.MonkeyPatch, name: str, value: str) -> None:
    monkeypatch.setenv(f"MICROTEXTURE_{name.upper()}", value)
    done = microtexture("serve")
    assert done.exit_code == 2
    assert f"MICROTEXTURE_{name.upper()} is set wrongly" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("variables", "code", "words"),
    [
        ({"DATABASE_URL": "postgresql+psycopg://user:secret@127.0.0.1:1/none"}, 1, "the database cannot be used"),
        ({"SCHEDULER": "tcp://127.0.0.1:1"}, 2, "Set MICROTEXTURE_DATABASE_URL to a PostgreSQL database"),
        (
            {"SCHEDULER": "tcp://x:1", "DATABASE_URL": "postgresql://u@h/x", "DATA_DIR": "data"},
            2,
            "Set MICROTEXTURE_DATA_DIR to an absolute path",
        ),
    ],
)
def test_a_service_that_cannot_start_says_why_in_a_line_or_two(
    tmp_path: Path, variables: dict[str, str], code: int, words: str
) -> None:
    """Without a traceback and without a password."""
    settings = {f"MICROTEXTURE_{name}": value for name, value in ({"DATA_DIR": str(tmp_path)} | variables).items()}
    program = str(Path(sys.executable).parent / "microtexture")
    command, environment = [program, "serve", "--port", "1"], os.environ | settings
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == code
    assert len(done.stderr.splitlines()) <= 2, done.stderr
    assert words in done.stderr.splitlines()[-1]
    assert "secret" not in done.stderr

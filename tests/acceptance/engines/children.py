"""Programs that tests start beside Python, and that are gone afterwards."""

import os
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import psutil


def program(variable: str, *names: str) -> str:
    """The path of a program: the one that an environment variable names, or the first that is installed."""
    found = os.environ.get(variable) or next(filter(None, map(shutil.which, names)), None)
    assert found, f"{names[0]} is missing: run scripts/test-packages, or say in {variable} where it is"
    return found


@contextmanager
def child(command: Sequence[str], log: Path, **options: Any) -> Iterator[subprocess.Popen[str]]:
    """Run a program that is ended afterwards with all it started, and also if this process is killed."""
    with log.open("a") as errors:
        guarded = ["setpriv", "--pdeathsig", "TERM", *command]
        process = subprocess.Popen(guarded, stderr=errors, text=True, **options)
        try:
            yield process
        finally:
            with suppress(psutil.NoSuchProcess):
                first = psutil.Process(process.pid)
                end([first, *first.children(recursive=True)])
            process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    pipe.close()


def end(family: Sequence[psutil.Process]) -> None:
    """Ask processes to end, and kill those that do not."""
    for each in family:
        with suppress(psutil.NoSuchProcess):
            each.terminate()
    _, alive = psutil.wait_procs(family, timeout=10)
    for each in alive:
        with suppress(psutil.NoSuchProcess):
            each.kill()
    psutil.wait_procs(alive, timeout=10)

"""A service of its own for a measurement: a new process on a free port of the loopback."""

import os
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import httpx
import psutil

from app.settings import ROOT

PATIENCE = 60.0  # seconds until a start has failed


@dataclass(frozen=True)
class Served:
    """A running service: a client of it, its process, and the seconds from its start to readiness."""

    client: httpx.Client
    process: psutil.Process
    seconds_to_ready: float


@contextmanager
def served(directory: Path, **settings: object) -> Iterator[Served]:
    """Start `microtexture serve`, wait until experiments can run, and stop it at the end.

    Parameters
    ----------
    directory : pathlib.Path
        The service's data.
    **settings
        Each becomes ``MICROTEXTURE_<NAME>``.
    """
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    variables = {f"MICROTEXTURE_{name.upper()}": str(value) for name, value in settings.items()}
    environment = {
        **os.environ,
        "MICROTEXTURE_LOG_LEVEL": "warning",
        **variables,
        "MICROTEXTURE_DATA_DIR": str(directory),
    }
    command = [str(ROOT / ".venv" / "bin" / "microtexture"), "serve", "--port", str(port)]
    with tempfile.TemporaryFile() as log:
        started = time.perf_counter()
        process = psutil.Popen(command, env=environment, stdout=log, stderr=log, cwd=ROOT)
        try:
            with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=120) as client:
                while not _ready(client):
                    if process.poll() is not None or time.perf_counter() - started > PATIENCE:
                        log.seek(0)
                        raise RuntimeError(f"The service did not start:\n{log.read().decode()[-3000:]}")
                    time.sleep(0.02)
                yield Served(client, process, time.perf_counter() - started)
        finally:
            process.terminate()
            try:
                process.wait(30)
            except subprocess.TimeoutExpired:
                process.kill()
                raise


def _ready(client: httpx.Client) -> bool:
    try:
        return client.get("/readyz").status_code == 200
    except httpx.TransportError:
        return False

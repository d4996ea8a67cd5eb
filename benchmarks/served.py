"""Service process for a measurement: a new one on a free port of the loopback interface."""

import os
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import psutil

from app.settings import ROOT

PATIENCE = 60.0  # seconds until a start has failed


@dataclass(frozen=True)
class Served:
    """A running service: a client of it, its process, and the seconds from its start until it was ready."""

    client: httpx.Client
    process: psutil.Process
    seconds_to_ready: float

    def wait_for_sample(self, sample_id: str) -> None:
        """Wait until a bundled photograph has come in; the service takes work before that."""
        until = time.monotonic() + PATIENCE
        while self.client.get(f"/api/v1/samples/{sample_id}").status_code != 200:
            if time.monotonic() > until:
                raise RuntimeError(f"The bundled sample {sample_id} did not come in.")
            time.sleep(0.05)

    def finish(self, body: dict[str, Any]) -> dict[str, Any]:
        """Send an experiment and return its finished record."""
        answer = self.client.post("/api/v1/experiments", json=body, headers={"Prefer": "wait=60"})
        while (record := answer.raise_for_status().json())["status"] in {"queued", "running"}:
            time.sleep(0.05)
            answer = self.client.get(record["url"])
        if record["status"] != "succeeded":
            raise RuntimeError(f"The experiment {record['status']}: {record['error']}")
        return dict(record)


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
        "MICROTEXTURE_CATALOGUE": "false",  # what it makes in the background is not what is measured
        "MICROTEXTURE_LIMITS": "false",  # one address asks for everything here
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

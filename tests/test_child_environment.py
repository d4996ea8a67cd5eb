"""No child process of a served one holds the operator's secrets, and nobody else runs code in its workers."""

import os
import socket
import ssl
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import psutil
import pytest
from distributed import Security

from app.child_environment import allowed
from tests.store.conftest import free_port

TOKEN, PASSWORD = "the-operators-own-token", "the-databases-password"
SECONDS = 60.0

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[psutil.Process]:
    """A service that can run experiments, with secrets in its environment."""
    port = free_port()
    secrets = {"MICROTEXTURE_OPERATOR_TOKEN": TOKEN, "SOME_DATABASE_URL": f"postgresql://u:{PASSWORD}@db/x"}
    settings = {"MICROTEXTURE_DATA_DIR": str(tmp_path_factory.mktemp("data")), "MICROTEXTURE_CATALOGUE": "false"}
    program = str(Path(sys.executable).parent / "microtexture")
    process = subprocess.Popen([program, "serve", "--port", str(port)], env=os.environ | secrets | settings)
    deadline = time.monotonic() + SECONDS
    try:
        ready = False
        while not ready:
            assert time.monotonic() < deadline
            try:
                ready = httpx.get(f"http://127.0.0.1:{port}/readyz").status_code == 200
            except httpx.TransportError:
                time.sleep(0.05)
        yield psutil.Process(process.pid)
    finally:
        process.terminate()
        process.wait(SECONDS)


def test_no_descendant_of_a_served_process_holds_a_secret(served: psutil.Process) -> None:
    """Neither workers nor what forks them, nor the decoder, whose only job is files of strangers."""
    family = served.children(recursive=True)
    assert len(family) >= 4
    for process in family:
        try:
            environment = process.environ()
        except psutil.NoSuchProcess:
            continue  # a decoder whose work is done
        assert not any(TOKEN in value or PASSWORD in value for value in environment.values())
        assert [name for name in environment if name.startswith("MICROTEXTURE")] == []
    assert served.environ()["MICROTEXTURE_OPERATOR_TOKEN"] == TOKEN  # which is why its children must not inherit it


def test_what_is_needed_to_start_and_to_compute_is_handed_on() -> None:
    given = {"PATH": "/bin", "OMP_NUM_THREADS": "1", "LC_ALL": "C", "AWS_SECRET_ACCESS_KEY": "x", "PORT": "80"}
    assert allowed(given) == {"PATH": "/bin", "OMP_NUM_THREADS": "1", "LC_ALL": "C"}


@pytest.mark.parametrize("certificate", ["none", "of its own"])
def test_another_process_of_this_machine_is_refused_by_the_engine(
    served: psutil.Process, tmp_path: Path, certificate: str
) -> None:
    """Scheduler, nannies and workers end the connection of whoever has no certificate of this engine."""
    context = ssl._create_unverified_context()
    if certificate == "of its own":
        stranger = Security.temporary()
        for name, text in (("key", stranger.tls_client_key), ("certificate", stranger.tls_client_cert)):
            (tmp_path / name).write_text(text)
        context.load_cert_chain(tmp_path / "certificate", tmp_path / "key")
    pids = {process.pid for process in (served, *served.children(recursive=True))}
    listening = [each for each in psutil.net_connections("tcp") if each.status == "LISTEN" and each.pid in pids]
    ports = {each.laddr.port for each in listening} - {int(served.cmdline()[-1])}
    assert len(ports) >= 3  # the scheduler's, and its workers' and nannies'
    for port in ports:
        with socket.create_connection(("127.0.0.1", port), timeout=2.0) as plain:
            try:
                with context.wrap_socket(plain) as connection:  # a server looks at the certificate after this
                    answer = connection.recv(1)
            except (ssl.SSLError, ConnectionResetError, TimeoutError):  # what speaks no TLS says nothing
                answer = b""
            assert answer == b""

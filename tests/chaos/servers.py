"""Servers that a service leans on, which can be stopped and started: PostgreSQL, an S3-compatible bucket."""

import os
import pwd
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.store.conftest import PROGRAMS, UNPRIVILEGED, as_unprivileged, free_port


class PostgreSQL:
    """A PostgreSQL of our own on loopback, durable as an operator's is."""

    def __init__(self) -> None:
        self._programs = PROGRAMS[-1] if PROGRAMS else Path(shutil.which("initdb") or "initdb").parent
        self._directory = Path(tempfile.mkdtemp(prefix="chaos-postgresql-"))
        if os.geteuid() == 0:
            os.chown(self._directory, pwd.getpwnam(UNPRIVILEGED).pw_uid, -1)
        self._port = free_port()
        self._do("initdb", "-D", f"{self._directory}/data", "-A", "trust", "-U", "texture", "-E", "UTF8", "--no-sync")
        self.start()
        self._do("createdb", "-h", "127.0.0.1", "-p", f"{self._port}", "-U", "texture", "texture")
        self.url = f"postgresql+psycopg://texture@127.0.0.1:{self._port}/texture"

    def start(self) -> None:
        options = f"-c listen_addresses=127.0.0.1 -c port={self._port} -c unix_socket_directories="
        self._control("-l", f"{self._directory}/log", "-o", options, "start")

    def stop(self) -> None:
        """Stop it as a loss of power would: it recovers from its log at the next start."""
        self._control("-m", "immediate", "stop")

    @contextmanager
    def stopped(self, seconds: float) -> Iterator[None]:
        self.stop()
        try:
            time.sleep(seconds)
            yield
        finally:
            self.start()

    def close(self) -> None:
        self.stop()
        shutil.rmtree(self._directory, ignore_errors=True)

    def _control(self, *arguments: str) -> None:
        self._do("pg_ctl", "-D", f"{self._directory}/data", "-w", *arguments)

    def _do(self, program: str, *arguments: str) -> None:
        command = as_unprivileged([f"{self._programs}/{program}", *arguments])
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=self._directory)

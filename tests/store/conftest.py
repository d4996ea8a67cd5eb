"""A real PostgreSQL on loopback, and every store backend."""

import os
import pwd
import shutil
import socket
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from uuid import uuid4

import psycopg
import pytest

from app.experiments.model import Sample
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.records import a_sample

PROGRAMS = sorted(Path("/usr/lib/postgresql").glob("*/bin"))
UNPRIVILEGED = "nobody"  # PostgreSQL refuses to run as root


def as_unprivileged(command: list[str]) -> list[str]:
    return ["runuser", "-u", UNPRIVILEGED, "--", *command] if os.geteuid() == 0 else command


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.fixture(scope="session")
def postgresql_server() -> Iterator[str]:
    """The address of a server of this session's own, without a database name."""
    programs = PROGRAMS[-1] if PROGRAMS else Path(shutil.which("initdb") or "initdb").parent
    directory = Path(tempfile.mkdtemp(prefix="postgresql-"))
    if os.geteuid() == 0:
        os.chown(directory, pwd.getpwnam(UNPRIVILEGED).pw_uid, -1)
    data, port = directory / "data", free_port()
    initialise = [f"{programs}/initdb", "-D", f"{data}", "-A", "trust", "-U", "texture", "-E", "UTF8", "--no-sync"]
    subprocess.run(as_unprivileged(initialise), check=True, capture_output=True, cwd=directory)
    options = f"-c listen_addresses=127.0.0.1 -c port={port} -c unix_socket_directories= -c fsync=off"
    control = [f"{programs}/pg_ctl", "-D", f"{data}", "-w"]
    start = [*control, "-l", f"{directory}/log", "-o", options, "start"]
    subprocess.run(as_unprivileged(start), check=True, capture_output=True, cwd=directory)
    try:
        yield f"postgresql+psycopg://texture@127.0.0.1:{port}"
    finally:
        subprocess.run(as_unprivileged([*control, "-m", "immediate", "stop"]), check=True, capture_output=True, cwd="/")
        shutil.rmtree(directory)


@pytest.fixture(params=["sqlite", "postgresql"])
def store_url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """The address of an empty database."""
    if request.param == "sqlite":
        return f"sqlite:///{tmp_path}/texture.sqlite3"
    server = request.getfixturevalue("postgresql_server")
    name = f"texture_{uuid4().hex}"
    with psycopg.connect(f"{server.replace('+psycopg', '')}/postgres", autocommit=True) as connection:
        connection.execute(f'CREATE DATABASE "{name}"')
    return f"{server}/{name}"


@pytest.fixture
def open_store(store_url: str) -> Iterator[Callable[[], SqlStore]]:
    """Open the database once more, as another process would."""
    opened = []

    def opening() -> SqlStore:
        opened.append(SqlStore(store_url))
        return opened[-1]

    yield opening
    for store in opened:
        store.close()


@pytest.fixture
def store(open_store: Callable[[], SqlStore]) -> SqlStore:
    return open_store()


@pytest.fixture
def queue(store: SqlStore) -> SqlQueue:
    return SqlQueue(store.database)


@pytest.fixture
def sample(store: SqlStore) -> Sample:
    sample = a_sample()
    store.add_sample(sample)
    return sample

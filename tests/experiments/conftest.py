"""A service with the inline engine, real files and a real photograph."""

import shutil
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.experiments import watching
from app.experiments.model import Experiment, Sample
from app.experiments.service import Service
from app.experiments.watching import Watching
from app.images.png_writer import encode_png
from app.methods.context import Context
from app.methods.model import Picture
from app.methods.registry import METHODS
from app.settings import Settings
from app.store.blobs import FileBlobs
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from app.worker import run_job
from tests.executor.inline import InlineExecutor
from tests.experiments.jobs import Breaking, submit
from tests.experiments.watched import PATIENCE, Backend, Clock, Follow

OPERATOR = "the operator's own token"


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return Settings(
        data_dir=tmp_path / "data",
        samples_dir=tmp_path / "no samples",
        operator_token=OPERATOR,
        queue_limit=3,
        max_output_pixels=1 << 16,
        threads=1,
    )


@pytest.fixture
def service(settings: Settings) -> Iterator[Service]:
    service = a_service(settings)
    service.start()
    yield service
    service.close()


def a_service(settings: Settings) -> Service:
    settings.data_dir.mkdir(exist_ok=True)
    store, blobs = SqlStore(settings.sql_url), FileBlobs(settings.data_dir / "files", settings.min_free_bytes)
    queue = SqlQueue(store.database)
    return Service(store, queue, blobs, InlineExecutor(settings, run_job, queue), settings)


@pytest.fixture
def photograph(tmp_path: Path) -> Path:
    """A small picture that is noise all over."""
    pixels = np.random.default_rng(7).integers(0, 256, (48, 64, 3), dtype=np.uint8)
    path = tmp_path / "photograph.png"
    path.write_bytes(encode_png(pixels))
    return path


@pytest.fixture
def upload(photograph: Path, tmp_path: Path) -> Path:
    """A copy that a test may give away."""
    return Path(shutil.copy(photograph, tmp_path / "upload"))


@pytest.fixture
def sample(service: Service, upload: Path) -> Sample:
    return service.samples.add(upload, None)


@pytest.fixture
def stored(settings: Settings) -> Callable[[], set[str]]:
    """Look up the names of all files below the data directory but the database's and the lock."""
    kept = {"microtexture.sqlite3", "microtexture.sqlite3-wal", "microtexture.sqlite3-shm", ".lock"}
    return lambda: {path.name for path in settings.data_dir.rglob("*") if path.is_file()} - kept


@pytest.fixture
def make_service(settings: Settings) -> Iterator[Callable[..., Service]]:
    """Make a service that is not started yet, on the same data; closed in the end."""
    made: list[Service] = []

    def making(other: Settings | None = None) -> Service:
        made.append(a_service(other or settings))
        return made[-1]

    yield making
    for service in made:
        service.close()


@pytest.fixture
def store(tmp_path: Path) -> Iterator[SqlStore]:
    """A store without a service."""
    store = SqlStore(f"sqlite:///{tmp_path}/alone.sqlite3")
    yield store
    store.close()


@pytest.fixture
def blobs(tmp_path: Path) -> FileBlobs:
    return FileBlobs(tmp_path / "files")


@pytest.fixture
def queued(store: SqlStore, blobs: FileBlobs) -> Experiment:
    """An experiment that no worker has begun."""
    return submit(store, blobs)


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> Breaking:
    """Let the method raise what is given, after its first picture."""
    original = METHODS["rpn"]

    def breaking(error: BaseException) -> None:
        def failing(sources: Any, params: Any, context: Context) -> Iterator[Picture]:
            yield next(iter(original.run(sources, params, context)))
            raise error

        monkeypatch.setitem(METHODS, "rpn", replace(original, run=failing))

    return breaking


@pytest.fixture
def follow(monkeypatch: pytest.MonkeyPatch) -> Iterator[Follow]:
    """Watch a backend, with pauses of milliseconds; afterwards nobody waits any more, and no thread is left."""
    monkeypatch.setattr(watching, "datetime", Clock)
    monkeypatch.setattr(watching, "POLL_SECONDS", 0.002)
    monkeypatch.setattr(watching, "REPEAT_SECONDS", PATIENCE)
    made: list[Watching] = []

    def watch(backend: Backend) -> Watching:
        made.append(Watching(backend, backend.states))  # type: ignore[arg-type] # as much of a store as is asked
        return made[-1]

    yield watch
    assert [each._watched for each in made] == [{}] * len(made)
    for thread in threading.enumerate():
        if thread.name == "watching":
            thread.join(PATIENCE)
            assert not thread.is_alive()

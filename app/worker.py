"""Wiring of a worker process: what `app.main` is for the service."""

from functools import lru_cache
from pathlib import Path

from app.experiments import run
from app.experiments.model import Lease
from app.settings import Settings
from app.store.blobs import FileBlobs
from app.store.queue import SqlQueue
from app.store.sql import SqlStore


def run_job(settings: Settings, lease: Lease) -> None:
    """Run one job with the store and the files that the settings name; they stay open for the next one."""
    store = _store(settings.sql_url)
    blobs = _blobs(settings.data_dir / "files")
    queue = SqlQueue(store.database)
    run.run_job(store, queue, blobs, lease, threads=settings.threads, time_limit=settings.time_limit)


@lru_cache(maxsize=4)
def _store(url: str) -> SqlStore:
    return SqlStore(url)


@lru_cache(maxsize=4)
def _blobs(directory: Path) -> FileBlobs:
    return FileBlobs(directory)

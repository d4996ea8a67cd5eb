"""Wiring of a worker process: what `app.main` is for the service."""

from functools import lru_cache
from pathlib import Path

from app.experiments import run
from app.methods.context import Progress
from app.settings import Settings
from app.store.blobs import FileBlobs
from app.store.sql import SqlStore


def run_job(settings: Settings, job: str, progress: Progress) -> None:
    """Run one job with the store and the files that the settings name; they stay open for the next one."""
    run.run_job(_store(settings.sql_url), _blobs(settings.data_dir / "files"), job, progress, threads=settings.threads)


@lru_cache(maxsize=4)
def _store(url: str) -> SqlStore:
    return SqlStore(url)


@lru_cache(maxsize=4)
def _blobs(directory: Path) -> FileBlobs:
    return FileBlobs(directory)

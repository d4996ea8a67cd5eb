"""Wiring of a worker process: what `app.main` is for the service."""

import logging
import logging.config
import os
from functools import lru_cache
from multiprocessing import parent_process
from pathlib import Path

from app.errors import InvalidInputError, NotFoundError
from app.executor.external import work_for
from app.experiments import run
from app.experiments.model import Lease
from app.settings import Settings
from app.store.blobs import FileBlobs
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from app.synthesis import __version__
from app.web.logs import Form, configuration

log = logging.getLogger(__name__)

__all__ = ["prove", "run_job", "work_for"]


def run_job(settings: Settings, lease: Lease) -> None:
    """Run one job with the store and the files that the settings name; they stay open for the next one."""
    if parent_process() is not None:
        _log_as_the_service(settings.log_format, settings.log_level)
    store = _store(settings.sql_url)
    blobs = _blobs(settings.data_dir / "files")
    queue = SqlQueue(store.database)
    log.info("job %s, lease %d: begun by process %d", lease.job, lease.fence, os.getpid())
    try:
        run.run_job(store, queue, blobs, lease, threads=settings.threads, time_limit=settings.time_limit)
    finally:
        log.info("job %s, lease %d: left by process %d", lease.job, lease.fence, os.getpid())


@lru_cache(maxsize=1)
def _log_as_the_service(form: Form, level: str) -> None:
    logging.config.dictConfig(configuration(form, level))


def prove(settings: Settings, version: str, digest: str) -> str:
    """Show that this process has the service's version, database and files: reads what it wrote, and writes itself.

    Parameters
    ----------
    settings : Settings
        The service's.
    version : str
        The service's.
    digest : str
        Of a file that the service has just put.

    Returns
    -------
    str
        Digest of a file that was put here.

    Raises
    ------
    InvalidInputError
        In words for the operator.
    """
    if version != __version__:
        raise InvalidInputError(f"It runs Microtexture {__version__}, the service {version}: install the same.")
    _store(settings.sql_url).ping()
    blobs = _blobs(settings.data_dir / "files")
    try:
        content = blobs.path(digest).read_bytes()
    except NotFoundError:
        raise InvalidInputError(
            f"It does not see the service's files in {blobs.directory}: mount the same directory there."
        ) from None
    return blobs.put(content + b" was read")


@lru_cache(maxsize=4)
def _store(url: str) -> SqlStore:
    return SqlStore(url)


@lru_cache(maxsize=4)
def _blobs(directory: Path) -> FileBlobs:
    return FileBlobs(directory)

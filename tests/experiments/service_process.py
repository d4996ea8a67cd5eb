"""A service with the Dask engine in a process of its own, until it is told to stop: ``service_process.py DATA_DIR``."""

import signal
import sys
from pathlib import Path

from app.executor.dask import DaskExecutor
from app.experiments.service import Service
from app.settings import Settings
from app.store.blobs import FileBlobs
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from app.worker import run_job

if __name__ == "__main__":
    settings = Settings(data_dir=Path(sys.argv[1]), samples_dir=Path(sys.argv[1]), workers=1, threads=1)
    store, blobs = SqlStore(settings.sql_url), FileBlobs(settings.data_dir / "files")
    queue = SqlQueue(store.database)
    service = Service(store, queue, blobs, DaskExecutor(settings, run_job, queue, store.ping), settings)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})
    service.start()
    signal.sigwait({signal.SIGTERM})
    service.close()

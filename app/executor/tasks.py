"""Tasks: the functions that run on the workers and nannies of a Dask cluster."""

import os
from typing import Any

from app.executor.memory import give_back
from app.experiments.model import Lease
from app.experiments.ports import Run
from app.settings import Settings


def work(run: Run, settings: Settings, lease: Lease) -> None:
    """Run one job in the thread of a worker. What it comes to is in the database; what kept it from that is raised."""
    try:
        run(settings, lease)
    finally:
        give_back()


def kill_worker(dask_worker: Any) -> None:
    """Kill the worker process of this nanny, which then starts another one."""
    dask_worker.process.process.kill()


def leave() -> None:
    """End this worker process at once."""
    os._exit(1)

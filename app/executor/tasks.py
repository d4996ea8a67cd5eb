"""Tasks: the functions that run on the workers and nannies of a Dask cluster."""

import logging
import os
import time
from typing import Any

from distributed import get_worker

from app.errors import AppError, CancelledError, TimeLimitError
from app.executor.memory import give_back
from app.executor.messages import out_of_time
from app.experiments.failures import BROKEN
from app.experiments.ports import Run
from app.settings import Settings

log = logging.getLogger(__name__)

REPORT_SECONDS = 0.1  # progress is sent at most so often

_cancelled: set[str] = set()  # jobs of this worker process that shall stop


def work(run: Run, settings: Settings, job: str, topic: str) -> None:
    """Run one job in the thread of a worker; what fails is reported in words for people."""
    report = Reporter(job, topic, settings.time_limit)
    try:
        run(settings, job, report)
    except CancelledError:
        pass
    except AppError as error:
        report.send(failure=error.message)
    except Exception:
        log.exception("job %s failed", job)
        report.send(failure=BROKEN)
    finally:
        _cancelled.discard(job)
        give_back()


def stop(job: str) -> None:
    """Let a job of this process end at its next call of progress; runs on the worker's event loop."""
    _cancelled.add(job)


def kill_worker(dask_worker: Any) -> None:
    """Kill the worker process of this nanny, which then starts another one."""
    dask_worker.process.process.kill()


def leave() -> None:
    """End this worker process at once."""
    os._exit(1)


class Reporter:
    """The progress that a method calls: tells the service, and raises when the job is to stop."""

    def __init__(self, job: str, topic: str, time_limit: float) -> None:
        self._worker = get_worker()
        self._job = job
        self._topic = topic
        self._time_limit = time_limit
        self._started = self._sent = time.monotonic()
        self.send()

    def __call__(self, stage: str, fraction: float) -> None:
        if self._job in _cancelled:
            raise CancelledError("The experiment was cancelled.")
        now = time.monotonic()
        if now - self._started > self._time_limit:
            raise TimeLimitError(out_of_time(self._time_limit))
        if now - self._sent >= REPORT_SECONDS:
            self._sent = now
            self.send(stage=stage, fraction=float(fraction))

    def send(self, **news: str | float) -> None:
        """Tell the service; it has it before it learns that the job is done, which takes the same way."""
        self._worker.log_event(self._topic, {"job": self._job, "worker": self._worker.address, **news})

"""Inline engine, for tests: runs jobs one at a time in a thread of this process; its contract is the Dask engine's."""

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import replace

from app.errors import AppError, CancelledError, TimeLimitError
from app.executor.messages import out_of_time
from app.experiments.failures import BROKEN
from app.experiments.model import Snapshot, Status
from app.experiments.ports import Ended, Run
from app.settings import Settings

log = logging.getLogger(__name__)


class InlineExecutor:
    """Runs one job after the other in one thread.

    Parameters
    ----------
    settings : Settings
        Given to ``run``; the time limit is kept at the method's next call of progress.
    run : callable ``(settings, job, progress)``
    """

    def __init__(self, settings: Settings, run: Run) -> None:
        self._settings = settings
        self._run = run
        self._changed = threading.Condition()
        self._queue: list[str] = []
        self._current: str | None = None
        self._cancelled = False
        self._snapshot = Snapshot(Status.RUNNING)
        self._started = 0.0
        self._open = False
        self._listeners: list[Callable[[str], None]] = []
        self._thread: threading.Thread | None = None
        self._ended: Ended | None = None

    def start(self, ended: Ended) -> None:
        self._ended = ended
        self._open = True
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()

    def close(self) -> None:
        with self._changed:
            self._open = False
            self._changed.notify_all()
        if self._thread is not None:
            self._thread.join()

    @property
    def ready(self) -> bool:
        return self._open

    @property
    def waiting(self) -> int:
        return len(self._queue)

    def submit(self, job: str) -> None:
        with self._changed:
            if job in self._queue or (job == self._current and not self._cancelled):
                return
            self._queue.append(job)
            self._changed.notify_all()

    def cancel(self, job: str) -> None:
        with self._changed:
            if job in self._queue:
                self._queue.remove(job)
            elif job == self._current:
                self._cancelled = True
            else:
                return
        self._tell(job)

    def snapshot(self, job: str) -> Snapshot | None:
        with self._changed:
            if job in self._queue:
                return Snapshot(Status.QUEUED, position=self._queue.index(job) + 1)
            if job == self._current and not self._cancelled:
                return replace(self._snapshot, elapsed=time.monotonic() - self._started)
            return None

    def subscribe(self, listener: Callable[[str], None]) -> Callable[[], None]:
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def _tell(self, *jobs: str) -> None:
        for listener in list(self._listeners):
            for job in jobs:
                listener(job)

    def _work(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._queue or not self._open)
                if not self._open:
                    return
                job = self._current = self._queue.pop(0)
                self._cancelled = False
                self._snapshot = Snapshot(Status.RUNNING)
                self._started = time.monotonic()
                waiting = list(self._queue)
            self._tell(job, *waiting)
            failure = self._failure_of(job)
            if self._open and self._ended is not None:
                self._ended(job, failure)
            with self._changed:
                self._current = None
            self._tell(job)

    def _failure_of(self, job: str) -> str | None:
        try:
            self._run(self._settings, job, self._progress)
        except CancelledError:
            return None
        except AppError as error:
            return error.message
        except Exception:
            log.exception("job %s failed", job)
            return BROKEN
        return None

    def _progress(self, stage: str, fraction: float) -> None:
        if self._cancelled or not self._open:
            raise CancelledError("The experiment was cancelled.")
        if time.monotonic() - self._started > self._settings.time_limit:
            raise TimeLimitError(out_of_time(self._settings.time_limit))
        with self._changed:
            job = self._current
            self._snapshot = Snapshot(Status.RUNNING, fraction=fraction, stage=stage)
        if job is not None:
            self._tell(job)

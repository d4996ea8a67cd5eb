"""Inline engine, for tests: runs what waits in the queue one at a time in a thread of this process."""

import logging
import threading
from collections.abc import Callable

from app.errors import UnavailableError
from app.executor.dispatched import Dispatched, Verdict
from app.executor.endings import Endings
from app.experiments.ports import JobQueue, Records, Run
from app.settings import Settings

log = logging.getLogger(__name__)


class InlineExecutor:
    """Runs one job after the other in one thread.

    Parameters
    ----------
    settings : Settings
        Given to ``run``.
    run : callable ``(settings, lease)``
    queue : JobQueue
    """

    def __init__(self, settings: Settings, run: Run, queue: JobQueue) -> None:
        self._settings = settings
        self._run = run
        self._queue = queue
        self._changed = threading.Condition()
        self._woken = True
        self._open = False
        self._listeners: list[Callable[[str], None]] = []
        self._thread: threading.Thread | None = None

    def start(self, records: Records) -> None:
        self._endings = Endings(self._queue, records, self._settings.time_limit)
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

    def wake(self) -> None:
        with self._changed:
            self._woken = True
            self._changed.notify_all()

    def subscribe(self, listener: Callable[[str], None]) -> Callable[[], None]:
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def _tell(self, job: str) -> None:
        for listener in list(self._listeners):
            listener(job)

    def _work(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._woken or not self._open)
                if not self._open:
                    return
                self._woken = False
            while self._open and (lease := self._queue.lease("inline", alone=True)) is not None:
                run = Dispatched(lease, "inline", 0.0)
                self._tell(lease.job)
                found = Verdict.RECORDED
                try:
                    self._run(self._settings, lease)
                except UnavailableError:
                    found = Verdict.UNAVAILABLE
                except Exception:
                    log.exception("job %s failed outside the method", lease.job)
                self._endings.conclude(run, found)
                self._tell(lease.job)

"""Heartbeat of a run: keeps its lease while it computes, brings its progress, and tells it to stop."""

import logging
import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Self, TypeVar

from app.errors import CancelledError, TimeLimitError, UnavailableError
from app.experiments.failures import out_of_time
from app.experiments.model import Lease
from app.experiments.ports import JobQueue

log = logging.getLogger(__name__)

LOOK_SECONDS = 0.5  # how often it looks whether the lease is held still, and writes progress at most
BEAT_SECONDS = 2.0  # how often the lease is renewed where there is no progress
PATIENCE_SECONDS = 120.0  # how long what was computed is offered to a database that is away
FIRST_PAUSE, LONGEST_PAUSE = 0.25, 5.0

_Result = TypeVar("_Result")


class Heartbeat:
    """The progress that a method calls, and the thread that keeps its lease meanwhile.

    A database that is away for a while ends nothing: the method computes on, and the lease is renewed afterwards
    unless another engine has taken it.

    Parameters
    ----------
    queue : JobQueue
    lease : Lease
    time_limit : float
        Seconds that the run may take.
    """

    def __init__(self, queue: JobQueue, lease: Lease, time_limit: float) -> None:
        self._queue = queue
        self._lease = lease
        self._time_limit = time_limit
        self._began = time.monotonic()
        self._news: tuple[str | None, float] = (None, 0.0)
        self._held = True
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._beat, name="heartbeat", daemon=True)

    def __enter__(self) -> Self:
        self._held = self._queue.renew(self._lease, None, 0.0)
        if self._held:
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ended.set()

    @property
    def held(self) -> bool:
        """Whether the lease was held when it was looked at last."""
        return self._held

    def __call__(self, stage: str, fraction: float) -> None:
        """Take the progress of the run.

        Raises
        ------
        CancelledError
            If the experiment was cancelled, or taken by another engine.
        TimeLimitError
            If its time is over.
        """
        self._news = (stage, float(fraction))
        if not self._held:
            raise CancelledError("The experiment was cancelled.")
        if time.monotonic() - self._began > self._time_limit:
            raise TimeLimitError(out_of_time(self._time_limit))

    def _beat(self) -> None:
        told, renewed, away = self._news, time.monotonic(), False
        while not self._ended.wait(LOOK_SECONDS):
            news = self._news
            try:
                if news != told or time.monotonic() - renewed >= BEAT_SECONDS:
                    self._held = self._queue.renew(self._lease, *news)
                    told, renewed = news, time.monotonic()
                else:
                    self._held = self._queue.holds(self._lease)
                away = False
            except UnavailableError as error:
                if not away:
                    log.warning("job %s computes on while its lease cannot be renewed: %s", self._lease.job, error)
                away = True
            except Exception:
                log.exception("the lease of job %s could not be renewed; it will be tried again", self._lease.job)
            if not self._held:
                return


def patiently(record: Callable[[], _Result]) -> _Result:
    """Record what was computed, again and again while the database is away.

    Raises
    ------
    UnavailableError
        If it stayed away for `PATIENCE_SECONDS`.
    """
    deadline, pause = time.monotonic() + PATIENCE_SECONDS, FIRST_PAUSE
    while True:
        try:
            return record()
        except UnavailableError:
            if time.monotonic() + pause > deadline:
                raise
        time.sleep(pause)
        pause = min(2 * pause, LONGEST_PAUSE)

"""Dask executor: runs jobs on a Dask cluster, with our own queue before it, limits and recovery around it."""

import logging
import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from typing import Any

from distributed import Future
from distributed.scheduler import KilledWorker

from app.executor.dispatched import Dispatched, verdict
from app.executor.engine import Engine
from app.experiments.model import Snapshot, Status
from app.experiments.ports import Ended, Run
from app.settings import Settings

log = logging.getLogger(__name__)

TICK_SECONDS = 0.25  # how often limits are looked at
WORKERS_SECONDS = 5.0  # how often the list of workers is asked for, besides when it is known to have changed
GRACE_SECONDS = 2.0  # how long a job may take to stop when asked politely
SILENCE_SECONDS = 30.0  # how long a worker may take to report that it has begun
FIRST_PAUSE_SECONDS, LONGEST_PAUSE_SECONDS = 0.5, 30.0  # before the engine is opened again
START_SECONDS = 30.0  # how long the start waits for a scheduler that is not there yet


class DaskExecutor:
    """Runs jobs on a Dask cluster, one per worker thread, the rest in a queue of its own.

    Dask is never given more jobs than it has threads: places in the queue are exact, and a worker that is killed throws
    suspicion on its own job only.

    Parameters
    ----------
    settings : Settings
        ``scheduler`` is the address of a cluster; without it, ``workers`` processes are started here.
    run : callable ``(settings, job, progress)``
        A function that the workers can import.
    """

    def __init__(self, settings: Settings, run: Run) -> None:
        self._settings = settings
        self._run = run
        self._state = threading.Condition()  # guards all below
        self._queue: list[str] = []
        self._runs: dict[str, Dispatched] = {}
        self._deaths: Counter[str] = Counter()
        self._left: list[Dispatched] = []
        self._slots: dict[str, int] = {}
        self._condemned: set[str] = set()
        self._workers_known = 0.0
        self._woken = False
        self._open = False
        self._ready = False
        self._listeners: list[Callable[[str], None]] = []
        self._engine: Engine | None = None
        self._thread: threading.Thread | None = None
        self._ended: Ended | None = None

    # for the service

    def start(self, ended: Ended) -> None:
        """Return when jobs can run; a scheduler that does not answer for long is waited for in the background."""
        self._ended = ended
        self._open = True
        self._thread = threading.Thread(target=self._dispatch, name="dispatcher", daemon=True)
        self._thread.start()
        with self._state:
            self._state.wait_for(lambda: self._ready, START_SECONDS)

    def close(self) -> None:
        with self._state:
            self._open = self._ready = False
            self._wake()
        if self._thread is not None:
            self._thread.join()
        if self._engine is not None:
            self._engine.close()

    @property
    def ready(self) -> bool:
        return self._ready

    @property
    def waiting(self) -> int:
        return len(self._queue)

    def submit(self, job: str) -> None:
        with self._state:
            run = self._runs.get(job)
            if job in self._queue or (run is not None and run.cancelled is None):
                return
            self._queue.append(job)
            self._wake()

    def cancel(self, job: str) -> None:
        with self._state:
            run = self._runs.get(job)
            if job in self._queue:
                self._queue.remove(job)
                moved = list(self._queue)
            elif run is not None and run.cancelled is None:
                run.cancelled = time.monotonic()
                moved = []
                self._wake()
            else:
                return
        self._tell(job, *moved)

    def snapshot(self, job: str) -> Snapshot | None:
        with self._state:
            if job in self._queue:
                return Snapshot(Status.QUEUED, position=self._queue.index(job) + 1)
            run = self._runs.get(job)
            if run is None or run.cancelled is not None:
                return None
            elapsed = time.monotonic() - (run.started or run.sent)
            return Snapshot(Status.RUNNING, fraction=run.fraction, stage=run.stage, elapsed=elapsed)

    def subscribe(self, listener: Callable[[str], None]) -> Callable[[], None]:
        self._listeners.append(listener)
        return partial(self._listeners.remove, listener)

    # from Dask's threads

    def _on_progress(self, message: Mapping[str, Any]) -> None:
        with self._state:
            run = self._runs.get(message["job"])
            if run is None:
                return
            run.address = message["worker"]
            run.started = run.started or time.monotonic()
            run.stage = message.get("stage", run.stage)
            run.fraction = message.get("fraction", run.fraction)
            run.failure = message.get("failure")
        self._tell(run.job)

    def _on_workers(self) -> None:
        with self._state:
            self._workers_known = 0.0
            self._wake()

    def _on_done(self, run: Dispatched, future: "Future[None]") -> None:
        with self._state:
            self._left.append(run)
            self._wake()

    # the dispatcher's thread

    def _dispatch(self) -> None:
        left: list[Dispatched] = []
        while self._open:
            try:
                for run in left:
                    self._leave(run)
                self._keep_engine()
                self._keep_limits()
                self._fill()
            except Exception:
                log.exception("the dispatcher stumbled; it goes on")
            with self._state:
                self._state.wait_for(lambda: self._woken, TICK_SECONDS)
                self._woken = False
                left, self._left = self._left, []

    def _leave(self, run: Dispatched) -> None:
        """A task has left Dask, one way or the other."""
        if self._runs.get(run.job) is not run or run.future is None:
            return
        status, error = run.future.status, None
        if status == "error":
            error = run.future.exception()
        if status != "finished" and self._engine is not None:
            with suppress(Exception):
                self._engine.forget(run.future)
        run.future.release()
        if isinstance(error, KilledWorker):
            self._deaths[run.job] += 1
        again, failure = verdict(run, status, error, deaths=self._deaths[run.job], time_limit=self._settings.time_limit)
        if not again:
            self._deaths.pop(run.job, None)
            if self._ended is not None:
                self._ended(run.job, failure)
        with self._state:
            del self._runs[run.job]
            if again and run.job not in self._queue:
                self._queue.insert(0, run.job)
            moved = list(self._queue) if again else []
        self._tell(run.job, *moved)

    def _keep_limits(self) -> None:
        """Stop what was cancelled or takes too long: first politely, then by killing its worker."""
        now = time.monotonic()
        for run in list(self._runs.values()):
            engine = self._engine
            if run.forced or engine is None or run.future is None:
                continue
            if run.cancelled is not None:
                if not run.stop_sent:
                    run.stop_sent = True
                    engine.stop(run.job)
                overdue = now - run.cancelled > GRACE_SECONDS
            else:
                began = run.sent + SILENCE_SECONDS if run.started is None else run.started
                overdue = run.out_of_time = now - began > self._settings.time_limit + GRACE_SECONDS
            if overdue:
                run.forced = True
                self._condemned.add(run.address)
                engine.forget(run.future)
                engine.kill(run.address)

    def _keep_engine(self) -> None:
        """Open the engine, again if it was lost; then what it had runs anew."""
        if self._engine is not None and self._engine.alive:
            return
        if self._engine is not None:
            log.warning("the engine was lost; opening another one")
            self._give_up(self._engine)
        pause = FIRST_PAUSE_SECONDS
        while self._open:
            try:
                self._engine = Engine(
                    self._settings, self._run, on_progress=self._on_progress, on_workers=self._on_workers
                )
                return
            except Exception:
                log.exception("the engine cannot be opened; next attempt in %g seconds", pause)
            with self._state:
                self._state.wait_for(lambda: not self._open, pause)
            pause = min(2 * pause, LONGEST_PAUSE_SECONDS)

    def _give_up(self, engine: Engine) -> None:
        with self._state:
            self._ready = False
            self._engine = None
            lost, self._runs = list(self._runs.values()), {}
            again = [run.job for run in lost if run.cancelled is None and run.job not in self._queue]
            self._queue[:0] = again
            self._slots = {}
            self._condemned.clear()
            self._workers_known = 0.0
        for run in lost:
            if run.cancelled is not None and self._ended is not None:
                self._ended(run.job, None)
        self._tell(*(run.job for run in lost))
        engine.close()

    def _fill(self) -> None:
        """Give every idle worker thread the next job."""
        engine = self._engine
        if engine is None:
            return
        now = time.monotonic()
        if now - self._workers_known > WORKERS_SECONDS:
            self._workers_known = now
            self._slots = engine.workers()
            self._condemned &= self._slots.keys()
            with self._state:
                self._ready = bool(self._slots)
                self._state.notify_all()
        busy = Counter(run.address for run in self._runs.values())
        for address, threads in self._slots.items():
            if address not in self._condemned:
                for _ in range(threads - busy[address]):
                    self._send(engine, address)

    def _send(self, engine: Engine, address: str) -> None:
        with self._state:
            job = next((job for job in self._queue if job not in self._runs), None)
            if job is None:
                return
            self._queue.remove(job)
            run = self._runs[job] = Dispatched(job, address, time.monotonic())
            moved = list(self._queue)
        try:
            run.future = engine.submit(job, address)
        except Exception:
            with self._state:
                del self._runs[job]
                self._queue.insert(0, job)
            raise
        run.future.add_done_callback(partial(self._on_done, run))
        self._tell(job, *moved)

    def _wake(self) -> None:
        self._woken = True
        self._state.notify_all()

    def _tell(self, *jobs: str) -> None:
        for listener in list(self._listeners):
            for job in jobs:
                listener(job)

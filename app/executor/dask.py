"""Dask executor: leases jobs from the queue in the database and runs them on a Dask cluster."""

import logging
import threading
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from functools import partial

from distributed import Future

from app.errors import UnavailableError
from app.executor.backoff import Backoff
from app.executor.dispatched import Dispatched, Verdict, verdict
from app.executor.endings import Endings
from app.executor.engine import Engine
from app.executor.keeper import EngineKeeper, Prove
from app.executor.lapses import Lapses
from app.experiments.model import Beat, Lease
from app.experiments.ports import JobQueue, Records, Run
from app.settings import Settings

log = logging.getLogger(__name__)
TICK_SECONDS = 0.25  # how often the dispatcher looks about itself
LOOK_SECONDS = 0.5  # how often it looks at the leases, and for jobs that others queued
GRACE_SECONDS = 1.25  # how long a run that nobody wants may take to stop by itself
SILENCE_SECONDS = 10.0  # how long a worker may take to begin, less than a lease lasts; and to leave after the record
FIRST_PAUSE_SECONDS, LONGEST_PAUSE_SECONDS = 0.5, 15.0  # before database and storage are tried again
START_SECONDS = 30.0  # how long the start waits for a scheduler that is not there yet


class DaskExecutor:
    """Runs jobs on a Dask cluster, one per worker thread; what waits, waits in the database.

    Parameters
    ----------
    settings : Settings
        ``scheduler`` is the address of a cluster; without it, ``workers`` processes are started here.
    run : callable ``(settings, lease)``
        A function that the workers can import.
    queue : JobQueue
    probe : callable
        Raises `UnavailableError` while jobs could not use the database or the storage.
    on_hopeless, prove : callable, optional, see `EngineKeeper`
    """

    def __init__(
        self,
        settings: Settings,
        run: Run,
        queue: JobQueue,
        probe: Callable[[], None],
        on_hopeless: Callable[[], None] = lambda: None,
        prove: Prove | None = None,
    ) -> None:
        self._settings = settings
        self._queue = queue
        self._probe = probe
        self._keeper = EngineKeeper(settings, run, self._awaken, on_hopeless, prove)
        self._lapses = Lapses()
        self._away = Backoff(FIRST_PAUSE_SECONDS, LONGEST_PAUSE_SECONDS)
        self._looked = 0.0
        self._runs: list[Dispatched] = []
        self._state = threading.Condition()  # guards what other threads change: all below
        self._left: list[Dispatched] = []
        self._queued = True
        self._woken = False
        self._open = self._closed = self._ready = False
        self._listeners: list[Callable[[str], None]] = []
        self._thread: threading.Thread | None = None

    # for the service

    def start(self, records: Records) -> None:
        self._records = records
        self._endings = Endings(self._queue, records, self._settings.time_limit)
        with self._state:
            if self._closed:
                return
            self._open = True
        self._thread = threading.Thread(target=self._dispatch, name="dispatcher", daemon=True)
        self._thread.start()
        with self._state:
            self._state.wait_for(lambda: self._ready or not self._open, START_SECONDS)

    def close(self) -> None:
        with self._state:
            self._closed = True
            self._open = self._ready = False
            self._woken = True
            self._state.notify_all()
        if self._thread is not None:
            self._thread.join()
        self._keeper.close()
        for run in self._runs:
            self._endings.release(run)
        self._runs = []

    @property
    def ready(self) -> bool:
        return self._ready

    def wake(self) -> None:
        self._queued = True
        self._awaken()

    def subscribe(self, listener: Callable[[str], None]) -> Callable[[], None]:
        self._listeners.append(listener)
        return partial(self._listeners.remove, listener)

    # from any thread

    def _awaken(self) -> None:
        with self._state:
            self._woken = True
            self._state.notify_all()

    def _on_done(self, run: Dispatched, future: "Future[None]") -> None:
        with self._state:
            self._left.append(run)
        self._awaken()

    # the dispatcher's thread

    def _dispatch(self) -> None:
        while self._open:
            self._carefully(self._keep_engine)
            if not self._away.failing or self._has_come_back():
                with self._state:
                    left, self._left = self._left, []
                for run in left:
                    if not self._carefully(self._leave, run):
                        with self._state:
                            self._left.append(run)
                self._carefully(self._look)
                if not self._away.failing:
                    self._carefully(self._fill)
            with self._state:
                self._state.wait_for(lambda: self._woken, TICK_SECONDS)
                self._woken = False

    def _carefully(self, part: Callable[..., None], *arguments: Dispatched) -> bool:
        """Do a part of the round; whether that went well. What goes wrong in it keeps the others from nothing."""
        try:
            part(*arguments)
            return True
        except UnavailableError as error:
            self._pause(error)
        except Exception:
            log.exception("the dispatcher stumbled; it goes on")
        return False

    def _pause(self, error: UnavailableError) -> None:
        if not self._away.failing:
            log.warning("no job is begun for now: %s", error)
        self._away.fail()
        self._lapses.forget()

    def _has_come_back(self) -> bool:
        if not self._away.due:
            return False
        with suppress(UnavailableError):
            self._probe()
            self._away.recover()
        if self._away.failing:
            self._away.fail()
            return False
        log.warning("database and storage answer: jobs go on")
        return True

    def _keep_engine(self) -> None:
        """Keep the engine and the list of its workers; whose worker is gone has lost it."""
        if self._keeper.keep():
            self._set_ready(False)
            lost, self._runs = self._runs, []
            for run in lost:
                if self._settings.scheduler is None:  # they ended with their engine; others' workers may go on
                    self._endings.release(run)
                self._tell(run.lease.job)
        if self._keeper.refresh():
            self._set_ready(bool(self._keeper.workers))
            for run in self._runs:
                if run.address not in self._keeper.workers and not run.orphaned:
                    run.orphaned = True
                    self._forget(run)

    def _set_ready(self, ready: bool) -> None:
        with self._state:
            self._ready = ready and self._open
            self._state.notify_all()

    def _leave(self, run: Dispatched) -> None:
        """A task has left Dask, one way or the other."""
        if run not in self._runs or run.future is None:
            return
        status, error = run.future.status, None
        if status == "error":
            error = run.future.exception()
        if run.orphaned and run.begun is None and any(_is_of(run, beat) for beat in self._queue.beats() if beat.beat):
            run.begun = time.monotonic()  # too short a time ago for a look to see it
        found = verdict(run, status, error, embedded=self._settings.scheduler is None)
        self._endings.conclude(run, found)
        self._runs.remove(run)
        if found is Verdict.RECORDED:
            self._away.succeed()
        elif isinstance(error, UnavailableError):
            self._pause(error)
        if status != "finished":
            self._forget(run)
        run.future.release()
        self._queued = True
        self._tell(run.lease.job)

    def _look(self) -> None:
        """Look at all leases: find those that lapsed, and what became of our own."""
        now = time.monotonic()
        if now - self._looked < LOOK_SECONDS:
            return
        self._looked, self._queued = now, True
        beats = {(beat.job, beat.fence): beat for beat in self._queue.beats()}
        for beat in self._lapses.look(list(beats.values())):
            if self._queue.lapse(beat.job, beat.fence, beat.beat):
                log.warning("job %s: its worker gave no sign of life; it will run again", beat.job)
                self._tell(beat.job)
        for run in self._runs:
            found = beats.get((run.lease.job, run.lease.fence))
            if found is None:
                run.gone = run.gone or now
            elif run.begun is None and found.beat > 0:
                run.begun = now
                self._tell(run.lease.job)
            self._keep_limits(run, now)

    def _keep_limits(self, run: Dispatched, now: float) -> None:
        """Stop what nobody wants or what takes too long by killing its worker, for it did not stop by itself."""
        if run.forced or run.withdrawn or run.orphaned:
            return
        if run.gone is not None:
            waited = now - run.gone
            if waited <= GRACE_SECONDS or (waited <= SILENCE_SECONDS and not self._records.stopped(run.lease.job)):
                return
        elif run.begun is None:
            run.withdrawn = now - run.sent > SILENCE_SECONDS
            if run.withdrawn:
                log.warning("job %s: the worker %s did not begin it; it will run elsewhere", run.lease.job, run.address)
                self._forget(run)
            return
        else:
            run.out_of_time = now - run.begun > self._settings.time_limit + 2 * GRACE_SECONDS
            if not run.out_of_time:
                return
        log.warning("job %s does not stop: its worker %s is killed", run.lease.job, run.address)
        self._keeper.kill(run.address)
        run.forced = True
        self._forget(run)

    def _fill(self) -> None:
        """Lease a job for every idle worker thread."""
        engine, workers = self._keeper.engine, self._keeper.usable
        if engine is None or not workers or not self._queued:
            return
        self._queued = False  # a job that comes from now on sets it again
        if not self._queue.waiting():
            return
        busy = Counter(run.address for run in self._runs)
        if self._settings.scheduler is not None:
            busy |= Counter(engine.busy())  # others use it too
        for address, threads in workers.items():
            for _ in range(threads - busy[address]):
                if any(run.lease.last for run in self._runs):
                    return  # it runs alone
                lease = self._queue.lease(engine.name, alone=not self._runs)
                if lease is None:
                    return
                self._send(engine, lease, address)

    def _send(self, engine: Engine, lease: Lease, address: str) -> None:
        run = Dispatched(lease, address, time.monotonic())
        try:
            run.future = engine.submit(lease, address)
        except BaseException:
            self._endings.release(run)
            raise
        self._runs.append(run)
        run.future.add_done_callback(partial(self._on_done, run))
        self._tell(lease.job)

    def _forget(self, run: Dispatched) -> None:
        with suppress(Exception):  # the engine may be lost, and is looked after on its own
            if self._keeper.engine is not None and run.future is not None:
                self._keeper.engine.forget(run.future)

    def _tell(self, job: str) -> None:
        for listener in list(self._listeners):
            listener(job)


def _is_of(run: Dispatched, beat: Beat) -> bool:
    return (beat.job, beat.fence) == (run.lease.job, run.lease.fence)

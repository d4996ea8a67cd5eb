"""Progress of experiments: snapshots, and awaiting changes. One poll in this process serves everybody who waits."""

import asyncio
import logging
import threading
import time
from collections.abc import AsyncGenerator, Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime

import anyio.to_thread

from app.errors import AppError, DeletedError, NotFoundError
from app.experiments.model import DEEP, Experiment, Snapshot, Status
from app.experiments.ports import ExperimentStore

log = logging.getLogger(__name__)

POLL_SECONDS = 0.5
REPEAT_SECONDS = 4.0  # a state that stays is told again so often: after 5 s of silence pages ask for the record
GROUP, GROUP_SECONDS = 25, 0.01  # so many are told at once, and the next so many a moment later
SILENCE_SECONDS = 15.0  # without a state, as while the database is away

Source = Callable[[Collection[str]], Mapping[str, Snapshot]]
"""``source(jobs)``: those of the jobs that wait or run"""


@dataclass(frozen=True)
class _State:
    """What a look at a job found."""

    #: None of an output at 16 bits that is in the queue no more.
    snapshot: Snapshot | None = None
    #: Of one that has finished.
    experiment: Experiment | None = None
    #: That there is no such experiment, or no more.
    error: AppError | None = None

    @property
    def final(self) -> bool:
        return self.snapshot is None or self.experiment is not None

    def differs(self, other: "_State") -> bool:
        """Whether anything but the seconds is another."""
        if self.snapshot is None or other.snapshot is None:
            return self != other
        return replace(self.snapshot, elapsed=0.0) != replace(other.snapshot, elapsed=0.0)

    def has_status_of(self, other: "_State") -> bool:
        if self.snapshot is None or other.snapshot is None:
            return self == other
        return self.snapshot.status is other.snapshot.status


class _Watcher:
    """Somebody who waits: who is slow gets the newest state, not all of them."""

    def __init__(self) -> None:
        self.loop = asyncio.get_running_loop()
        self._state = _State()
        self._number = 0
        self._changed = asyncio.Event()

    def deliver(self, number: int, state: _State) -> None:
        """Hand a state over, unless a later one was; called by the event loop."""
        if number > self._number:
            self._number, self._state = number, state
            self._changed.set()

    async def next(self, seconds: float | None) -> _State | None:
        """Await the next state; None after this many seconds."""
        with suppress(TimeoutError):
            async with asyncio.timeout(seconds):  # `wait_for` of Python 3.11 drops a cancellation that comes with it
                await self._changed.wait()
        if not self._changed.is_set():
            return None
        self._changed.clear()
        if self._state.error is not None:
            raise self._state.error.with_traceback(None)  # others raise it too
        return self._state


@dataclass
class _Watched:
    """A job that somebody waits for."""

    watchers: set[_Watcher] = field(default_factory=set)
    state: _State | None = None
    told: float = 0.0
    number: int = 0


class Watching:
    """Snapshots, and coroutines that wake when one changes.

    Everybody who waits is served by one thread, which looks at all jobs that are waited for every half second, at those
    of which it is notified at once, and lives as long as somebody waits. What cannot be read for now is waited for.

    Parameters
    ----------
    store : ExperimentStore
        Asked for what neither waits nor runs.
    source : callable ``(jobs)``
        Gives the snapshots of those of the jobs that wait or run.
    """

    def __init__(self, store: ExperimentStore, source: Source) -> None:
        self._store = store
        self._source = source
        self._changed = threading.Condition()  # guards all below
        self._watched: dict[str, _Watched] = {}
        self._due: set[str] = set()
        self._polling = False
        self._failed = False  # of the thread alone

    def notify(self, job: str) -> None:
        """Look at this job at once if somebody waits for it; from any thread."""
        with self._changed:
            if job in self._watched:
                self._due.add(job)
                self._changed.notify_all()

    def snapshot(self, experiment_id: str) -> Snapshot:
        """Read the state of this moment. Raises `NotFoundError` or `DeletedError`."""
        found = self._source([experiment_id]).get(experiment_id)
        return found or _snapshot_of(self._store.get(experiment_id))

    async def wait(self, experiment_id: str, seconds: float) -> Experiment:
        """Return the experiment once it has finished, or as it is after this many seconds."""
        deadline = time.monotonic() + seconds
        with self._watch(experiment_id) as watcher:
            while (state := await watcher.next(deadline - time.monotonic())) is not None:
                if state.experiment is not None:
                    return state.experiment
        return await anyio.to_thread.run_sync(self._store.get, experiment_id)

    async def watch(self, experiment_id: str) -> AsyncGenerator[Snapshot | None, None]:
        """Yield every change, several at once if they come fast; end after the finished state.

        What waits is told again every few seconds; None says that nothing could be read for `SILENCE_SECONDS`.
        """
        with self._watch(experiment_id) as watcher:
            while True:
                state = await watcher.next(SILENCE_SECONDS)
                yield None if state is None else state.snapshot
                if state is not None and state.final:
                    return

    async def wait_until_left(self, job: str, seconds: float) -> bool:
        """Return True once this job neither waits nor runs, or False after so many seconds."""
        deadline = time.monotonic() + seconds
        with self._watch(job) as watcher:
            while (state := await watcher.next(deadline - time.monotonic())) is not None:
                if state.final:
                    return True
        return False

    @contextmanager
    def _watch(self, job: str) -> Iterator[_Watcher]:
        watcher = _Watcher()
        with self._changed:
            watched = self._watched.setdefault(job, _Watched())
            watched.watchers.add(watcher)
            if watched.state is not None:
                watcher.deliver(watched.number, watched.state)
            else:
                self._due.add(job)
                self._changed.notify_all()
            if not self._polling:
                self._polling = True
                threading.Thread(target=self._poll, name="watching", daemon=True).start()
        try:
            yield watcher
        finally:
            with self._changed:
                watched.watchers.discard(watcher)
                if not watched.watchers and self._watched.get(job) is watched:
                    del self._watched[job]
                    self._changed.notify_all()

    # the thread's

    def _poll(self) -> None:
        """Look at all jobs by and by, at those that are due at once, until nobody waits any more."""
        round_at = time.monotonic() + POLL_SECONDS
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._due or not self._watched, round_at - time.monotonic())
                if not self._watched:
                    self._polling = False
                    return
                in_turn = time.monotonic() >= round_at
                jobs = list(self._watched if in_turn else self._due & self._watched.keys())
                self._due.clear()
            try:
                for job, state in self._look(jobs):
                    self._tell(job, state, in_turn)
            except Exception as error:
                if not self._failed:
                    log.warning("experiments cannot be watched for now: %s", error)
                self._failed = True
            else:
                self._failed = False
            if in_turn:
                round_at = time.monotonic() + POLL_SECONDS

    def _look(self, jobs: Collection[str]) -> Iterator[tuple[str, _State]]:
        snapshots = self._source(jobs) if jobs else {}
        for job in jobs:
            if (snapshot := snapshots.get(job)) is not None:
                yield job, _State(snapshot)
            elif DEEP in job:
                yield job, _State()
            else:
                yield job, self._read(job)

    def _read(self, experiment_id: str) -> _State:
        try:
            experiment = self._store.get(experiment_id)
        except (NotFoundError, DeletedError) as error:
            return _State(error=error)
        return _State(_snapshot_of(experiment), experiment if experiment.status.finished else None)

    def _tell(self, job: str, state: _State, in_turn: bool) -> None:
        """Hand a state to all who wait for the job, if it is news."""
        now = time.monotonic()
        with self._changed:
            watched = self._watched.get(job)
            if watched is None:
                return
            if watched.state is not None and not _is_news(state, watched.state, now - watched.told, in_turn):
                return
            watched.state, watched.told, watched.number = state, now, watched.number + 1
            if state.final:
                del self._watched[job]  # who comes later looks anew: it may be made again
            watchers: dict[asyncio.AbstractEventLoop, list[_Watcher]] = {}
            for watcher in watched.watchers:
                watchers.setdefault(watcher.loop, []).append(watcher)
        for loop, group in watchers.items():
            with suppress(RuntimeError):  # it was closed
                loop.call_soon_threadsafe(_deliver, loop, group, watched.number, state)


def _is_news(state: _State, known: _State, age: float, in_turn: bool) -> bool:
    """Whether a state is told: another status at once, progress in turn only, and what stays after a while."""
    if state.final or not known.has_status_of(state):
        return True
    return in_turn and (known.differs(state) or age >= REPEAT_SECONDS)


def _deliver(loop: asyncio.AbstractEventLoop, watchers: Sequence[_Watcher], number: int, state: _State) -> None:
    """Hand a state to some, then to the others: between the two the event loop has time for requests."""
    for watcher in watchers[:GROUP]:
        watcher.deliver(number, state)
    if len(watchers) > GROUP:
        loop.call_later(GROUP_SECONDS, _deliver, loop, watchers[GROUP:], number, state)


def _snapshot_of(experiment: Experiment) -> Snapshot:
    elapsed = 0.0
    if experiment.started_at is not None:
        elapsed = ((experiment.finished_at or datetime.now(UTC)) - experiment.started_at).total_seconds()
    fraction = 1.0 if experiment.status is Status.SUCCEEDED else 0.0
    return Snapshot(experiment.status, fraction=fraction, elapsed=elapsed)

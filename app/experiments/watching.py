"""Progress of experiments: snapshots, and awaiting changes (the local executor first, the store as fallback)."""

import asyncio
import time
from collections.abc import AsyncGenerator, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from datetime import UTC, datetime
from threading import Lock

from app.experiments.model import Experiment, Snapshot, Status
from app.experiments.ports import Executor, ExperimentStore

POLL_SECONDS = 1.0  # how often a finish is looked for that another process may bring about
UPDATE_SECONDS = 0.1  # changes are passed on at most so often

Listener = tuple[asyncio.AbstractEventLoop, asyncio.Event]


class Watching:
    """Snapshots, and coroutines that wake when one changes.

    Parameters
    ----------
    store, executor
        Asked in this order: the executor knows of the jobs it has, the store of all others.
    """

    def __init__(self, store: ExperimentStore, executor: Executor) -> None:
        self._store = store
        self._executor = executor
        self._lock = Lock()
        self._listeners: dict[str, set[Listener]] = {}

    def notify(self, job: str) -> None:
        """Wake all that wait for this job; from any thread."""
        with self._lock:
            listeners = list(self._listeners.get(job, ()))
        for loop, event in listeners:
            with suppress(RuntimeError):  # its loop was closed
                loop.call_soon_threadsafe(event.set)

    def snapshot(self, experiment_id: str) -> Snapshot:
        """Read the state of this moment. Raises `NotFoundError` or `DeletedError`."""
        return self._executor.snapshot(experiment_id) or _snapshot_of(self._store.get(experiment_id))

    async def wait(self, experiment_id: str, seconds: float) -> Experiment:
        """Return the experiment once it has finished, or as it is after this many seconds."""
        deadline = time.monotonic() + seconds
        notified = True
        with self._listen(experiment_id) as changed:
            while True:
                if not notified or self._executor.snapshot(experiment_id) is None:
                    experiment = await asyncio.to_thread(self._store.get, experiment_id)
                    if experiment.status.finished:
                        return experiment
                remaining = deadline - time.monotonic()
                if remaining <= 0:
                    return await asyncio.to_thread(self._store.get, experiment_id)
                notified = await _wait(changed, min(remaining, POLL_SECONDS))

    async def watch(self, experiment_id: str) -> AsyncGenerator[Snapshot, None]:
        """Yield every change, several at once if they come fast; end after the finished state."""
        last: Snapshot | None = None
        notified = True
        with self._listen(experiment_id) as changed:
            while True:
                found = self._executor.snapshot(experiment_id)
                if found is None or not notified:
                    stored = _snapshot_of(await asyncio.to_thread(self._store.get, experiment_id))
                    found = stored if found is None or stored.status.finished else found
                if last is None or replace(found, elapsed=0.0) != replace(last, elapsed=0.0):
                    yield found
                    last = found
                if found.status.finished:
                    return
                notified = await _wait(changed, POLL_SECONDS)
                await asyncio.sleep(UPDATE_SECONDS)

    async def wait_until_left(self, job: str, seconds: float) -> bool:
        """Return True once the executor is done with this job, or False after so many seconds."""
        deadline = time.monotonic() + seconds
        with self._listen(job) as changed:
            while self._executor.snapshot(job) is not None:
                remaining = deadline - time.monotonic()
                if remaining <= 0:
                    return False
                await _wait(changed, min(remaining, POLL_SECONDS))
        return True

    @contextmanager
    def _listen(self, job: str) -> Iterator[asyncio.Event]:
        listener = (asyncio.get_running_loop(), asyncio.Event())
        with self._lock:
            self._listeners.setdefault(job, set()).add(listener)
        try:
            yield listener[1]
        finally:
            with self._lock:
                self._listeners[job].discard(listener)
                if not self._listeners[job]:
                    del self._listeners[job]


def _snapshot_of(experiment: Experiment) -> Snapshot:
    elapsed = 0.0
    if experiment.started_at is not None:
        elapsed = ((experiment.finished_at or datetime.now(UTC)) - experiment.started_at).total_seconds()
    fraction = 1.0 if experiment.status is Status.SUCCEEDED else 0.0
    return Snapshot(experiment.status, fraction=fraction, elapsed=elapsed)


async def _wait(event: asyncio.Event, seconds: float) -> bool:
    """Return when the event is set, or when the seconds have passed; clear it. Whether it was set."""
    with suppress(TimeoutError):
        async with asyncio.timeout(seconds):  # `wait_for` of Python 3.11 drops a cancellation that comes with the event
            await event.wait()
    notified = event.is_set()
    event.clear()
    return notified

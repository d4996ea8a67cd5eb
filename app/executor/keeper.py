"""Keeper of the engine: opens it, again if it was lost, and knows its workers."""

import logging
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import Any

from app.executor.backoff import Backoff
from app.executor.engine import Engine
from app.executor.supervision import Supervision
from app.experiments.ports import Run
from app.settings import Settings

log = logging.getLogger(__name__)

Ask = Callable[..., Any]
"""``ask(function, *arguments)``: calls a function on a worker"""

Prove = Callable[[Ask], None]

WORKERS_SECONDS = 5.0  # how often the list of workers is asked for, besides when it is known to have changed
REFUSED_SECONDS = 15.0  # before a worker that sees something else is asked again
FIRST_PAUSE_SECONDS, LONGEST_PAUSE_SECONDS = 0.5, 15.0  # before a scheduler that is away is tried again


class EngineKeeper:
    """The engine of the moment and its workers; used by one thread but for `note_change`.

    Parameters
    ----------
    settings : Settings
    run : callable
        What the workers do with a job.
    on_workers : callable
        Called from a thread of Dask's when workers came or left.
    on_hopeless : callable
        Called when engine after engine has no workers.
    prove : callable ``(ask)``, optional
        Raises if a worker of an external engine, which it is given the means to ``ask``, is none of ours.
    """

    def __init__(
        self,
        settings: Settings,
        run: Run,
        on_workers: Callable[[], None],
        on_hopeless: Callable[[], None],
        prove: Prove | None = None,
    ) -> None:
        self._settings = settings
        self._run = run
        self._on_workers = on_workers
        self._on_hopeless = on_hopeless
        self._prove = prove if settings.scheduler is not None else None
        self._proven: set[str] = set()
        self._refused: dict[str, float] = {}
        self._opening = Backoff(FIRST_PAUSE_SECONDS, LONGEST_PAUSE_SECONDS)
        self._supervision = Supervision()
        self._changed = threading.Event()
        self._asked = 0.0
        self._condemned: set[str] = set()
        #: None while there is none.
        self.engine: Engine | None = None
        #: Threads of every worker, by its address.
        self.workers: dict[str, int] = {}

    @property
    def usable(self) -> dict[str, int]:
        """The workers that are not being killed."""
        return {address: threads for address, threads in self.workers.items() if address not in self._condemned}

    def keep(self) -> bool:
        """Open the engine if there is none, and close it if it was lost; whether it was."""
        if self.engine is None:
            self._open()
            return False
        alive = self.engine.alive
        if alive and not self._supervision.deserted:
            return False
        log.error("the engine %s; another one is opened", "has no workers" if alive else "was lost")
        hopeless = self._supervision.deserted and self._supervision.abandon()
        self.close()
        if hopeless and self._settings.scheduler is None:
            log.critical("no worker can be started: the service ends, so that its supervisor starts it again")
            self._on_hopeless()
        return True

    def refresh(self) -> bool:
        """Ask for the workers if they are known to have changed, or some time ago; whether it did."""
        now = time.monotonic()
        if self.engine is None or not (self._changed.is_set() or now - self._asked > WORKERS_SECONDS):
            return False
        self._changed.clear()
        self._asked = now
        found = self.engine.workers()
        self._proven &= found.keys()
        self.workers = {address: threads for address, threads in found.items() if self._is_proven(self.engine, address)}
        self._condemned &= self.workers.keys()
        self._supervision.see(self.workers)
        return True

    def kill(self, address: str) -> None:
        """Kill a worker; it gets no job any more."""
        if self.engine is not None:
            self.engine.kill(address)
            self._condemned.add(address)

    def close(self) -> None:
        """Close the engine, if there is one."""
        engine, self.engine = self.engine, None
        self.workers = {}
        self._condemned.clear()
        if engine is not None:
            engine.close()

    def _is_proven(self, engine: Engine, address: str) -> bool:
        """Whether a worker sees what the service sees; one that does not gets no job, and is asked again later."""
        if self._prove is None or address in self._proven:
            return True
        if time.monotonic() < self._refused.get(address, 0.0):
            return False
        try:
            self._prove(partial(engine.ask, address))
        except Exception as error:
            log.error("the worker %s gets no job: %s", address, error)
            self._refused[address] = time.monotonic() + REFUSED_SECONDS
            return False
        self._proven.add(address)
        self._refused.pop(address, None)
        return True

    def _open(self) -> None:
        if not self._opening.due:
            return
        try:
            self.engine = Engine(self._settings, self._run, on_workers=self._note_change)
        except Exception as error:
            pause = self._opening.fail()
            log.error("the engine cannot be opened, next attempt in %g seconds: %s", pause, error)
            log.debug("why the engine cannot be opened", exc_info=True)
        else:
            self._opening.succeed()
            self._supervision.opened()
            self._changed.set()
            log.info("the engine is open")

    def _note_change(self) -> None:
        self._changed.set()
        self._on_workers()

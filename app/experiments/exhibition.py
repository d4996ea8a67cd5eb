"""Exhibits: makes the experiments that the pages show, once and for good, and finds them by what they are."""

import logging
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace

from app.errors import AppError, ConflictError, DeletedError, NotFoundError, UnavailableError
from app.experiments.model import Experiment, Status
from app.experiments.ports import Executor, ExperimentStore, JobQueue
from app.experiments.preparation import NewExperiment, NewInput, prepare
from app.experiments.samples import Samples
from app.gallery.exhibits import exhibits
from app.gallery.identity import identifier
from app.images.crop import Rectangle
from app.methods.allowed import Allowed
from app.methods.explanations.model import Exhibit
from app.settings import Settings

log = logging.getLogger(__name__)

OWNER = "catalogue"  # no token has such a digest, so nobody but the operator may delete them
UNMADE = {Status.FAILED, Status.CANCELLED}
POLL_SECONDS = 0.1
AWAY_SECONDS = 5.0  # before what was away is tried again


def is_exhibit(experiment: Experiment) -> bool:
    """Whether an experiment is an exhibit: public though the archive does not list it."""
    return experiment.owner == OWNER


@dataclass(frozen=True)
class Filled:
    """Numbers of exhibits that were made, failed, were there already, and lack their sample in this installation."""

    made: int = 0
    failed: int = 0
    kept: int = 0
    without_sample: int = 0


OnDone = Callable[[int, int, Exhibit, str | None], None]
"""``on_done(number, of, exhibit, error)``: one more is done, the last of ``of`` at ``number == of``"""


def _silent(number: int, of: int, exhibit: Exhibit, error: str | None) -> None:
    pass


class Exhibition:
    """Makes exhibits and finds them.

    Parameters
    ----------
    store, queue, executor, samples
        Those of the service.
    settings : Settings
        ``catalogue`` says whether what is missing is made in the background.
    """

    def __init__(
        self, store: ExperimentStore, queue: JobQueue, executor: Executor, samples: Samples, settings: Settings
    ) -> None:
        self._store = store
        self._queue = queue
        self._executor = executor
        self._samples = samples
        self._settings = settings
        self._samples_are_in = threading.Event()
        self.making = settings.catalogue
        """Whether what is missing is about to be made here."""

    def keep(self, closing: threading.Event) -> None:
        """Take in the bundled samples and then, where the settings want it, make what is missing, one at a time."""
        try:
            self._patiently(closing, lambda: self._samples.add_bundled(closing))
        finally:
            self._samples_are_in.set()
        if self._settings.catalogue:
            try:
                self._patiently(closing, lambda: self.fill(closing))
            except Exception:
                log.exception("the catalogue could not be made; the next start tries again")
            self.making = False

    @staticmethod
    def _patiently(closing: threading.Event, work: Callable[[], object]) -> None:
        """Do it, anew whenever database or storage were away."""
        while not closing.is_set():
            try:
                work()
                return
            except UnavailableError as error:
                log.warning("the exhibits wait: %s", error)
                closing.wait(AWAY_SECONDS)

    def fill(
        self, closing: threading.Event, *, again: bool = False, at_once: int = 1, on_done: OnDone = _silent
    ) -> Filled:
        """Make what is missing or failed; nothing is handed to the engine while something waits there.

        Parameters
        ----------
        closing : threading.Event
            Ends it early.
        again : bool
            Also make anew what is there, and what the operator deleted.
        at_once : int
            How many the engine may have at a time.
        on_done : callable
            Called after each.
        """
        while not self._samples_are_in.wait(POLL_SECONDS):
            if closing.is_set():
                return Filled()
        here = {sample.id for sample in self._store.bundled_samples()}
        every = exhibits()
        declared = {name: exhibit for name, exhibit in every.items() if here.issuperset(dict(exhibit.inputs))}
        missing = [name for name in declared if again or self._is_missing(name)]
        waiting, begun, number, failed = deque(missing), set[str](), 0, 0
        while waiting or begun:
            if waiting and len(begun) < at_once and self._queue.waiting() == 0:
                name = waiting.popleft()
                self._begin(declared[name], again)
                begun.add(name)
            elif closing.wait(POLL_SECONDS):
                break
            for name in begun - self._queue.states(begun).keys():
                begun.remove(name)
                number += 1
                error = self._error_of(name)
                failed += error is not None
                on_done(number, len(missing), declared[name], error)
        return Filled(number - failed, failed, len(declared) - len(missing), len(every) - len(declared))

    def find(self, exhibit: Exhibit) -> Experiment | None:
        """Find the experiment of an exhibit, in any state; None if it was not started, or deleted by the operator."""
        try:
            return self._store.get(identifier(exhibit))
        except (NotFoundError, DeletedError):
            return None

    def prepare(self, exhibit: Exhibit) -> Experiment:
        """Prepare the experiment that an exhibit asks for, without starting it.

        Raises
        ------
        InvalidInputError
            If it is declared wrongly.
        NotFoundError
            If one of its samples is not here.
        """
        inputs = tuple(NewInput(sample, Rectangle.parse(crop)) for sample, crop in exhibit.inputs)
        experiment = prepare(
            NewExperiment(exhibit.method, inputs, exhibit.parameters, listed=False),
            OWNER,
            sample=self._store.sample,
            transparent=self._samples.has_transparency,
            allowed=Allowed.by(self._settings),
        )
        return replace(experiment, id=identifier(exhibit))

    def _is_missing(self, name: str) -> bool:
        try:
            return self._store.get(name).status in UNMADE
        except NotFoundError:
            return True
        except DeletedError:
            return False

    def _begin(self, exhibit: Exhibit, again: bool) -> None:
        try:
            experiment = self.prepare(exhibit)
            found = self.find(exhibit)
            if again or (found is not None and found.status in UNMADE):
                self._store.replace(experiment, OWNER)
            else:
                self._store.add(experiment, OWNER)
        except UnavailableError:
            raise
        except ConflictError:
            log.info("another process makes the exhibit %s", identifier(exhibit))
        except AppError as error:
            log.error("an exhibit of %s cannot be made: %s", exhibit.method, error.message)
        else:
            self._executor.wake()

    def _error_of(self, name: str) -> str | None:
        try:
            experiment = self._store.get(name)
        except (NotFoundError, DeletedError):
            return "It could not be begun; the log says why."
        return experiment.error or "It was cancelled." if experiment.status in UNMADE else None

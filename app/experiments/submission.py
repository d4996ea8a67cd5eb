"""The desk at which experiments are handed in: what can run is accepted, everything else gets its reason at once."""

from dataclasses import dataclass, replace

from app.errors import BusyError, ConflictError, DeletedError, NotFoundError
from app.experiments.model import Experiment
from app.experiments.ports import Executor, ExperimentStore
from app.experiments.preparation import NewExperiment, memory_of, prepare
from app.experiments.samples import SampleIntake
from app.experiments.tokens import derived_identifier, new_identifier, new_token, token_digest
from app.methods.allowed import Allowed
from app.settings import Settings


@dataclass(frozen=True)
class Plan:
    """What an experiment would make and take: pixels and frames of the texture, and bytes of memory of a worker.

    ``memory`` is 0 for a method that needs little, whatever is asked for.
    """

    width: int
    height: int
    frames: int
    memory: int
    memory_limit: int


class Acceptance:
    """Accepts experiments.

    Parameters
    ----------
    store, executor, intake
        Those of the service.
    settings : Settings
    """

    def __init__(self, store: ExperimentStore, executor: Executor, intake: SampleIntake, settings: Settings) -> None:
        self._store = store
        self._executor = executor
        self._intake = intake
        self._allowed = Allowed.by(settings)
        self._queue_limit = settings.queue_limit

    def check(self, request: NewExperiment) -> Plan:
        """What this would make and take. Raises as `submit` does, but for `BusyError`; nothing is kept."""
        experiment = self._prepared(request, "")
        parameters = experiment.parameters
        return Plan(
            width=parameters["width"],
            height=parameters["height"],
            frames=parameters.get("frames") or 1,
            memory=memory_of(experiment, self._store.sample),
            memory_limit=self._allowed.memory,
        )

    def submit(
        self, request: NewExperiment, owner_token: str, *, transient: bool = False, press: str | None = None
    ) -> Experiment:
        """Accept an experiment: it is on disk and queued when this returns. The same press again gives it once more."""
        owner = token_digest(owner_token)
        identifier = new_identifier()
        if press is not None:
            # The identifier itself says what was pressed: no second process can take it for another experiment.
            known = derived_identifier(press, owner, repr(request))
            try:
                return self._store.get(known)
            except NotFoundError:
                identifier = known
            except DeletedError:
                pass  # pressed anew since
        if self._executor.waiting >= self._queue_limit:
            raise BusyError("Too many experiments wait already. Try again in a minute.")
        experiment = replace(self._prepared(request, owner), id=identifier, transient=transient)
        try:
            self._store.add(experiment)
        except ConflictError:
            if press is None:
                raise
            return self._store.get(identifier)  # the other one of two at once was faster
        self._executor.submit(experiment.id)
        return experiment

    def submit_transient(self, request: NewExperiment) -> Experiment:
        """Accept an experiment that is made for one answer."""
        return self.submit(request, new_token(), transient=True)

    def _prepared(self, request: NewExperiment, owner: str) -> Experiment:
        return prepare(
            request, owner, sample=self._store.sample, transparent=self._intake.transparent, allowed=self._allowed
        )

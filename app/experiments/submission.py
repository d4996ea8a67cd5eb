"""Submission of experiments: accepts or rejects them; a rejection names the field at fault."""

from dataclasses import dataclass, replace

from app.errors import ConflictError, DeletedError, NotFoundError
from app.experiments.availability import Availability
from app.experiments.model import Experiment
from app.experiments.ports import Executor, ExperimentStore, JobQueue
from app.experiments.preparation import NewExperiment, memory_of, prepare
from app.experiments.queue import check_queue
from app.experiments.samples import Samples
from app.experiments.shares import Shares
from app.experiments.tokens import derive_identifier, new_identifier, new_token, token_digest
from app.methods.allowed import Allowed
from app.settings import Settings


@dataclass(frozen=True)
class Plan:
    """Size and cost of an experiment: pixels and frames of the texture, and bytes of memory of a worker.

    ``memory`` is 0 for a method that needs little, whatever is asked for.
    """

    width: int
    height: int
    frames: int
    memory: int
    memory_limit: int


class Submission:
    """Accepts experiments.

    Parameters
    ----------
    store, queue, executor, availability, samples
        Those of the service.
    settings : Settings
    """

    def __init__(
        self,
        store: ExperimentStore,
        queue: JobQueue,
        executor: Executor,
        availability: Availability,
        samples: Samples,
        settings: Settings,
    ) -> None:
        self._store = store
        self._queue = queue
        self._executor = executor
        self._availability = availability
        self._samples = samples
        self._allowed = Allowed.by(settings)
        self._queue_limit = settings.queue_limit
        self._shares = Shares(queue, settings)

    def check(self, request: NewExperiment) -> Plan:
        """Plan an experiment without keeping it. Raises as `submit` does, but for `BusyError`."""
        experiment = self._prepare(request, "")
        parameters = experiment.parameters
        return Plan(
            width=parameters["width"],
            height=parameters["height"],
            frames=parameters.get("frames") or 1,
            memory=memory_of(experiment, self._store.sample),
            memory_limit=self._allowed.memory,
        )

    def submit(
        self,
        request: NewExperiment,
        owner_token: str,
        press: str | None = None,
        *,
        transient: bool = False,
        client: str | None = None,
    ) -> Experiment:
        """Accept an experiment: it is on disk and queued when this returns.

        Parameters
        ----------
        request : NewExperiment
        owner_token : str
        press : str, optional
            A secret of one press of a button: what the same owner asks for with the same press is the same experiment.
        transient : bool
            Whether it is made for one answer, and deleted with it.
        client : str, optional
            Who asks for it, for clients take turns; by default the owner.

        Raises
        ------
        InvalidInputError
            With the dotted field at fault.
        NotFoundError
            If its method or sample is not there.
        TooLargeError
            If the texture would be too large.
        BusyError
            If too many experiments wait already.
        QuotaError
            If too many of them are the client's own.
        UnavailableError
            If it could not be recorded now; nothing was.
        """
        owner = token_digest(owner_token)
        identifier = new_identifier()
        if press is not None:
            # The identifier itself says what was pressed: no second process can take it for another experiment.
            known = derive_identifier(press, owner, repr(request))
            try:
                return self._store.get(known)
            except NotFoundError:
                identifier = known
            except DeletedError:
                pass  # pressed anew since
        self._availability.require()
        check_queue(self._queue, self._queue_limit)
        client = owner if client is None else client
        self._shares.check(client)
        experiment = replace(self._prepare(request, owner), id=identifier, transient=transient)
        try:
            self._store.add(experiment, client)
        except ConflictError:
            if press is None:
                raise
            return self._store.get(identifier)  # the other one of two at once was faster
        self._executor.wake()
        return experiment

    def submit_transient(self, request: NewExperiment, client: str | None = None) -> Experiment:
        """Accept an experiment that is made for one answer."""
        return self.submit(request, new_token(), transient=True, client=client)

    def _prepare(self, request: NewExperiment, owner: str) -> Experiment:
        return prepare(
            request, owner, sample=self._store.sample, transparent=self._samples.has_transparency, allowed=self._allowed
        )

"""Experiments by their ids: reads, lists and counts them; cancels, deletes, shows and hides them for their owners."""

from collections.abc import Mapping

from pydantic import SecretStr

from app.errors import ForbiddenError
from app.experiments.housekeeping import Housekeeping
from app.experiments.model import Experiment, Page, deep_job
from app.experiments.ports import Executor, ExperimentStore
from app.experiments.tokens import is_same_secret, token_digest
from app.experiments.watching import Watching

PAGE = 24  # experiments of the archive


class Experiments:
    """The experiments that were accepted.

    Parameters
    ----------
    store, executor, housekeeping, watching
        Those of the service.
    operator_token : SecretStr, optional
        May do what the owner may.
    """

    def __init__(
        self,
        store: ExperimentStore,
        executor: Executor,
        housekeeping: Housekeeping,
        watching: Watching,
        operator_token: SecretStr | None,
    ) -> None:
        self._store = store
        self._executor = executor
        self._housekeeping = housekeeping
        self._watching = watching
        self._operator_token = operator_token

    def get(self, experiment_id: str) -> Experiment:
        """Read one. Raises `NotFoundError` or `DeletedError`."""
        return self._store.get(experiment_id)

    def page(self, *, limit: int = PAGE, cursor: str | None = None, method: str | None = None) -> Page:
        """List those of the archive, listed and succeeded, newest first. A broken cursor raises `InvalidInputError`."""
        return self._store.page(limit=limit, cursor=cursor, method=method)

    def counts(self) -> Mapping[str, int]:
        """Count them by status."""
        return self._store.counts()

    def owns(self, experiment: Experiment, token: str | None) -> bool:
        """Whether this is the token of the owner or of the operator."""
        if not token:
            return False
        operator = self._operator_token
        is_operator = operator is not None and is_same_secret(token, operator.get_secret_value())
        return is_operator or is_same_secret(token_digest(token), experiment.owner)

    def cancel_or_delete(self, experiment_id: str, token: str | None) -> None:
        """Cancel an unfinished experiment; delete a finished one with all that only it refers to.

        Raises `ForbiddenError` if the token is neither the owner's nor the operator's.
        """
        experiment = self._get_owned(experiment_id, token)
        if experiment.status.finished:
            self._delete(experiment)
        elif self._store.cancel(experiment_id):
            self._executor.wake()
            self._watching.notify(experiment_id)

    def set_listed(self, experiment_id: str, listed: bool, token: str | None) -> None:
        """Show it in the archive, or only to people who have its link. Raises `ForbiddenError`."""
        self._get_owned(experiment_id, token)
        self._store.set_listed(experiment_id, listed)

    def discard(self, experiment: Experiment) -> None:
        """Cancel an experiment if it is not finished, and delete it."""
        if self._store.cancel(experiment.id):
            self._executor.wake()
        self._delete(self._store.get(experiment.id))

    def _get_owned(self, experiment_id: str, token: str | None) -> Experiment:
        experiment = self._store.get(experiment_id)
        if not self.owns(experiment, token):
            raise ForbiddenError(
                "Only the owner of this experiment may do this: use the browser or the token it was made with."
            )
        return experiment

    def _delete(self, experiment: Experiment) -> None:
        self._housekeeping.delete(experiment)
        self._executor.wake()
        for output in experiment.outputs:  # who waits for one at 16 bits learns that it does not come
            self._watching.notify(deep_job(experiment.id, output.name))

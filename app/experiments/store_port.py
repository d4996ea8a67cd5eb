"""Protocol of the experiment store, which `app.store.sql` implements."""

from collections.abc import Collection, Mapping, Sequence
from datetime import datetime
from typing import Any, Protocol

from app.experiments.model import Experiment, Lease, Output, Page, Sample


class ExperimentStore(Protocol):
    """Samples and experiments, durable.

    Every call is one transaction; every method may be called from any thread and raises `UnavailableError` if the
    database cannot be reached for now. What is queued or runs has a job in `app.experiments.queue_port.JobQueue` of the
    same database, which comes and goes in the same transactions. A worker records by its lease: without it, nothing.
    """

    def ping(self) -> None:
        """Raise `UnavailableError` unless records can be written now."""

    def add_sample(self, sample: Sample, owner: str | None = None) -> None:
        """Insert a sample.

        Parameters
        ----------
        sample : Sample
        owner : str, optional
            SHA-256 (hex) of the uploader's token.
        """

    def sample(self, sample_id: str) -> Sample:
        """Read a sample.

        Raises
        ------
        NotFoundError
            If there is none of this id.
        """

    def bundled_samples(self) -> list[Sample]:
        """List the bundled samples, oldest first."""

    def add(self, experiment: Experiment, client: str = "") -> None:
        """Insert an experiment, and queue it unless it is finished.

        Parameters
        ----------
        experiment : Experiment
        client : str
            Who asks for it: clients take turns.

        Raises
        ------
        ConflictError
            If there is one with this id.
        NotFoundError
            If one of its samples is not there.
        """

    def replace(self, experiment: Experiment, client: str = "") -> None:
        """Insert and queue the experiment, replacing an existing one or a tombstone with the same id."""

    def get(self, experiment_id: str) -> Experiment:
        """Read an experiment with its inputs and outputs.

        Raises
        ------
        NotFoundError
            If there is none of this id.
        DeletedError
            If it was deleted.
        """

    def page(self, *, limit: int, cursor: str | None = None, method: str | None = None) -> Page:
        """List listed experiments that succeeded, newest first.

        Parameters
        ----------
        limit : int
            Experiments at most.
        cursor : str, optional
            Of the page before; by default the first page.
        method : str, optional
            Name of the only method to list.

        Raises
        ------
        InvalidInputError
            At ``cursor``, if it is malformed.
        """

    def start(self, lease: Lease) -> Experiment | None:
        """Mark an experiment as running.

        Returns
        -------
        Experiment or None
            None if the lease is not held any more: it was cancelled, deleted or taken away.
        """

    def succeed(
        self,
        lease: Lease,
        outputs: Sequence[Output],
        timings: Mapping[str, float],
        diagnostics: Mapping[str, Any],
        environment: Mapping[str, str],
    ) -> bool:
        """Record success together with the outputs, and end the job.

        Parameters
        ----------
        lease : Lease
        outputs : sequence of Output
            In their order.
        timings : mapping
            Seconds by stage, in order.
        diagnostics, environment : mapping
            See `app.experiments.diagnostics` and `app.experiments.environment`.

        Returns
        -------
        bool
            False, and nothing is recorded, if the lease is not held any more.
        """

    def fail(self, lease: Lease, error: str, cause: str | None = None) -> bool:
        """Record the failure of an experiment, and end the job.

        Parameters
        ----------
        lease : Lease
        error : str
            A sentence for people.
        cause : str, optional
            Charge a last attempt: what became of the worker, in words.

        Returns
        -------
        bool
            False, and nothing is recorded, if the lease is not held any more.
        """

    def cancel(self, experiment_id: str) -> bool:
        """Record the cancellation of a queued or running experiment, and end its job; False if it was finished."""

    def add_output(self, lease: Lease, output: Output) -> bool:
        """Add an output that was computed at 16 bits after the others, or replace the one of its name.

        Returns
        -------
        bool
            False, and nothing is recorded, if the lease is not held any more.

        Raises
        ------
        ConflictError
            If the experiment has not succeeded.
        """

    def set_listed(self, experiment_id: str, listed: bool) -> None:
        """Show an experiment in the archive, or hide it.

        Raises
        ------
        NotFoundError, DeletedError
            As `get`.
        """

    def delete(self, experiment_id: str) -> None:
        """Delete an experiment with its inputs, outputs and jobs; one that is not transient leaves a tombstone."""

    def remove_unused_samples(self, created_before: datetime, among: Collection[str] | None = None) -> list[Sample]:
        """Delete uploads to which no experiment refers.

        Parameters
        ----------
        created_before : datetime
            Younger ones stay.
        among : collection of str, optional
            The only ids to look at.

        Returns
        -------
        list of Sample
            Those that were deleted.
        """

    def finished_before(self, moment: datetime, *, unlisted: bool = False) -> list[str]:
        """List the ids of the experiments that finished before this moment, or of the unlisted ones among them."""

    def transient_before(self, moment: datetime) -> list[str]:
        """List the ids of the transient experiments that were submitted before this moment."""

    def used(self, digests: Collection[str]) -> set[str]:
        """Find those of the digests to which a sample or an output refers."""

    def counts(self) -> Mapping[str, int]:
        """Count the experiments by status; every status is there."""

    def close(self) -> None:
        """Let go of the database."""

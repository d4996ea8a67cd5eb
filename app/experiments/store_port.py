"""Protocol of the experiment store, which `app.store.sql` implements."""

from collections.abc import Collection, Mapping, Sequence
from datetime import datetime
from typing import Any, Protocol

from app.experiments.model import Experiment, Output, Page, Sample


class ExperimentStore(Protocol):
    """Samples and experiments, durable. Every call is one transaction; every method may be called from any thread."""

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

    def add(self, experiment: Experiment) -> None:
        """Insert an experiment.

        Raises
        ------
        ConflictError
            If there is one with this id.
        NotFoundError
            If one of its samples is not there.
        """

    def replace(self, experiment: Experiment) -> None:
        """Insert the experiment, replacing an existing one or a tombstone with the same id."""

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

    def unfinished(self) -> list[str]:
        """List the ids of queued and running experiments that are not transient, oldest first."""

    def start(self, experiment_id: str) -> Experiment | None:
        """Mark an experiment as running and count the attempt.

        Returns
        -------
        Experiment or None
            None if it is already finished, cancelled or deleted.
        """

    def succeed(
        self,
        experiment_id: str,
        outputs: Sequence[Output],
        timings: Mapping[str, float],
        diagnostics: Mapping[str, Any],
        environment: Mapping[str, str],
    ) -> bool:
        """Record success together with the outputs.

        Parameters
        ----------
        experiment_id : str
        outputs : sequence of Output
            In their order.
        timings : mapping
            Seconds by stage, in order.
        diagnostics, environment : mapping
            See `app.experiments.diagnostics` and `app.experiments.environment`.

        Returns
        -------
        bool
            False, and nothing is recorded, if it is no longer running.
        """

    def fail(self, experiment_id: str, error: str) -> bool:
        """Record the failure of a queued or running experiment.

        Parameters
        ----------
        experiment_id : str
        error : str
            A sentence for people.

        Returns
        -------
        bool
            False, and nothing is recorded, if it was finished already.
        """

    def cancel(self, experiment_id: str) -> bool:
        """Record the cancellation of a queued or running experiment; False if it was finished already."""

    def add_output(self, experiment_id: str, output: Output) -> None:
        """Add an output after the others, or replace the one of its name.

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
        """Delete an experiment with its inputs and outputs; one that is not transient leaves a tombstone."""

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

    def finished_before(self, moment: datetime) -> list[str]:
        """List the ids of the experiments that finished before this moment."""

    def transient_before(self, moment: datetime) -> list[str]:
        """List the ids of the transient experiments that were submitted before this moment."""

    def used(self, digests: Collection[str]) -> set[str]:
        """Find those of the digests to which a sample or an output refers."""

    def counts(self) -> Mapping[str, int]:
        """Count the experiments by status; every status is there."""

    def close(self) -> None:
        """Let go of the database."""

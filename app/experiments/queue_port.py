"""Protocol of the job queue, which `app.store.queue` implements."""

from collections.abc import Collection
from typing import Protocol

from app.experiments.model import Beat, Lease, Snapshot

PLACE = 16  # characters of a client's name that say where it is; the others say who


class JobQueue(Protocol):
    """Jobs that wait or run: the same for every web process and every engine on one database.

    A job is an experiment, by its id, or an output at 16 bits (`app.experiments.model.deep_job`). It is run by whoever
    leases it, one at a time. Experiments come in with their record, by `ExperimentStore.add`, and leave with it, by
    `succeed`, `fail`, `cancel` and `delete`. A lease has no time of expiry, for clocks may jump: whoever has seen its
    heartbeat stand still for long enough takes it away, by `lapse`.

    Every call is one transaction; every method may be called from any thread and raises `UnavailableError` if the
    database cannot be reached for now.
    """

    def enqueue(self, job: str, client: str) -> None:
        """Queue a job that computes an output at 16 bits.

        One that waits or runs already stays as it is; one that failed is queued anew.

        Parameters
        ----------
        job : str
            What `deep_job` made.
        client : str
            Who asks for it: clients take turns.
        """

    def lease(self, holder: str, *, alone: bool) -> Lease | None:
        """Lease the next job that waits.

        Places take turns, and within a place its clients: of every one the oldest job comes first, then of every one
        the second, and so on, where what runs already counts as the first; among equals the older one. A client's
        place is the first `PLACE` characters of its name: who asks under many names from one place has the turns of
        one. Two callers never get the same job.

        Parameters
        ----------
        holder : str
            The engine that will run it.
        alone : bool
            Whether nothing else runs on that engine: only then a job is leased for its `last` attempt.

        Returns
        -------
        Lease or None
            None if nothing waits that may run now.
        """

    def renew(self, lease: Lease, stage: str | None, fraction: float) -> bool:
        """Move the heartbeat on, with the progress of the run: the worker's sign of life.

        Parameters
        ----------
        lease : Lease
        stage : str or None
            Name of the stage that is being computed.
        fraction : float
            The part of the run that is done, 0–1.

        Returns
        -------
        bool
            False if the lease is not held any more: the run must end, for what it finds is not recorded.
        """

    def holds(self, lease: Lease) -> bool:
        """Whether the lease is held still: not cancelled, not released, not lapsed."""

    def release(self, lease: Lease, cause: str | None = None) -> bool:
        """Put the job back where it waited before.

        Parameters
        ----------
        lease : Lease
        cause : str, optional
            Charge an attempt: what became of the worker, in words. Without it the job is not at fault.

        Returns
        -------
        bool
            False, and nothing changes, if the lease is not held any more.
        """

    def finish(self, lease: Lease, error: str | None = None) -> bool:
        """End a job that computes an output at 16 bits.

        Parameters
        ----------
        lease : Lease
        error : str, optional
            Why it failed, a sentence for people: kept for an hour, or until the job is asked for again.

        Returns
        -------
        bool
            False, and nothing changes, if the lease is not held any more.
        """

    def cancel(self, job: str) -> bool:
        """Take a job out, whether it waits or runs; False if it does neither."""

    def beats(self) -> list[Beat]:
        """List the heartbeats of all leased jobs; one that no worker has begun yet is 0."""

    def lapse(self, job: str, fence: int, beat: int) -> bool:
        """Put a job back whose heartbeat stands still; nothing is charged.

        Returns
        -------
        bool
            False, and nothing changes, if fencing number or heartbeat are others by now.
        """

    def states(self, jobs: Collection[str]) -> dict[str, Snapshot]:
        """Describe those of the jobs that wait or run: position in the same order as `lease`, or progress."""

    def failure(self, job: str) -> str | None:
        """Why an output at 16 bits could not be computed; None if it did not fail within the last hour."""

    def waiting(self) -> int:
        """Count the jobs that wait."""

    def waiting_of(self, client: str) -> int:
        """Count the waiting jobs of all clients whose names begin so: of one, or of a place."""

    def leased_by(self, holder: str) -> list[Lease]:
        """List the leases that an engine holds."""

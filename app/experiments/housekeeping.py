"""What goes, and when: an experiment with all that only it referred to, and what lies about unused."""

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from app.errors import DeletedError, NotFoundError
from app.experiments.cache import FileCache
from app.experiments.model import Experiment
from app.experiments.ports import BlobStore, ExperimentStore

BATCH = 500  # files looked at under one lock, so that nobody waits long for it


@dataclass(frozen=True)
class Pruned:
    """How many went."""

    experiments: int
    samples: int
    files: int


class Housekeeping:
    """Removes experiments, samples and files; what something still refers to stays.

    Parameters
    ----------
    store, blobs, cache
        Where they are.
    sample_keep : timedelta
        How long an upload without an experiment is kept.
    longest_run : timedelta
        After this long nothing half-made belongs to anybody.
    """

    def __init__(
        self,
        store: ExperimentStore,
        blobs: BlobStore,
        cache: FileCache,
        *,
        sample_keep: timedelta,
        longest_run: timedelta,
    ) -> None:
        self._store = store
        self._blobs = blobs
        self._cache = cache
        self._sample_keep = sample_keep
        self._longest_run = longest_run

    def delete(self, experiment: Experiment) -> None:
        """Remove an experiment, and its samples and files unless something else refers to them."""
        self._store.delete(experiment.id)
        among = {item.sample for item in experiment.inputs}
        samples = self._store.remove_unused_samples(datetime.now(UTC), among)
        self._remove_files([*(output.digest for output in experiment.outputs), *(sample.digest for sample in samples)])

    def remove_sample(self, sample_id: str) -> None:
        """Remove an upload at once, unless an experiment refers to it."""
        removed = self._store.remove_unused_samples(datetime.now(UTC), [sample_id])
        self._remove_files([sample.digest for sample in removed])

    def prune(self, older_than: timedelta | None) -> Pruned:
        """Remove what nothing refers to and, where ``older_than`` is given, experiments that finished longer ago."""
        now = datetime.now(UTC)
        stale = self._delete_all(self._store.transient_before(now - self._longest_run))
        if older_than is not None:
            stale += self._delete_all(self._store.finished_before(now - older_than))
        samples = self._store.remove_unused_samples(now - self._sample_keep)
        files = self._remove_files(self._blobs.digests())
        files += self._blobs.remove_temporary(now - self._longest_run)
        return Pruned(stale, len(samples), files)

    def _delete_all(self, experiment_ids: Iterable[str]) -> int:
        deleted = 0
        for experiment_id in experiment_ids:
            try:
                self.delete(self._store.get(experiment_id))
            except (NotFoundError, DeletedError):
                continue  # its owner was faster
            deleted += 1
        return deleted

    def _remove_files(self, digests: list[str]) -> int:
        removed = 0
        for start in range(0, len(digests), BATCH):
            gone = self._blobs.remove_unused(digests[start : start + BATCH], self._store.used)
            for digest in gone:
                self._cache.forget(digest)
            removed += len(gone)
        return removed

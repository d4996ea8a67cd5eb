"""Housekeeping: deletes experiments together with files only they use, and once an hour removes orphaned files."""

import logging
import threading
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from app.errors import DeletedError, NotFoundError
from app.experiments.files.cache import FileCache
from app.experiments.model import Experiment
from app.experiments.ports import BlobStore, ExperimentStore
from app.experiments.retention import Retention
from app.experiments.steady_clock import SteadyClock
from app.gallery.exhibits import exhibits

log = logging.getLogger(__name__)

PRUNE_SECONDS = 3600.0
BATCH = 500  # files looked at under one lock, so that nobody waits long for it


@dataclass(frozen=True)
class Pruned:
    """Numbers of what was removed."""

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
        After this long what is half-made was left behind by a killed process.
    retention : Retention, optional
        How long experiments are kept; by default for ever.
    """

    def __init__(
        self,
        store: ExperimentStore,
        blobs: BlobStore,
        cache: FileCache,
        *,
        sample_keep: timedelta,
        longest_run: timedelta,
        retention: Retention | None = None,
    ) -> None:
        self._store = store
        self._blobs = blobs
        self._cache = cache
        self._sample_keep = sample_keep
        self._longest_run = longest_run
        self._retention = retention or Retention()

    def keep(self, closing: threading.Event) -> None:
        """Prune every hour, until ``closing`` is set."""
        clock = SteadyClock()
        while not closing.wait(PRUNE_SECONDS):
            try:
                self._prune_by(clock)
            except Exception:
                log.exception("housekeeping failed; it will be tried again")

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

    def _prune_by(self, clock: SteadyClock) -> None:
        """Prune unless the clock was set lately: what is removed by its age would go too early."""
        if clock.steady():
            self.prune(None)
        else:
            log.warning("the clock was set within the last day: nothing is removed by its age until it has run on")

    def prune(self, older_than: timedelta | None) -> Pruned:
        """Remove what nothing refers to and experiments that are kept no longer, by the settings or by ``older_than``.

        What the program's own pages show stays.
        """
        now = datetime.now(UTC)
        stale = self._delete_all(self._store.transient_before(now - self._longest_run))
        for age in (older_than, self._retention.every):
            if age is not None:
                stale += self._delete_old(self._store.finished_before(now - age))
        if self._retention.unlisted is not None:
            stale += self._delete_old(self._store.finished_before(now - self._retention.unlisted, unlisted=True))
        samples = self._store.remove_unused_samples(now - self._sample_keep)
        files = self._remove_files(self._blobs.digests())
        files += self._blobs.remove_temporary(now - self._longest_run)
        return Pruned(stale, len(samples), files)

    def _delete_old(self, experiment_ids: list[str]) -> int:
        shown = exhibits()
        return self._delete_all(name for name in experiment_ids if name not in shown)

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

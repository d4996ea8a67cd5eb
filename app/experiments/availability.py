"""Availability: whether database, storage and engine answer, asked at most once a second."""

import threading
import time

from app.errors import ENGINE, UnavailableError
from app.experiments.ports import BlobStore, Executor, ExperimentStore

FRESH_SECONDS = 1.0  # how long an answer is good for


def probe(store: ExperimentStore, blobs: BlobStore) -> None:
    """Try database and storage.

    Raises
    ------
    UnavailableError
        Naming the part that is away.
    """
    store.ping()
    blobs.probe()


class Availability:
    """Which part of the service is away.

    Parameters
    ----------
    store, blobs, executor
        Those of the service.
    """

    def __init__(self, store: ExperimentStore, blobs: BlobStore, executor: Executor) -> None:
        self._store = store
        self._blobs = blobs
        self._executor = executor
        self._asking = threading.Lock()
        self._asked = float("-inf")
        self._records: UnavailableError | None = None

    def missing(self) -> UnavailableError | None:
        """Find what keeps experiments from running now; None if nothing does."""
        found = self.unwritable()
        if found is None and not self._executor.ready:
            found = UnavailableError(ENGINE, "No worker is there: the engine starts, or was lost and comes back.")
        return found

    def unwritable(self) -> UnavailableError | None:
        """Find what keeps a new upload or experiment from being recorded now: it would be lost."""
        with self._asking:  # those who ask meanwhile get the answer to the first
            if time.monotonic() - self._asked > FRESH_SECONDS:
                try:
                    probe(self._store, self._blobs)
                    self._records = None
                except UnavailableError as error:
                    self._records = error
                self._asked = time.monotonic()
            return self._records

    def require(self) -> None:
        """Raise `UnavailableError` if an upload or experiment could not be recorded now: before it is written."""
        if (error := self.unwritable()) is not None:
            raise UnavailableError(error.part, error.message)

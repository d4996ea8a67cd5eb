"""Supervision of an engine: it is alive only if it has workers."""

import logging
import time
from collections.abc import Collection

log = logging.getLogger(__name__)

DESERTED_SECONDS = 30.0  # without workers before an engine is given up
HOPELESS_SECONDS = 60.0  # without workers in the one that was opened instead, before the process gives up


class Supervision:
    """What became of the workers of one engine after the other, by the monotonic clock."""

    def __init__(self) -> None:
        self._workers: set[str] = set()
        self._since = time.monotonic()
        self._abandoned = 0  # engines in a row that ended without workers

    def opened(self) -> None:
        """Note that an engine was opened."""
        self._workers = set()
        self._since = time.monotonic()

    def see(self, addresses: Collection[str]) -> None:
        """Take in the workers that there are, and log who came and who left."""
        for gone in self._workers - set(addresses):
            log.warning("the worker %s is gone", gone)
        for come in set(addresses) - self._workers:
            log.info("the worker %s is there", come)
        if self._workers and not addresses:
            log.error("the engine has no worker any more")
        self._workers = set(addresses)
        if addresses:
            self._since = time.monotonic()
            self._abandoned = 0

    @property
    def deserted(self) -> bool:
        """Whether the engine has had no worker for so long that another one is to be opened."""
        limit = HOPELESS_SECONDS if self._abandoned else DESERTED_SECONDS
        return not self._workers and time.monotonic() - self._since > limit

    def abandon(self) -> bool:
        """Note that a deserted engine is given up; whether the one before it was too, so that no other one will do."""
        self._abandoned += 1
        return self._abandoned > 1

"""Shares of the queue: how many jobs of one client, and of one place, may wait at a time."""

from app.errors import QuotaError
from app.experiments.queue_port import PLACE, JobQueue
from app.settings import Settings

LEAST = 4  # jobs: a part of a short queue would be none
RETRY_SECONDS = 30  # about when one of many that wait begins


class Shares:
    """Refuses what is beyond a client's share of the queue, whose record is in the database.

    A place, where anybody may make up clients, has as many shares as an address has limits, but never more than half
    of the queue.

    Parameters
    ----------
    queue : JobQueue
    settings : Settings
    """

    def __init__(self, queue: JobQueue, settings: Settings) -> None:
        self._queue = queue
        self._on = settings.limits
        self._of_client = max(LEAST, int(settings.queue_limit * settings.queue_share))
        half = max(self._of_client, settings.queue_limit // 2)
        self._of_place = min(settings.limit_address * self._of_client, half)

    def check(self, client: str) -> None:
        """Raise `QuotaError` if so many jobs of this client, or of its place, wait already."""
        if not self._on or not client:
            return
        for name, most, of in (
            (client, self._of_client, "client"),
            (client[:PLACE], self._of_place, "network address"),
        ):
            if self._queue.waiting_of(name) >= most:
                raise QuotaError(
                    f"Wait until one of your experiments has begun: {most} of them wait already, and one {of} has no "
                    "larger share of the queue.",
                    RETRY_SECONDS,
                )

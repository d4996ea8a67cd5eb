"""Queue limit: rejects further jobs while too many wait, wherever they were submitted."""

from app.errors import BusyError
from app.experiments.ports import JobQueue


def check_queue(queue: JobQueue, limit: int) -> None:
    """Raise `BusyError` if so many jobs wait already."""
    if queue.waiting() >= limit:
        raise BusyError("Try again in a minute: too many experiments wait already.")

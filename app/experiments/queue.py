"""Queue limit: rejects further jobs while too many wait."""

from app.errors import BusyError
from app.experiments.ports import Executor


def check_queue(executor: Executor, limit: int) -> None:
    """Raise `BusyError` if so many jobs wait already."""
    if executor.waiting >= limit:
        raise BusyError("Try again in a minute: too many experiments wait already.")

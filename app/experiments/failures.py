"""Failures of runs, in words for people, and what is no failure: a storage that cannot be reached for now."""

import errno
import logging

from app.errors import DISK_SPACE, STORAGE, AppError, UnavailableError

log = logging.getLogger(__name__)

BROKEN = "Something went wrong inside the method. This is a fault of the service, not yours."
NO_MEMORY = "Try a smaller width and height: there was not enough memory for this experiment."
FULL = {errno.ENOSPC, errno.EDQUOT}


def explain_failure(job: str, error: Exception) -> str:
    """Say what went wrong in a job; what people cannot do anything about is logged with its traceback."""
    if isinstance(error, AppError):
        return error.message
    if isinstance(error, MemoryError):
        return NO_MEMORY
    log.error("job %s failed", job, exc_info=error)
    return BROKEN


def unavailability(error: OSError) -> UnavailableError:
    """Say what a file that cannot be read or written is short of: never the experiment's fault."""
    log.warning("a file cannot be read or written", exc_info=error)
    part = part_of(error)
    if part == DISK_SPACE:
        return UnavailableError(part, "There is no room left on the disk of the service's files.")
    return UnavailableError(part, "The service's files cannot be read or written for now.")


def part_of(error: OSError) -> str:
    """Which part is away if a file cannot be read or written: room on the disk, or the storage as a whole."""
    return DISK_SPACE if error.errno in FULL else STORAGE


def out_of_time(seconds: float) -> str:
    """Say that a run took longer than this.

    Examples
    --------
    >>> out_of_time(300)
    'Make the texture smaller: this run took longer than 300 seconds.'
    """
    return f"Make the texture smaller: this run took longer than {seconds:g} seconds."

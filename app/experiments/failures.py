"""Failures of runs, in words for people; what they cannot mend goes to the log."""

import logging

from app.errors import AppError

log = logging.getLogger(__name__)

BROKEN = "Something went wrong inside the method. This is a fault of the service, not yours."
UNWRITTEN = "The service could not read or write its files. Its operator finds the reason in the log."
NO_MEMORY = "Try a smaller width and height: there was not enough memory for this experiment."


def explain_failure(job: str, error: Exception) -> str:
    """Say what went wrong in a job; what people cannot do anything about is logged with its traceback."""
    if isinstance(error, AppError):
        return error.message
    if isinstance(error, MemoryError):
        return NO_MEMORY
    log.error("job %s failed", job, exc_info=error)
    return UNWRITTEN if isinstance(error, OSError) else BROKEN

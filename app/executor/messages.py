"""User-facing messages for runs that the executor ended: lost worker, no record."""

LOST = (
    "Try a smaller width and height, or another crop: running this experiment ended its worker process again and "
    "again, the last time with nothing else beside it, most likely for want of memory."
)
UNRECORDED = (
    "No worker recorded what came of this experiment. Its operator should check that every worker has the same "
    "database and the same files as the service."
)
UNUSABLE = (
    "The service could not read or write this experiment's files, although its storage answers. "
    "Its operator finds the reason in the log."
)

"""Errors by meaning. `app.web.problems` maps them to HTTP answers, `app.cli.problems` prints them."""

from collections.abc import Mapping
from typing import Self


class AppError(Exception):
    """Base of every error whose message is meant for the person who caused it.

    Parameters
    ----------
    message : str
        One or two sentences: what is wrong and what to do about it.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.message = message


class InvalidInputError(AppError):
    """A value that is not valid.

    Parameters
    ----------
    message : str
        What is wrong and what to do.
    field : str, optional
        The field at fault, dotted as in the JSON body: ``"parameters.alpha"``, ``"inputs.0.crop"``.
    """

    def __init__(self, message: str, field: str | None = None) -> None:
        super().__init__(message)
        self.field = field


class UnsupportedFormatError(AppError):
    """The file is not of a format that can be read."""


class BrokenFileError(AppError):
    """The file is of a known format but truncated, corrupt or dishonest."""


class TooLargeError(AppError):
    """More bytes, pixels or seconds than the settings allow."""


class NotFoundError(AppError):
    """Nothing has this name."""


class DeletedError(AppError):
    """It was here and was deleted on purpose."""


class ForbiddenError(AppError):
    """Only the owner or the operator may do this."""


class ConflictError(AppError):
    """The state it is in does not allow this."""


class BusyError(AppError):
    """Too much waits or runs already; trying later helps."""


class QuotaError(AppError):
    """Who asks has had its share for now.

    Parameters
    ----------
    message : str
        How much there is, and when to try again.
    retry_after : int, optional
        Seconds until it is worth it.
    fields : mapping, optional
        Header fields that say how much is left.
    """

    def __init__(self, message: str, retry_after: int = 60, fields: Mapping[str, str] | None = None) -> None:
        super().__init__(message)
        self.retry_after = retry_after
        self.fields = dict(fields or {})


DATABASE, STORAGE, ENGINE, DISK_SPACE = "database", "storage", "engine", "disk space"  # parts that may be unavailable


class UnavailableError(AppError):
    """A part of the service cannot be reached for now: nobody's fault, least of all the experiment's.

    What was accepted waits and is tried again; whoever asks is told to come back.

    Parameters
    ----------
    part : str
        `DATABASE`, `STORAGE`, `ENGINE` or `DISK_SPACE`.
    message : str
        Which part it is, in words, and what to do.
    """

    def __init__(self, part: str, message: str) -> None:
        super().__init__(message)
        self.part = part

    def __reduce__(self) -> tuple[type[Self], tuple[str, str]]:
        """Pickle both arguments: it is raised in worker processes and handled in the service."""
        return type(self), (self.part, self.message)


class CancelledError(AppError):
    """Raised inside a running method when its experiment was cancelled."""


class TimeLimitError(AppError):
    """Raised inside a running method when its time is over."""

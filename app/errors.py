"""Errors by meaning. `app.web.problems` maps them to HTTP answers, `app.cli.problems` prints them."""


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
    """The queue is full or the engine is not there; trying later helps."""


class CancelledError(AppError):
    """Raised inside a running method when its experiment was cancelled."""


class TimeLimitError(AppError):
    """Raised inside a running method when its time is over."""

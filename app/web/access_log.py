"""Access log: requests without the ids of experiments and uploads, which are the only lock of unlisted ones."""

import logging
import re

LOGGERS = ("uvicorn.access", "uvicorn.error")
MASK = "…"

_OPEN = re.compile(r"^/(?:static|methods|docs)(?:/|$)")  # addresses that are no secret
_BEHIND = re.compile(r"((?:^|/)(?:experiments|samples|compare)/)([^/?]+)", re.IGNORECASE)
_SECOND = re.compile(r"((?:^|/)compare/…/)([^/?]+)", re.IGNORECASE)
_LIKE_AN_ID = re.compile(r"[\w%-]{16,}", re.ASCII)  # or a token; in a mistyped address and in a query too
_ROUTES = frozenset({"check"})  # what stands where an id could


def redact(target: str) -> str:
    """Request target with every id masked.

    Examples
    --------
    >>> redact("/api/v1/experiments/jO3a_9-xYz0123Ab/outputs/texture?format=tiff")
    '/api/v1/experiments/…/outputs/texture?format=tiff'
    >>> redact("/compare/jO3a_9-xYz0123Ab/short?view=flip"), redact("/samples/gravel_gray?sample-2=jO3a_9-xYz0123Ab")
    ('/compare/…/…?view=flip', '/samples/…?sample-2=…')
    >>> redact("/static/js/viewer/looping_video_player.js"), redact("/experiments/check")
    ('/static/js/viewer/looping_video_player.js', '/experiments/check')
    """
    path, mark, query = target.partition("?")
    if not _OPEN.match(path):
        path = _BEHIND.sub(lambda found: found[1] + (found[2] if found[2] in _ROUTES else MASK), path)
        path = _LIKE_AN_ID.sub(MASK, _SECOND.sub(rf"\1{MASK}", path))
    return f"{path}{mark}{_LIKE_AN_ID.sub(MASK, query)}"


class Redacting(logging.Filter):
    """Masks what is the target of a request among the arguments of a record: it begins with a slash."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Keep every record."""
        if isinstance(record.args, tuple):
            record.args = tuple(
                redact(each) if isinstance(each, str) and each.startswith("/") else each for each in record.args
            )
        return True


def keep_addresses_secret() -> None:
    """Mask ids in what this process's server logs of requests, whoever configures it."""
    for name in LOGGERS:
        logger = logging.getLogger(name)
        if not any(isinstance(present, Redacting) for present in logger.filters):
            logger.addFilter(Redacting())

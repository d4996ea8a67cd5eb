"""Log configuration: one line a record on standard error, as text or as JSON, with the id of the request."""

import json
import logging
from datetime import UTC, datetime
from typing import Any, Literal

from app.web.access_log import Redacting
from app.web.request_id import request_id

Form = Literal["text", "json"]
_ACCESS = ("client", "method", "target", "http", "status")  # arguments of the server's own lines about requests


class Line(logging.Formatter):
    """Text: moment, level, message, and the request's id in brackets."""

    def format(self, record: logging.LogRecord) -> str:
        """Write a record; a traceback follows on further lines."""
        identifier = request_id()
        head = f"{_moment(record)} {record.levelname:<8} "
        return head + super().format(record) + (f" [{identifier}]" if identifier and not record.exc_info else "")


class Json(logging.Formatter):
    """JSON: one object a line, a traceback within it."""

    def format(self, record: logging.LogRecord) -> str:
        """Write a record."""
        entry: dict[str, Any] = {
            "time": _moment(record),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
        }
        if identifier := request_id():
            entry["request"] = identifier
        if record.name == "uvicorn.access" and isinstance(record.args, tuple) and len(record.args) == len(_ACCESS):
            entry |= dict(zip(_ACCESS, record.args, strict=True))
        if record.exc_info:
            entry["traceback"] = self.formatException(record.exc_info)
        return json.dumps(entry, ensure_ascii=False, default=str)


def configuration(form: Form, level: str) -> dict[str, Any]:
    """Make the configuration that uvicorn hands to `logging.config`: the server's records and the program's own."""
    logger = {"handlers": ["stderr"], "level": level.upper(), "propagate": False}
    return {
        "version": 1,
        "disable_existing_loggers": False,
        "filters": {"redacting": {"()": Redacting}},
        "formatters": {"line": {"()": Json if form == "json" else Line}},
        "handlers": {"stderr": {"class": "logging.StreamHandler", "formatter": "line", "filters": ["redacting"]}},
        "loggers": dict.fromkeys(("uvicorn", "uvicorn.error", "uvicorn.access", "app"), logger),
    }


def _moment(record: logging.LogRecord) -> str:
    return datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")

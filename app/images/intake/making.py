"""Pictures made of stored ones: large ones in a process that may be killed, a few at a time, small ones here."""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from threading import BoundedSemaphore
from typing import Any

from app.errors import BusyError, InvalidInputError, TooLargeError
from app.images.decode import Limits
from app.images.intake import client
from app.images.intake.tasks import perform
from app.images.png_writer import HEADER, SIGNATURE

LARGE = 1 << 22  # pixels of all sources together, above which it costs a process of its own
AT_ONCE, WAITING = 2, 3
LIMITS = Limits(seconds=60.0)
BUSY = "Try again in a minute: many large pictures are being converted at the moment."
_admitted, _turn = BoundedSemaphore(AT_ONCE + WAITING), BoundedSemaphore(AT_ONCE)


def make(task: str, sources: Sequence[Path], destinations: Sequence[Path], **arguments: Any) -> None:
    """Make files of stored pictures. Thread-safe; blocks.

    Parameters
    ----------
    task : str
        One of `app.images.intake.tasks.TASKS`.
    sources : sequence of Path
        PNG files.
    destinations : sequence of Path
        Files to write, as many as the task makes.
    **arguments
        Of the task.

    Raises
    ------
    InvalidInputError
        If the format cannot hold the picture.
    BusyError
        If large pictures wait already, or this one took its minute on a machine that is busy.
    TooLargeError
        If it takes more memory than there is for one.
    """
    if sum(map(_count_pixels, sources)) <= LARGE:
        perform(task, sources, destinations, arguments)
        return
    if not _admitted.acquire(blocking=False):
        raise BusyError(BUSY)
    try:
        with _turn:
            _make_apart(task, sources, destinations, arguments)
    finally:
        _admitted.release()


def _count_pixels(path: Path) -> int:
    with path.open("rb") as file:
        width, height, *_ = HEADER.unpack_from(file.read(len(SIGNATURE) + 8 + HEADER.size), len(SIGNATURE) + 8)
    return int(width) * int(height)


def _make_apart(task: str, sources: Sequence[Path], destinations: Sequence[Path], arguments: dict[str, Any]) -> None:
    request = {
        "task": task,
        "sources": [str(path.resolve()) for path in sources],
        "destinations": [str(path.resolve()) for path in destinations],
        "arguments": arguments,
        "limits": asdict(LIMITS),
    }
    report = client.collect_answer(json.dumps(request).encode(), LIMITS)
    if report.get("made"):
        return
    errors: dict[str, Callable[[], Exception]] = {
        "InvalidInputError": lambda: InvalidInputError(report["message"], report["field"]),
        "OSError": lambda: OSError(report["errno"], "The converter cannot read or write its files"),
        "MemoryError": lambda: TooLargeError("Take another format: this picture is too large to be converted to it."),
    }
    if error := errors.get(report.get("error", "")):
        raise error()
    if report.get("error"):
        raise RuntimeError(f"{task} failed; the log has the converter's traceback")
    raise BusyError(BUSY)  # late, or killed from outside: neither is the picture's fault

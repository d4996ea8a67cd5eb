"""Graceful shutdown: cancels waiting requests (event streams, ``Prefer: wait``) on SIGTERM and SIGINT.

Otherwise uvicorn waits for them until it is killed.
"""

import asyncio
import logging
import os
import signal
import threading
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, TypeVar

from fastapi import Request

_Result = TypeVar("_Result")

HOPELESS = 70  # exit code of a service that cannot run experiments any more: its supervisor starts it again

_gave_up = threading.Event()


def give_up() -> None:
    """Stop this process as on SIGTERM, but end it with the code `HOPELESS`; from any thread."""
    _gave_up.set()
    os.kill(os.getpid(), signal.SIGTERM)


def end_if_given_up() -> None:
    """End the process at once if it gave up; called when everything is closed.

    A server that was stopped by a signal ends by that signal, which supervisors take for an orderly end.
    """
    if _gave_up.is_set():
        logging.shutdown()
        os._exit(HOPELESS)


@contextmanager
def on_stop_signal(call: Callable[[], object]) -> Iterator[None]:
    """Call when SIGTERM or SIGINT comes, before the server's own handler does what it does.

    A server tells an application that it stops only after the last answer is sent. Signals reach the main thread only;
    a server in another one is stopped otherwise.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGINT)}

    def handle(number: int, frame: FrameType | None) -> None:
        call()
        handler = before[signal.Signals(number)]
        if callable(handler):
            handler(number, frame)

    for number in before:
        signal.signal(number, handle)
    try:
        yield
    finally:
        for number, handler in before.items():
            if signal.getsignal(number) is handle:
                signal.signal(number, handler)


async def unless_stopping(request: Request, waiting: Coroutine[Any, Any, _Result]) -> _Result | None:
    """Await the coroutine; cancel it and give None as soon as the server is told to stop."""
    stopping: asyncio.Event = request.app.state.stopping
    result, stop = asyncio.ensure_future(waiting), asyncio.ensure_future(stopping.wait())
    try:
        await asyncio.wait({result, stop}, return_when=asyncio.FIRST_COMPLETED)
        return result.result() if result.done() else None
    finally:
        stop.cancel()
        result.cancel()
        await asyncio.wait({result, stop})

"""Threads for blocking calls, in groups: each is bounded, so that what waits in one holds up nothing in another."""

from collections.abc import Callable
from typing import TypeVar

import anyio.to_thread
from anyio.lowlevel import RunVar

#: Decoding of uploads: seconds each, and at most as many as there are decoders take part at a time.
UPLOADS = "uploads"
#: Pictures that are to be made: fractions of a second each; those that are made already wait for none of them.
PICTURES = "pictures"
#: Start and stop of the service, which may wait for the engine.
LIFE = "life"
#: Database and files, milliseconds each: the group of Starlette's own routes, `run_in_threadpool` included.
RECORDS = "records"

AT_ONCE = {UPLOADS: 4, PICTURES: 8, LIFE: 2}

_Result = TypeVar("_Result")
_limiters: RunVar[dict[str, anyio.CapacityLimiter]] = RunVar("limiters")


def limiter(group: str) -> anyio.CapacityLimiter:
    """Give the limiter of a group, of the event loop that runs."""
    if group == RECORDS:
        return anyio.to_thread.current_default_thread_limiter()
    try:
        limiters = _limiters.get()
    except LookupError:
        limiters = {name: anyio.CapacityLimiter(count) for name, count in AT_ONCE.items()}
        _limiters.set(limiters)
    return limiters[group]


async def run(group: str, call: Callable[..., _Result], *arguments: object) -> _Result:
    """Run a blocking call in a thread of a group; while all of them are taken, it waits."""
    return await anyio.to_thread.run_sync(call, *arguments, limiter=limiter(group))

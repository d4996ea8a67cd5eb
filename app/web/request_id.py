"""Request id: a UUID of every request, in its answer's ``X-Request-ID``, in problems and in the log."""

import uuid
from contextvars import ContextVar

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

HEADER = "X-Request-ID"
_current: ContextVar[str] = ContextVar("request_id", default="")


def request_id() -> str:
    """Give the id of the request that is being answered; nothing outside of one."""
    return _current.get()


class RequestId:
    """Gives every request an id of its own: one that a client sends would let it write into the log.

    It stays set when this returns: what the server itself logs of the request comes afterwards, in the same task.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        identifier = str(uuid.uuid4())
        _current.set(identifier)

        async def send_with_id(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message)[HEADER] = identifier
            await send(message)

        await self.app(scope, receive, send_with_id)

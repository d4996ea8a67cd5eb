"""HEAD requests: answered as GET, without the body."""

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send


class _HeadersSentError(Exception):
    """Ends the route once its headers are out: no file is read, no event awaited."""


class HeadAsGet:
    """Lets GET routes answer HEAD.

    ``Range`` is dropped, for RFC 9110 defines it for GET only.
    """

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self.app(scope, receive, send)
            return
        as_get = {**scope, "method": "GET", "headers": [*scope["headers"]]}
        del MutableHeaders(scope=as_get)["range"]

        async def send_headers(message: Message) -> None:
            await send(message)
            if message["type"] == "http.response.start":
                await send({"type": "http.response.body", "body": b"", "more_body": False})
                raise _HeadersSentError

        try:
            await self.app(as_get, receive, send_headers)
        except* _HeadersSentError:
            pass
        finally:
            scope["route"] = as_get.get("route")  # for the metrics

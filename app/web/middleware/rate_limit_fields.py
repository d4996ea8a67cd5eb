"""Rate limit header fields: adds what the routes have counted to their answers."""

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.web.limits import SCOPE_KEY


class RateLimitFields:
    """Adds ``RateLimit`` and ``RateLimit-Policy`` to answers of requests that were counted."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        async def send_with_fields(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(scope.get(SCOPE_KEY, {}))
            await send(message)

        await self.app(scope, receive, send_with_fields)

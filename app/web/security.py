"""What browsers are told to allow: headers of every answer.

Any web page may *read* the API, without cookies: results are public, or have an unguessable address.
"""

from collections.abc import Iterator

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

API_PREFIX = "/api/"

CONTENT_SECURITY_POLICY = "; ".join(
    [
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data: blob:",
        "media-src 'self'",
        "connect-src 'self'",
        "form-action 'self'",
        "base-uri 'none'",
        "frame-ancestors 'none'",
    ]
)
_HEADERS = {
    "Content-Security-Policy": CONTENT_SECURITY_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",  # the address of an unlisted experiment is its only lock
    "Permissions-Policy": "camera=(), microphone=(), geolocation=(), payment=(), usb=()",
    "Cross-Origin-Opener-Policy": "same-origin",
}
_READABLE_HEADERS = "Accept-Ranges, Content-Disposition, Content-Range, ETag, Link, Retry-After"


def security_headers(path: str) -> Iterator[tuple[str, str]]:
    """Give the headers that every answer at this path has."""
    yield from _HEADERS.items()
    if path.startswith(API_PREFIX):
        yield "Cross-Origin-Resource-Policy", "cross-origin"
        yield "Access-Control-Allow-Origin", "*"
        yield "Access-Control-Expose-Headers", _READABLE_HEADERS
    else:
        yield "Cross-Origin-Resource-Policy", "same-origin"


class SecurityHeaders:
    """Adds `security_headers`, and keeps answers out of shared caches unless their routes say otherwise."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in security_headers(scope["path"]):
                    headers.setdefault(name, value)
                headers.setdefault("Cache-Control", "private, no-cache")
            await send(message)

        await self.app(scope, receive, send_with_headers)

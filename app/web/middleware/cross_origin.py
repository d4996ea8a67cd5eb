"""CSRF protection: rejects cross-site writes by Sec-Fetch-Site and Origin; answers CORS preflights for reads.

Writes are accepted from our own pages and from programs. Browsers set both headers themselves; no page can forge them.
Behind a proxy that changes the Host header our own pages look like another site's: the error message says so.
"""

from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from app.web.headers import API_PREFIX
from app.web.problems import respond

_READING = {"GET", "HEAD", "OPTIONS"}
_QUOTED = 100  # characters of a header in a message


class CrossOrigin:
    """Answers CORS preflights of reads, and refuses writes that another site's page makes a browser send.

    Browsers name where a request comes from in ``Sec-Fetch-Site`` and ``Origin``; programs send neither.
    """

    def __init__(self, app: ASGIApp, *, public_address: str | None) -> None:
        self.app = app
        parts = urlsplit(public_address or "")
        self.public_origin = f"{parts.scheme}://{parts.netloc}" if parts.netloc else None

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        method = scope["method"]
        if method == "OPTIONS" and "access-control-request-method" in headers and scope["path"].startswith(API_PREFIX):
            allowed = {
                "Access-Control-Allow-Methods": "GET, HEAD",
                "Access-Control-Allow-Headers": "If-None-Match, Last-Event-ID, Range",
                "Access-Control-Max-Age": "86400",
            }
            await Response(status_code=204, headers=allowed)(scope, receive, send)
        elif method not in _READING and self._is_foreign(headers):
            await respond(Request(scope), 403, self._explain(headers))(scope, receive, send)
        else:
            await self.app(scope, receive, send)

    def _is_foreign(self, headers: Headers) -> bool:
        origin = headers.get("origin")
        if origin is not None and origin == self.public_origin:
            return False
        site = headers.get("sec-fetch-site")
        if site is not None:
            return site not in {"same-origin", "none"}
        return origin is not None and urlsplit(origin).netloc != headers.get("host")

    def _explain(self, headers: Headers) -> str:
        """Say what was compared, so that who set up a proxy in front of this sees which header it spoils."""
        origin, host = (headers.get(name, "nothing")[:_QUOTED] for name in ("origin", "host"))
        known = f"it is {self.public_origin}" if self.public_origin else "it is not set"
        return (
            "Another site's page may not change anything here: use this site's own pages, or a program. "
            f"The request's Origin header says {origin}, its Host header says {host}. If both mean this site, a proxy "
            "in front of it changes the Host header: let the proxy pass it on unchanged, or set "
            f"MICROTEXTURE_BASE_URL to the address that browsers show ({known})."
        )

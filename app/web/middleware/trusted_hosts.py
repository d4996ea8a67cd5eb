"""Host header check: refuses requests for names that the operator did not list (DNS rebinding, poisoned links)."""

from collections.abc import Iterable

from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from app.web.problems import respond

LOOPBACK = frozenset({"localhost", "127.0.0.1", "[::1]"})
PROBES = frozenset({"/healthz", "/readyz"})  # asked by an address that no operator knows beforehand
_QUOTED = 100  # characters of a header in a message


class TrustedHosts:
    """Answers 400 to a request for another host than those in ``names``; without any, every host is answered.

    A page of another site whose name was made to lead to this service has the same origin as its answers, for the
    browser; only the ``Host`` header tells. The loopback's own names and the probes are always answered.

    Parameters
    ----------
    names : iterable of str
        Names without a port; ``*.example.org`` stands for every name below ``example.org``.
    """

    def __init__(self, app: ASGIApp, *, names: Iterable[str]) -> None:
        self.app = app
        listed = frozenset(names)
        self.open = not listed
        self.names = LOOPBACK | {name for name in listed if not name.startswith("*.")}
        self.suffixes = tuple(name.removeprefix("*") for name in listed if name.startswith("*."))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or self.open or scope["path"] in PROBES:
            await self.app(scope, receive, send)
            return
        hosts = Headers(scope=scope).getlist("host")
        if hosts and all(self.trusts(host_name(host)) for host in hosts):
            await self.app(scope, receive, send)
            return
        host = hosts[-1][:_QUOTED] if hosts else "nothing"
        detail = (
            f"This service is not known as {host}: use the address that you were given. If this is its operator's own "
            "name, add it to MICROTEXTURE_TRUSTED_HOSTS, or let the proxy pass the Host header on unchanged."
        )
        await respond(Request(scope), 400, detail)(scope, receive, send)

    def trusts(self, name: str) -> bool:
        """Whether requests for this name are answered."""
        return name in self.names or name.endswith(self.suffixes)


def host_name(host: str) -> str:
    """Name in a ``Host`` header: without the port, in lower case, without the root's dot.

    Examples
    --------
    >>> host_name("Texture.example.org.:8080"), host_name("[::1]:8000"), host_name("127.0.0.1")
    ('texture.example.org', '[::1]', '127.0.0.1')
    """
    host = host.strip().lower()
    name = host.partition("]")[0] + "]" if host.startswith("[") else host.partition(":")[0]
    return name.removesuffix(".")

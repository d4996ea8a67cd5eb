"""Client identity for fair shares: the address that a request comes from, and the owner's token that it carries.

Nobody has to log in and a token is given to whoever asks, so a token alone limits nobody: every share counts for the
token *and*, a few times larger, for the address. People behind one address are told apart by their tokens, and who
makes tokens up gets no more than the address may.
"""

import ipaddress
import logging
from dataclasses import dataclass
from functools import lru_cache

from fastapi import Request

from app.experiments.queue_port import PLACE
from app.experiments.tokens import token_digest
from app.web.deps import is_operator, owner_token

log = logging.getLogger(__name__)

IPV6_PREFIX = 64  # what one household or machine is given
LOCAL = "local"  # a socket of this machine has no address


@dataclass(frozen=True)
class Client:
    """Who asks.

    Parameters
    ----------
    address : str
        An IPv4 address, an IPv6 network, or `LOCAL`.
    token : str, optional
        Digest of the owner's token.
    operator : bool
        Whether the token is the operator's, whom nothing limits.
    """

    address: str
    token: str | None = None
    operator: bool = False

    @property
    def name(self) -> str:
        """Name in the job queue: digests of the address and of the token, `PLACE` characters each, the address first.

        The database learns no address in this way. The operator has none, as the service itself.

        Examples
        --------
        >>> one, other = Client("203.0.113.7", token_digest("one")), Client("203.0.113.7", token_digest("other"))
        >>> one.name[:PLACE] == other.name[:PLACE], one.name == other.name, len(one.name)
        (True, False, 32)
        """
        if self.operator:
            return ""
        return token_digest(self.address)[:PLACE] + (self.token or "")[:PLACE]


def client_of(request: Request) -> Client:
    """Tell who sent a request; behind a trusted proxy the server has put the client's address in its place."""
    peer = request.client
    forwarded = request.headers.get("x-forwarded-for", "")
    if peer and forwarded and peer.host not in forwarded and _is_private(peer.host):
        _warn(peer.host)  # were the header believed, one of its addresses were in the place of the proxy's
    token = owner_token(request)
    operator = token is not None and is_operator(request, token)
    return Client(network_of(peer.host if peer else ""), token and token_digest(token), operator)


@lru_cache(maxsize=16)
def _warn(proxy: str) -> None:
    """Tell the operator, once of each proxy."""
    log.warning(
        "Requests come through a proxy at %s whose X-Forwarded-For is not believed: all of its visitors share the "
        "limits of one. If it is yours, name it in MICROTEXTURE_FORWARDED_ALLOW_IPS.",
        proxy,
    )


def _is_private(host: str) -> bool:
    try:
        return ipaddress.ip_address(host.partition("%")[0]).is_private
    except ValueError:
        return False


def network_of(host: str) -> str:
    """Network that counts as one client: an IPv4 address, or the /64 of an IPv6 address.

    Examples
    --------
    >>> network_of("203.0.113.7"), network_of("::ffff:203.0.113.7"), network_of("2001:db8:1:2:3:4:5:6%eth0")
    ('203.0.113.7', '203.0.113.7', '2001:db8:1:2::/64')
    >>> network_of("")
    'local'
    """
    try:
        address = ipaddress.ip_address(host.partition("%")[0].strip("[]"))
    except ValueError:
        return host or LOCAL
    if isinstance(address, ipaddress.IPv4Address):
        return str(address)
    if address.ipv4_mapped:
        return str(address.ipv4_mapped)
    return str(ipaddress.ip_network((address, IPV6_PREFIX), strict=False))

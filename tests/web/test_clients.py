"""Who counts as one client."""

import ipaddress

import pytest
from fastapi import FastAPI, Request
from hypothesis import given
from hypothesis import strategies as st

from app.experiments.queue_port import PLACE
from app.experiments.tokens import token_digest
from app.settings import Settings
from app.web.clients import Client, client_of, network_of


@given(st.ip_addresses(v=4))
def test_every_ipv4_address_is_one_also_when_written_as_ipv6(address: ipaddress.IPv4Address) -> None:
    assert network_of(str(address)) == network_of(f"::ffff:{address}") == str(address)


@given(network=st.integers(0, 2**64 - 1), one=st.integers(0, 2**64 - 1), other=st.integers(0, 2**64 - 1))
def test_every_ipv6_network_is_one(network: int, one: int, other: int) -> None:
    """Who has one machine has 2⁶⁴ addresses."""
    hosts = [ipaddress.IPv6Address(network << 64 | host) for host in (one, other)]
    if not any(host.ipv4_mapped for host in hosts):
        assert network_of(str(hosts[0])) == network_of(str(hosts[1]))
        neighbour = ipaddress.IPv6Address((network ^ 1) << 64 | one)
        if not neighbour.ipv4_mapped:
            assert network_of(str(neighbour)) != network_of(str(hosts[0]))


def test_the_queue_learns_digests_whose_first_part_is_the_address() -> None:
    tokens = [token_digest(word) for word in ("one", "other")]
    names = [Client("203.0.113.7", token).name for token in (*tokens, None)]
    assert len(set(names)) == 3
    assert {name[:PLACE] for name in names} == {names[2]}
    assert all("203" not in name or name.isalnum() for name in names)


def test_a_proxy_that_is_not_believed_is_told_of_once(caplog: pytest.LogCaptureFixture) -> None:
    """Else all of its visitors share the limits of one, and nobody knows why."""
    app = FastAPI()
    app.state.settings = Settings()

    def asked(peer: str, forwarded: str) -> Client:
        headers = [(b"x-forwarded-for", forwarded.encode())] if forwarded else []
        return client_of(Request({"type": "http", "app": app, "headers": headers, "client": (peer, 1), "path": "/"}))

    asked("10.9.8.7", "")
    asked("10.9.8.6", "10.9.8.6, 10.9.8.5")  # believed: the server put it in the proxy's place
    asked("8.8.8.8", "10.9.8.6")  # anybody may send it
    assert caplog.text == ""
    assert [asked("10.9.8.7", "8.8.8.8").address for _ in range(3)] == ["10.9.8.7"] * 3
    assert caplog.text.count("MICROTEXTURE_FORWARDED_ALLOW_IPS") == 1
    assert "10.9.8.7" in caplog.text

"""A service that knows its names answers to no other one."""

from collections.abc import Iterator
from html import unescape
from typing import Any

import pytest
from pydantic import ValidationError

from app.settings import Settings

NAMES = "texture.example.org, *.example.net"


@pytest.fixture(scope="module")
def named(serve: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with serve(tmp_path_factory.mktemp("named"), trusted_hosts=NAMES, base_url="https://public.example.org") as site:
        yield site


@pytest.mark.parametrize(
    "host",
    [
        "texture.example.org",
        "Texture.Example.Org:8443",
        "texture.example.org.",
        "a.example.net",
        "b.a.example.net:80",
        "public.example.org",
        "localhost:8000",
        "127.0.0.1",
        "[::1]:8000",
    ],
)
def test_its_names_and_the_loopbacks_are_answered(named: Any, host: str) -> None:
    assert named.client.get("/api/v1/methods", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "example.net",
        "evilexample.net",
        "texture.example.org.evil.example",
        "127.0.0.1.evil.example",
        "",
    ],
)
def test_another_name_is_refused_in_words(named: Any, host: str) -> None:
    """As a problem and as a page, with the setting that its operator would look for."""
    problem = named.client.get("/api/v1/methods", headers={"Host": host})
    assert (problem.status_code, problem.headers["Content-Type"]) == (400, "application/problem+json")
    page = named.client.get("/", headers={"Host": host})
    assert page.status_code == 400
    assert page.headers["Content-Type"].startswith("text/html")
    assert page.headers["X-Content-Type-Options"] == "nosniff"
    for text in (problem.json()["detail"], unescape(page.text)):
        assert "MICROTEXTURE_TRUSTED_HOSTS" in text


def test_a_rebound_name_writes_nothing(named: Any) -> None:
    """The browser believes that both are one site, and says so."""
    headers = {"Host": "evil.example", "Origin": "http://evil.example", "Sec-Fetch-Site": "same-origin"}
    assert named.client.post("/samples", headers=headers).status_code == 400


@pytest.mark.parametrize("path", ["/healthz", "/readyz"])
def test_a_probe_need_not_know_the_name(named: Any, path: str) -> None:
    assert named.client.get(path, headers={"Host": "10.0.0.7:8000"}).status_code == 200


def test_without_the_setting_every_name_is_answered(site: Any) -> None:
    assert site.client.get("/api/v1/methods", headers={"Host": "anything.example"}).status_code == 200


@pytest.mark.parametrize("name", ["https://texture.example.org", "texture.example.org:443", "a/b", "*", "*.", "a b"])
def test_what_is_no_name_is_refused_at_the_start(name: str) -> None:
    with pytest.raises(ValidationError, match="no host name"):
        Settings(trusted_hosts=name)

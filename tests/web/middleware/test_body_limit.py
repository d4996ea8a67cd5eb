"""Oversized bodies are refused, declared or not, and the client hears of it."""

import socket

import pytest

from app.web.middleware.body_limit import FORM_BYTES, JSON_BYTES

PROBLEM = "application/problem+json"
HEAD = b'--b\r\nContent-Disposition: form-data; name="file"; filename="a.png"\r\n\r\n'
FORM = {"Content-Type": "multipart/form-data; boundary=b"}


def chunks(count):
    yield HEAD
    for _ in range(count):
        yield b"x" * (1 << 16)
    yield b"\r\n--b--\r\n"


@pytest.mark.parametrize("path", ["/api/v1/samples", "/api/v1/synthesize"])
@pytest.mark.parametrize("declared", [True, False], ids=["declared", "chunked"])
@pytest.mark.parametrize("excess", [1, FORM_BYTES * 2], ids=["file just over", "body far over"])
def test_an_oversized_upload_is_too_large(site, path, declared, excess):
    count = -(-(site.settings.max_upload_bytes + excess) // (1 << 16))
    content = b"".join(chunks(count)) if declared else chunks(count)
    response = site.client.post(path, content=content, headers=FORM)
    assert (response.status_code, response.headers["Content-Type"]) == (413, PROBLEM)
    assert "256 kB" in response.json()["detail"]
    assert site.incoming == []


@pytest.mark.parametrize("declared", [True, False], ids=["declared", "chunked"])
def test_an_oversized_json_body_is_too_large(site, declared):
    content = b" " * (2 << 20) if declared else iter([b" " * (1 << 20)] * 2)
    response = site.client.post("/api/v1/experiments", content=content, headers={"Content-Type": "application/json"})
    assert (response.status_code, response.headers["Content-Type"]) == (413, PROBLEM)


@pytest.mark.parametrize("kind", ["application/json", "multipart/form-data; boundary=b", "text/plain"])
@pytest.mark.parametrize("path", ["experiments", "check"])
def test_json_routes_take_64_kilobytes_of_any_kind_of_body(site, path, kind):
    for size, expected in ((JSON_BYTES, {400, 415, 422}), (JSON_BYTES + 1, {413})):
        response = site.client.post(f"/api/v1/{path}", content=b" " * size, headers={"Content-Type": kind})
        assert response.status_code in expected, (size, response.text)
    assert "64 kB" in response.json()["detail"]


def test_an_oversized_form_of_a_page_is_answered_with_a_page(site):
    response = site.client.post("/samples", content=b"".join(chunks(40)), headers=FORM)
    assert response.status_code == 413
    assert response.headers["Content-Type"].startswith("text/html")


def test_who_asks_first_is_refused_before_sending(site):
    host, port = site.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=10) as connection:
        connection.sendall(
            b"POST /api/v1/samples HTTP/1.1\r\nHost: test\r\nContent-Type: multipart/form-data; boundary=b\r\n"
            b"Content-Length: 900000000\r\nExpect: 100-continue\r\n\r\n"
        )
        assert connection.recv(1000).startswith(b"HTTP/1.1 413")


def test_a_client_that_goes_in_the_middle_leaves_nothing(site, until):
    host, port = site.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=10) as connection:
        head = b"POST /api/v1/samples HTTP/1.1\r\nHost: test\r\nContent-Type: multipart/form-data; boundary=b\r\n"
        connection.sendall(head + b"Content-Length: 100000\r\n\r\n" + HEAD + b"x" * 1000)
        until(lambda: site.incoming)
    until(lambda: not site.incoming)

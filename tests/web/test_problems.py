"""Every error under ``/api`` is a problem, every error elsewhere a page."""

import asyncio
import errno
import logging
import pickle
from typing import cast

import httpx
import pytest

from app import errors
from app.experiments.service import Service
from app.main import create_app
from app.web.problems import STATUS, title

PROBLEM = "application/problem+json"


def test_every_error_has_a_status_code():
    children = {kind for kind in vars(errors).values() if isinstance(kind, type) and issubclass(kind, errors.AppError)}
    assert children - {errors.AppError} == set(STATUS)


def test_titles_are_those_of_rfc_9110():
    assert [title(status) for status in (413, 422, 404)] == ["Content Too Large", "Unprocessable Content", "Not Found"]


def test_a_problem_says_what_rfc_9457_asks_for(site):
    response = site.client.get("/api/v1/experiments/none")
    problem = response.json()
    assert response.headers["Content-Type"] == PROBLEM
    assert problem["type"] == "about:blank"
    assert problem["title"] == "Not Found"
    assert problem["status"] == response.status_code == 404
    assert problem["detail"]
    assert response.headers["Cache-Control"] == "no-store"


@pytest.mark.parametrize("path", ["/api/", "/api/v1/", "/api/v2/methods", "/api/v1/nothing", "/api/v1/methods/nothing"])
def test_unknown_addresses_of_the_api(site, path):
    response = site.client.get(path)
    assert (response.status_code, response.headers["Content-Type"]) == (404, PROBLEM)


@pytest.mark.parametrize("path", ["/nothing", "/experiments/none", "/static/none.css"])
def test_unknown_addresses_elsewhere_are_pages(site, path):
    response = site.client.get(path)
    assert response.status_code == 404
    assert response.headers["Content-Type"].startswith("text/html")


@pytest.mark.parametrize(
    ("method", "path", "allow"),
    [
        ("PUT", "/api/v1/experiments/x", {"GET", "HEAD", "PATCH", "DELETE"}),
        ("DELETE", "/api/v1/experiments", {"GET", "HEAD", "POST"}),
        ("GET", "/api/v1/synthesize", {"POST"}),
        ("HEAD", "/api/v1/synthesize", {"POST"}),
        ("OPTIONS", "/api/v1/methods", {"GET", "HEAD"}),
        ("BREW", "/api/v1/methods", {"GET", "HEAD"}),
    ],
)
def test_another_method_is_told_those_allowed(site, method, path, allow):
    response = site.client.request(method, path)
    assert (response.status_code, set(response.headers["Allow"].split(", "))) == (405, allow)
    assert response.headers["Content-Type"] == PROBLEM


@pytest.mark.parametrize(
    ("content", "content_type", "status"),
    [
        (b"{", "application/json", 400),
        (b'{"method": "\xff"}', "application/json", 400),
        (b'{"a": ' * 10_000, "application/json", 400),
        (b"9" * 5000, "application/json", 400),
        (b"[]", "application/json", 422),
        (b"null", "application/json", 422),
        (b"", "application/json", 422),
        (b"{}", "text/plain", 415),
        (b"{}", "application/x-www-form-urlencoded", 415),
        (b"{}", None, 415),
        (b'{"method":"rpn","inputs":[{"sample":"gravel_gray"}],"parameters":{"alpha":NaN}}', "application/json", 422),
        (b'{"method":"\\ud800","inputs":[{"sample":"gravel_gray"}]}', "application/json", 422),
        (b'{"method":"rpn","inputs":[{"sample":"gravel_gray"}],"parameters":{"\\ud800":1}}', "application/json", 422),
        (
            b'{"method":"rpn","inputs":[{"sample":"gravel_gray"}],"parameters":{"window":"\\ud800"}}',
            "application/json",
            422,
        ),
    ],
    ids=[
        "broken",
        "not UTF-8",
        "deep",
        "huge number",
        "list",
        "null",
        "empty",
        "text",
        "form",
        "untyped",
        "NaN",
        "surrogate",
        "surrogate name",
        "surrogate value",
    ],
)
def test_a_body_that_is_not_the_json_that_is_asked_for(site, content, content_type, status):
    headers = {"Content-Type": content_type} if content_type else {}
    response = site.client.post("/api/v1/experiments", content=content, headers=headers)
    assert (response.status_code, response.headers["Content-Type"]) == (status, PROBLEM)


FORM = {"Content-Type": "multipart/form-data; boundary=b"}
FILE = b'--b\r\nContent-Disposition: form-data; name="file"; filename="a.png"\r\n\r\nx'


@pytest.mark.parametrize(
    ("content", "headers", "status"),
    [
        (b"", {"Content-Type": "multipart/form-data"}, 400),
        (b"", {"Content-Type": "multipart/form-data; boundary=" + "b" * 300}, 400),
        (b"nonsense", FORM, 400),
        (FILE, FORM, 400),
        (b'--b\r\nContent-Disposition: form-data; name="\xff"\r\n\r\nx\r\n--b--\r\n', FORM, 400),
        (b'--b\r\nContent-Disposition: form-data; name="a"\r\n\r\n\xff\r\n--b--\r\n', FORM, 400),
        (b"--b\r\n\r\nx\r\n--b--\r\n", FORM, 400),
        (b'--b\r\nContent-Disposition: form-data; name="a"\r\n\r\n' + b"x" * 20_000 + b"\r\n--b--\r\n", FORM, 400),
        (b"".join(b'--b\r\nContent-Disposition: form-data; name="%d"\r\n\r\nx\r\n' % i for i in range(99)), FORM, 400),
        (FILE + b"\r\n" + FILE + b"\r\n--b--\r\n", FORM, 400),
        (b"file=x", {"Content-Type": "application/x-www-form-urlencoded"}, 415),
        (b"x", {"Content-Type": "image/png"}, 415),
        (b"x", {}, 415),
    ],
    ids=[
        "no boundary",
        "long boundary",
        "nonsense",
        "cut off",
        "name not UTF-8",
        "text not UTF-8",
        "no name",
        "long field",
        "many fields",
        "two files",
        "urlencoded",
        "bare file",
        "untyped",
    ],
)
@pytest.mark.parametrize("path", ["/api/v1/samples", "/api/v1/synthesize"])
def test_a_form_that_cannot_be_read(site, path, content, headers, status):
    response = site.client.post(path, content=content, headers=headers)
    assert (response.status_code, response.headers["Content-Type"]) == (status, PROBLEM)
    assert site.incoming == []


def answer_to(error: Exception, settings) -> httpx.Response:
    """What a request is answered in which this is raised."""

    class Broken:
        ready = True
        samples = property(lambda self: self)

        def start(self) -> None: ...

        def close(self) -> None: ...

        def bundled(self):
            raise error

    transport = httpx.ASGITransport(create_app(settings, cast(Service, Broken())), raise_app_exceptions=False)

    async def ask():
        async with httpx.AsyncClient(transport=transport, base_url="http://test") as client:
            return await client.get("/api/v1/samples")

    return asyncio.run(ask())


@pytest.mark.parametrize("part", [errors.DATABASE, errors.STORAGE, errors.ENGINE, errors.DISK_SPACE])
def test_a_part_that_is_away_is_named_and_when_to_come_back(site, part):
    response = answer_to(errors.UnavailableError(part, f"Try again in a minute: no {part} for now."), site.settings)
    assert (response.status_code, response.headers["Content-Type"]) == (503, PROBLEM)
    assert int(response.headers["Retry-After"]) > 0
    assert part in response.json()["detail"]


@pytest.mark.parametrize("kind", STATUS)
def test_errors_come_out_of_another_process_as_they_were(kind):
    error = kind("database", "It is away.") if kind is errors.UnavailableError else kind("It is wrong.")
    copy = pickle.loads(pickle.dumps(error))
    assert (type(copy), str(copy), vars(copy)) == (kind, error.message, vars(error))


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.ENOENT, errno.EIO])
def test_files_that_cannot_be_read_or_written_are_nobodys_mistake(site, number):
    response = answer_to(OSError(number, "the disk says no"), site.settings)
    assert (response.status_code, response.headers["Content-Type"]) == (503, PROBLEM)
    assert int(response.headers["Retry-After"]) > 0


def test_an_unexpected_error_tells_nothing_and_is_logged(site, caplog):
    with caplog.at_level(logging.ERROR):
        response = answer_to(RuntimeError("the password is swordfish"), site.settings)
    assert (response.status_code, response.headers["Content-Type"]) == (500, PROBLEM)
    assert "swordfish" not in response.text
    assert "Content-Security-Policy" in response.headers

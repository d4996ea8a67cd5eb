"""One client's requests are refused beyond its share, in words and with the header fields of the IETF's draft."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from pydantic import ValidationError

from app.errors import QuotaError
from app.experiments.tokens import new_token
from app.settings import Settings
from app.web.clients import Client
from app.web.limits import EXPERIMENTS, UPLOADS, VIEWS, Limits

POLICY = re.compile(r'"[a-z]+-(?:client|address)-\d+s";q=\d+;w=\d+(?:, |$)')
LEFT = re.compile(r'"[a-z]+-(?:client|address)-\d+s";r=\d+;t=\d+')
WORDS = r"Wait (?:1 minute|\d+ seconds?): this service takes at most 3 .* a minute from one client\."
FORM = {
    "sample": "gravel_gray",
    "crop.x": "4",
    "crop.y": "6",
    "crop.width": "20",
    "crop.height": "16",
    "method": "rpn",
    "size": "1",
    "seed": "3",
    "rpn.alpha": "0.1",
}


def own() -> dict[str, str]:
    """Headers of somebody new."""
    return {"Authorization": f"Bearer {new_token()}"}


@pytest.fixture(scope="module")
def limited(serve: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A service where everybody has three of each a minute, and an address has as many as ten thousand."""
    each = ("uploads", "experiments", "conversions", "deep", "views")
    texts = {f"limit_{kind}": "3/minute" for kind in each}
    directory = tmp_path_factory.mktemp("limited")
    with serve(directory, limits=True, limit_address=10_000, limit_streams=2, **texts) as site:
        yield site


@pytest.fixture(scope="module")
def record(limited: Any) -> dict[str, Any]:
    with limited.visitor(headers=own()) as visitor:
        answer = limited.run(client=visitor)
    assert answer.status_code == 201
    return dict(answer.json())


def requests(limited: Any, record: dict[str, Any], picture: Callable[..., bytes]) -> dict[str, tuple[str, str, dict]]:
    """One request of each kind that is limited, in the API and on the pages."""
    output = record["outputs"][0]["url"]
    inputs = [{"sample": "gravel_gray", "crop": {"x": 0, "y": 0, "width": 32, "height": 24}}]
    files = {"file": ("photo.png", picture(32, 32))}
    with limited.visitor(headers=own()) as visitor:
        sample = visitor.post("/api/v1/samples", files=files).json()["url"]
    return {
        "upload": ("POST", "/api/v1/samples", {"files": files}),
        "upload by form": ("POST", "/samples", {"files": files}),
        "experiment": ("POST", "/api/v1/experiments", {"json": {"method": "rpn", "inputs": inputs}}),
        "experiment by form": ("POST", "/experiments", {"data": FORM}),
        "again": ("POST", f"/experiments/{record['id']}/again", {"data": {"method": "rpn"}}),
        "synthesis": ("POST", "/api/v1/synthesize", {"files": files, "data": {"method": "rpn"}}),
        "conversion": ("GET", f"{output}?format=jpeg", {}),
        "ZIP": ("GET", f"{record['url']}/outputs.zip", {}),
        "16 bits": ("GET", f"{output}?depth=16", {}),
        "picture of an upload": ("GET", f"{sample}/image?size=256", {}),
        "measurement": ("GET", f"{sample}/structure", {}),
        "check": ("POST", "/api/v1/check", {"json": {"method": "rpn", "inputs": inputs}}),
        "check by form": ("POST", "/experiments/check", {"data": FORM}),
    }


NAMES = [
    "upload",
    "upload by form",
    "experiment",
    "experiment by form",
    "again",
    "synthesis",
    "conversion",
    "ZIP",
    "16 bits",
    "picture of an upload",
    "measurement",
    "check",
    "check by form",
]


@pytest.mark.parametrize("name", NAMES)
def test_the_fourth_of_a_minute_is_refused(
    limited: Any, record: dict[str, Any], picture: Callable[..., bytes], name: str
) -> None:
    method, path, options = requests(limited, record, picture)[name]
    with limited.visitor(headers=own()) as visitor:
        answers = [visitor.request(method, path, **options) for _ in range(4)]
        *taken, refused = answers
        assert all(answer.status_code < 400 for answer in taken), [answer.text for answer in taken]
        assert refused.status_code == 429
        assert 0 < int(refused.headers["Retry-After"]) <= 60
        for answer in answers:
            assert POLICY.sub("", answer.headers["RateLimit-Policy"]) == ""
            assert LEFT.fullmatch(answer.headers["RateLimit"])
        remaining = [int(re.findall(r";r=(\d+)", answer.headers["RateLimit"])[0]) for answer in answers]
        assert remaining == [2, 1, 0, 0]
        if "/api/" in path:
            assert refused.headers["Content-Type"] == "application/problem+json"
            assert re.search(
                WORDS,
                refused.json()["detail"],
            )
        else:
            assert refused.headers["Content-Type"].startswith("text/html")
            assert re.search(
                WORDS,
                refused.text,
            )
    with limited.visitor(headers=own()) as another:
        assert another.request(method, path, **options).status_code < 400


def test_a_refused_form_keeps_what_was_filled_in(limited: Any) -> None:
    with limited.visitor(headers=own()) as visitor:
        for _ in range(3):
            visitor.post("/experiments", data=FORM)
        page = visitor.post("/experiments", data=FORM | {"seed": "4711"})
    assert page.status_code == 429
    assert 'value="4711"' in page.text
    assert "Too many requests" in page.text


def test_a_refused_upload_is_read_to_its_end(limited: Any, picture: Callable[..., bytes]) -> None:
    """Most clients look for an answer only then."""
    files = {"file": ("photo.png", picture(32, 32) + bytes(200_000))}
    with limited.visitor(headers=own()) as visitor:
        for _ in range(12):
            answer = visitor.post("/api/v1/samples", files=files)
        assert answer.status_code == 429
    assert limited.incoming == []


def test_a_page_with_sixty_pictures_is_not_limited(limited: Any, record: dict[str, Any]) -> None:
    """Nor its own pictures at 8 bits, nor what comes with the service."""
    with limited.visitor(headers=own()) as visitor:
        for path in ("/api/v1/samples/gravel_gray/image?size=256", f"{record['url']}/outputs/.preview", "/archive"):
            assert {visitor.get(path).status_code for _ in range(60)} == {200}


def test_a_download_that_is_refused_is_explained_on_a_page(limited: Any, record: dict[str, Any]) -> None:
    """The links of an experiment's page lead into the API."""
    with limited.visitor(headers=own() | {"Sec-Fetch-Dest": "document"}) as visitor:
        for _ in range(4):
            answer = visitor.get(f"{record['outputs'][0]['url']}?download=true&format=jpeg")
    assert answer.status_code == 429
    assert answer.headers["Content-Type"].startswith("text/html")
    assert "Too many requests" in answer.text


def test_an_answer_that_costs_nothing_is_not_counted(limited: Any, record: dict[str, Any]) -> None:
    """What the client has already, and what was asked for wrongly."""
    with limited.visitor(headers=own()) as visitor:
        path = f"{record['outputs'][0]['url']}?format=webp"
        first = visitor.get(path)
        again = [visitor.get(path, headers={"If-None-Match": first.headers["ETag"]}) for _ in range(9)]
        assert {answer.status_code for answer in again} == {304}


def test_the_operator_is_not_limited(limited: Any, operator: dict[str, str]) -> None:
    with limited.visitor(headers=operator) as visitor:
        assert {limited.run(client=visitor, wait=False).status_code for _ in range(9)} == {202}


def test_behind_a_trusted_proxy_the_visitors_address_counts(
    serve: Any, tmp_path: Any, caplog: pytest.LogCaptureFixture
) -> None:
    """Of IPv6 its network. The test's server trusts the loopback, as a service does whose proxy is named."""
    with serve(tmp_path, limits=True, limit_experiments="2/hour", limit_address=1) as site:

        def status(address: str) -> int:
            with site.visitor(headers={"X-Forwarded-For": address}) as visitor:
                return int(site.run(client=visitor, wait=False).status_code)

        same = ["203.0.113.7", "203.0.113.7", "203.0.113.7"]
        assert [status(address) for address in same] == [202, 202, 429]
        assert status("203.0.113.8") == 202
        network = ["2001:db8:1:2::1", "2001:db8:1:2:ffff::2", "2001:db8:1:2:3:4:5:6"]
        assert [status(address) for address in network] == [202, 202, 429]
        assert status("2001:db8:1:3::1") == 202
        assert "MICROTEXTURE_FORWARDED_ALLOW_IPS" not in caplog.text


def test_event_streams_of_a_client_are_few_and_are_given_back(limited: Any, until: Any) -> None:
    with limited.gate.closed(), limited.visitor(headers=own()) as visitor:
        address = f"{limited.run(client=visitor, wait=False).json()['url']}/events"
        with visitor.stream("GET", address) as one, visitor.stream("GET", address) as two:
            assert (one.status_code, two.status_code) == (200, 200)
            with visitor.stream("GET", address) as refused:
                assert refused.status_code == 429
                assert int(refused.headers["Retry-After"]) > 0
                assert "2 event streams" in refused.read().decode()
            with limited.visitor(headers=own()) as another, another.stream("GET", address) as third:
                assert third.status_code == 200

        def free() -> bool:
            with visitor.stream("GET", address) as answer:
                return bool(answer.status_code == 200)

        until(free)


def test_uploads_are_counted_as_what_they_take_on_the_disk(
    serve: Any, tmp_path: Any, picture: Callable[..., bytes]
) -> None:
    """A small JPEG that is large once it is decoded counts as that; full is refused before anything is read."""
    small = picture(400, 300, form="JPEG")
    with serve(tmp_path, limits=True, upload_budget=100_000) as site, site.visitor(headers=own()) as visitor:
        assert len(small) < 100_000
        assert visitor.post("/api/v1/samples", files={"file": ("a.jpg", small)}).status_code == 201
        refused = visitor.post("/api/v1/samples", files={"file": ("a.jpg", small)})
        assert (refused.status_code, refused.json()["title"]) == (429, "Too Many Requests")
        assert re.search(r"^Wait \d+ hours: .* 97 kB on this server's disk", refused.json()["detail"])
        assert int(refused.headers["Retry-After"]) > 80_000
        page = visitor.post("/samples", files={"file": ("a.jpg", small)})
        assert (page.status_code, "disk" in page.text) == (429, True)
        assert page.headers["Retry-After"]


class TestShares:
    """What the token and the address count."""

    def test_made_up_tokens_do_not_get_more_than_the_address(self) -> None:
        limits = Limits(Settings(limits=True, limit_uploads="3/hour", limit_address=2))
        for _ in range(6):
            limits.take(UPLOADS, Client("203.0.113.7", new_token()))
        with pytest.raises(QuotaError, match="at most 6 uploads an hour from one network address"):
            limits.take(UPLOADS, Client("203.0.113.7", new_token()))
        limits.take(UPLOADS, Client("203.0.113.8", new_token()))

    def test_what_was_refused_counts_nowhere(self) -> None:
        limits = Limits(Settings(limits=True, limit_uploads="3/hour", limit_address=2))
        for _ in range(9):
            try:
                limits.take(UPLOADS, Client("203.0.113.7", "one"))
            except QuotaError:
                continue
        for _ in range(3):
            limits.take(UPLOADS, Client("203.0.113.7", "other"))

    def test_people_without_a_token_are_their_address(self) -> None:
        limits = Limits(Settings(limits=True, limit_uploads="3/hour", limit_address=2))
        for _ in range(3):
            limits.take(UPLOADS, Client("203.0.113.7"))
        with pytest.raises(QuotaError, match="3 uploads an hour from one client"):
            limits.take(UPLOADS, Client("203.0.113.7"))

    def test_the_longest_wait_is_told(self) -> None:
        limits = Limits(Settings(limits=True, limit_uploads="1/second;1/hour"))
        limits.take(UPLOADS, Client("203.0.113.7"))
        with pytest.raises(QuotaError, match="at most 1 upload an hour") as refusal:
            limits.take(UPLOADS, Client("203.0.113.7"))
        assert 3590 < refusal.value.retry_after <= 3600

    def test_one_setting_switches_everything_off(self) -> None:
        limits = Limits(Settings(limits=False, limit_experiments="1/day", upload_budget=1, limit_streams=1))
        for _ in range(20):
            assert limits.take(EXPERIMENTS, Client("203.0.113.7")) == {}
            limits.count_bytes(Client("203.0.113.7"), 9)
            limits.check_budget(Client("203.0.113.7"))
        with limits.stream(Client("203.0.113.7")), limits.stream(Client("203.0.113.7")):
            pass

    def test_no_text_is_no_limit(self) -> None:
        limits = Limits(Settings(limits=True, limit_views=""))
        assert limits.take(VIEWS, Client("203.0.113.7")) == {}

    @pytest.mark.parametrize("text", ["3", "0/minute", "3/fortnight", "-1/minute", "3/minute;", "3/minute,4/hour", "x"])
    def test_what_is_no_limit_is_refused_at_the_start(self, text: str) -> None:
        with pytest.raises(ValidationError, match="30/minute;300/hour"):
            Settings(limit_uploads=text)

    @pytest.mark.parametrize("text", ["3/minute", "5/10 minutes;100/hour", "1/second", "9/days"])
    def test_what_is_one_is_taken(self, text: str) -> None:
        Limits(Settings(limits=True, limit_uploads=text)).take(UPLOADS, Client("203.0.113.7"))

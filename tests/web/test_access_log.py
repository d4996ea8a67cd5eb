"""The access log tells no address that is somebody's only lock."""

import logging
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.experiments.tokens import new_identifier
from app.web.access_log import keep_addresses_secret, redact
from tests.profiles import examples

ADDRESSES = [
    "/experiments/{id}",
    "/experiments/{id}?view=flip",
    "/experiments/{id}/delete",
    "/api/v1/experiments/{id}",
    "/api/v1/experiments/{id}/events",
    "/api/v1/experiments/{id}/outputs/texture?format=tiff&depth=16",
    "/api/v1/experiments/{id}/outputs.zip",
    "/api/v1/samples/{id}/image?size=512",
    "/samples/{id}?crop=0,0,9,9",
    "/samples/gravel?sample-2={id}&method=mix",
    "/compare/{id}/{id}",
    "/compare/gravel/{id}",
    "/EXPERIMENTS/{id}",
    "/experiments/{id}).",
    "/experiment/{id}",
    "/texture/experiments/{id}",  # below a proxy's prefix
    "//experiments/{id}",
    "/{id}",
]


class Lines(logging.Handler):
    def __init__(self) -> None:
        super().__init__()
        self.lines: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.lines.append(record.getMessage())


@pytest.fixture
def access_log() -> Iterator[list[str]]:
    """What the server logs of requests meanwhile, as its own handlers would get it."""
    logger, handler = logging.getLogger("uvicorn.access"), Lines()
    before = logger.level
    logger.addHandler(handler)
    logger.setLevel(logging.INFO)
    yield handler.lines
    logger.removeHandler(handler)
    logger.setLevel(before)


@pytest.mark.parametrize("address", ADDRESSES)
@given(seed=st.integers(0, 1 << 30))
@settings(max_examples=examples(20))
def test_no_id_is_left_in_any_address(address: str, seed: int) -> None:
    identifier = new_identifier()
    shown = redact(address.format(id=identifier))
    assert identifier not in shown
    assert not any(identifier[start : start + 6] in shown for start in range(11))


@pytest.mark.parametrize(
    "target",
    ["/", "/archive?method=rpn", "/methods/efros-leung", "/api/v1/experiments", "/experiments/check", "/metrics"],
)
def test_what_is_no_secret_stays_readable(target: str) -> None:
    assert redact(target) == target


def test_the_server_logs_requests_so(site: Any, access_log: list[str]) -> None:
    """Every request of an unlisted experiment and of an upload, whatever is answered."""
    record = site.finished(listed=False)
    identifier, sample = record["id"], site.upload()["id"]
    for path in (f"/experiments/{identifier}", f"/api/v1/experiments/{identifier}", f"/experiments/{identifier}/no"):
        site.client.get(path)
    site.client.get(f"/samples/{sample}")
    written = "\n".join(access_log)
    assert '"GET /experiments/… HTTP/1.1" 200' in written
    assert '"GET /samples/… HTTP/1.1" 200' in written
    assert identifier not in written
    assert sample not in written


def test_it_is_masked_once_for_all_applications_of_a_process() -> None:
    keep_addresses_secret()
    keep_addresses_secret()
    filters = logging.getLogger("uvicorn.access").filters
    assert len([each for each in filters if type(each).__name__ == "Redacting"]) == 1

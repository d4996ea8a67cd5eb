"""Every request has an id that nobody else chose; it stands in its answer, in problems and in the log."""

import io
import json
import logging
import logging.config
import re
from collections.abc import Iterator
from typing import Any

import pytest

from app.web.logs import Json, Line, configuration

UUID = r"[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}"


@pytest.fixture
def log() -> Iterator[io.StringIO]:
    """What is logged meanwhile, as JSON."""
    written = io.StringIO()
    handler = logging.StreamHandler(written)
    handler.setFormatter(Json())
    loggers = [logging.getLogger(name) for name in ("uvicorn.access", "uvicorn.error", "app")]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.addHandler(handler)
        logger.setLevel(logging.INFO)
    yield written
    for logger, level in zip(loggers, levels, strict=True):
        logger.removeHandler(handler)
        logger.setLevel(level)


def entries(log: io.StringIO) -> list[dict[str, Any]]:
    return [json.loads(line) for line in log.getvalue().splitlines()]


@pytest.mark.parametrize("path", ["/", "/healthz", "/static/css/base.css", "/nothing", "/api/v1/experiments/none"])
def test_every_answer_has_one_of_its_own(site: Any, path: str) -> None:
    sent = {"X-Request-ID": "chosen-by-the-client"}
    found = {site.client.get(path, headers=sent).headers["X-Request-ID"] for _ in range(3)}
    assert len(found) == 3
    assert all(re.fullmatch(UUID, identifier) for identifier in found)


def test_a_problem_names_it(site: Any) -> None:
    answer = site.client.get("/api/v1/experiments/none")
    assert answer.json()["instance"] == f"urn:uuid:{answer.headers['X-Request-ID']}"


def test_the_access_log_names_it(site: Any, log: io.StringIO) -> None:
    answer = site.client.get("/api/v1/experiments/none")
    (entry,) = [each for each in entries(log) if each.get("request") == answer.headers["X-Request-ID"]]
    expected = {"level": "info", "target": "/api/v1/experiments/…", "status": 404, "logger": "uvicorn.access"}
    assert expected.items() <= entry.items()


def test_what_breaks_is_found_in_the_log_by_it(
    site: Any, log: io.StringIO, until: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(_identifier: str) -> None:
        raise RuntimeError("a bug")

    monkeypatch.setattr(site.service.experiments, "get", broken)
    for path in ("/api/v1/experiments/x", "/experiments/x"):
        with site.visitor() as visitor:  # the server closes the connection afterwards
            answer = visitor.get(path)
        identifier = answer.headers["X-Request-ID"]
        assert answer.status_code == 500
        assert identifier in answer.text
        until(  # it is logged after the answer has gone
            lambda sent=identifier: any(
                "a bug" in each.get("traceback", "") for each in entries(log) if each.get("request") == sent
            )
        )


@pytest.mark.parametrize("form", ["text", "json"])
def test_both_forms_configure_the_server_and_the_program(form: Any, capsys: pytest.CaptureFixture[str]) -> None:
    names = ("uvicorn", "uvicorn.error", "uvicorn.access", "app")
    kept = {name: (logging.getLogger(name).handlers[:], logging.getLogger(name).level) for name in names}
    propagating = {name: logging.getLogger(name).propagate for name in names}
    try:
        logging.config.dictConfig(configuration(form, "info"))
        logging.getLogger("app.experiments").info("a run of %s", "rpn")
        logging.getLogger("app.experiments").debug("nobody asked for this")
        logging.getLogger("uvicorn.access").info('%s - "GET %s"', "local", "/experiments/jO3a-9xYz0123Ab_")
    finally:
        for name, (handlers, level) in kept.items():
            logging.getLogger(name).handlers[:] = handlers
            logging.getLogger(name).setLevel(level)
            logging.getLogger(name).propagate = propagating[name]
    written = capsys.readouterr().err
    assert len(written.splitlines()) == 2
    assert "a run of rpn" in written
    assert "jO3a" not in written
    assert all(line.startswith('{"time": "20' if form == "json" else "20") for line in written.splitlines())


def test_a_line_of_text_tells_the_moment_and_the_level() -> None:
    record = logging.LogRecord("app", logging.WARNING, __file__, 1, "the disk is %s", ("full",), None)
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z WARNING  the disk is full", Line().format(record))

"""``/api/v1/experiments/{id}/events``, over a real socket."""

import json
import signal
import socket
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace
from typing import cast

import httpx
import pytest

from app.errors import DATABASE, UnavailableError
from app.experiments.model import Snapshot, Status
from app.experiments.service import Service
from app.main import create_app
from app.settings import ROOT, Settings
from app.web.api.records import ProgressRecord


def events(response):
    """The events of a stream as dictionaries; comments are left out."""
    event = {}
    for line in response.iter_lines():
        if not line and event:
            yield event
            event = {}
        elif line and not line.startswith(":"):
            name, _, value = line.partition(": ")
            event[name] = json.loads(value) if name == "data" else value


def following(watch):
    """A service in which nothing can be done but watching."""
    service = SimpleNamespace(
        ready=True,
        start=lambda: None,
        close=lambda: None,
        experiments=SimpleNamespace(get=lambda experiment_id: None),
        watching=SimpleNamespace(watch=watch),
    )
    return cast(Service, service)


def test_a_stream_follows_an_experiment_to_its_end(site):
    with site.gate.closed():
        url = site.run(wait=False).json()["url"]
        with site.client.stream("GET", f"{url}/events") as response:
            assert response.headers["Content-Type"].startswith("text/event-stream")
            assert response.headers["Cache-Control"] == "private, no-cache"
            stream = events(response)
            first = next(stream)
            assert first["retry"] == "2000"
            told = [first, next(stream)]
            site.gate.open()
            told += stream
    names = [event["event"] for event in told]
    statuses = [event["data"]["status"] for event in told if event["event"] == "status"]
    assert set(names) == {"status", "progress"}
    assert statuses[-1] == "succeeded"
    assert statuses == [status for status in ("queued", "running", "succeeded") if status in statuses]
    fractions = [event["data"]["progress"] for event in told]
    assert fractions == sorted(fractions)
    assert (told[-1]["event"], told[-1]["id"], told[-1]["data"]["progress"]) == ("status", "end", 1.0)
    assert [event["id"] for event in told[:-1]] == [str(number + 1) for number in range(len(told) - 1)]


def test_an_event_is_sent_for_every_change_and_says_all_of_it(serving, tmp_path):
    """A change of the status alone is a second event; the end has an identifier of its own, by which clients stop."""
    snapshots = [
        Snapshot(Status.QUEUED, position=2),
        Snapshot(Status.QUEUED, position=1),
        Snapshot(Status.RUNNING, fraction=0.25, stage="spot", elapsed=1.23456),
        Snapshot(Status.RUNNING, fraction=0.5, stage="texture", elapsed=2.0),
        Snapshot(Status.SUCCEEDED, fraction=1.0, elapsed=3.0),
    ]

    async def watch(experiment_id):
        for snapshot in snapshots:
            yield snapshot

    with serving(create_app(Settings(data_dir=tmp_path), following(watch))) as url:
        told = list(events(httpx.get(f"{url}/api/v1/experiments/x/events")))
    assert [(event["id"], event["event"], tuple(event["data"].values())) for event in told] == [
        ("1", "progress", ("queued", 2, 0.0, None, 0.0)),
        ("2", "status", ("queued", 2, 0.0, None, 0.0)),
        ("3", "progress", ("queued", 1, 0.0, None, 0.0)),
        ("4", "progress", ("running", None, 0.25, "spot", 1.235)),
        ("5", "status", ("running", None, 0.25, "spot", 1.235)),
        ("6", "progress", ("running", None, 0.5, "texture", 2.0)),
        ("7", "progress", ("succeeded", None, 1.0, None, 3.0)),
        ("end", "status", ("succeeded", None, 1.0, None, 3.0)),
    ]
    assert list(told[0]["data"]) == ["status", "position", "progress", "stage", "elapsed"]
    assert [event.get("retry") for event in told] == ["2000"] + [None] * 7


def test_what_is_written_of_a_state_is_written_once_for_all_streams(serving, tmp_path, monkeypatch):
    written = []
    write = ProgressRecord.of

    def note(snapshot):
        written.append(snapshot)
        return write(snapshot)

    monkeypatch.setattr(ProgressRecord, "of", note)
    snapshots = [Snapshot(Status.RUNNING, fraction=0.123, elapsed=5.5), Snapshot(Status.FAILED, elapsed=6.5)]

    async def watch(experiment_id):
        for snapshot in snapshots:
            yield snapshot

    with serving(create_app(Settings(data_dir=tmp_path), following(watch))) as url:
        streams = [httpx.get(f"{url}/api/v1/experiments/x/events").content for _ in range(5)]
    assert written == snapshots
    assert streams == [streams[0]] * 5


def test_a_comment_keeps_a_stream_alive_of_which_nothing_is_known(serving, tmp_path):
    async def watch(experiment_id):
        yield None
        yield Snapshot(Status.SUCCEEDED, fraction=1.0)

    with serving(create_app(Settings(data_dir=tmp_path), following(watch))) as url:
        response = httpx.get(f"{url}/api/v1/experiments/x/events")
    assert response.text.startswith(": ")
    assert [event["event"] for event in events(response)] == ["progress", "status"]


def test_an_experiment_that_is_deleted_ends_its_streams(site):
    """They end without an event, for there is none of it: who connects again is told why."""
    with site.gate.closed():
        url = site.run(wait=False).json()["url"]
        with site.client.stream("GET", f"{url}/events") as response:
            stream = events(response)
            next(stream)
            site.service.experiments.discard(site.service.experiments.get(url.rsplit("/", 1)[1]))
            assert {event["data"]["status"] for event in stream} <= {"queued", "running", "cancelled"}
        assert site.client.get(f"{url}/events").status_code == 410


def test_a_database_that_is_away_ends_no_stream(site, monkeypatch, until):
    """Nor a request that waits for what was accepted: once the database is back, both hear of the end."""
    watching = site.service.watching
    source, looks = watching._source, []

    def away(jobs):
        looks.append(jobs)
        raise UnavailableError(DATABASE, "The database is away.")

    with site.visitor() as other, site.gate.closed(), ThreadPoolExecutor() as threads:
        url = site.run(wait=False).json()["url"]
        with site.client.stream("GET", f"{url}/events") as response:
            stream = events(response)
            next(stream)
            waiting = threads.submit(site.run, client=other)
            until(lambda: len(watching._watched) == 2)
            monkeypatch.setattr(watching, "_source", away)
            until(lambda: len(looks) > 2)
            monkeypatch.setattr(watching, "_source", source)
            site.gate.open()
            assert list(stream)[-1]["data"]["status"] == "succeeded"
        assert waiting.result().status_code == 201


def test_an_experiment_that_was_accepted_is_answered_though_the_database_goes(site, monkeypatch):
    """Else it would be sent once more."""

    def away(*arguments):
        raise UnavailableError(DATABASE, "The database is away.")

    with site.visitor() as other, site.gate.closed(), monkeypatch.context() as patch:
        patch.setattr(site.service.watching, "_source", away)
        patch.setattr(site.service.watching, "wait", away)
        response = site.run(client=other)
    assert (response.status_code, response.json()["status"]) == (202, "queued")


def test_the_stream_of_a_finished_experiment_ends_at_once(site, experiment):
    told = list(events(site.client.get(f"{experiment['url']}/events")))
    assert [event["data"]["status"] for event in told] == ["succeeded"] * len(told)


def test_who_has_seen_the_end_is_told_to_stop(site, experiment):
    response = site.client.get(f"{experiment['url']}/events", headers={"Last-Event-ID": "end"})
    assert (response.status_code, response.content) == (204, b"")


def test_cancelling_ends_the_stream(site, operator):
    with site.gate.closed():
        url = site.run(wait=False).json()["url"]
        with site.client.stream("GET", f"{url}/events") as response:
            stream = events(response)
            next(stream)
            site.client.delete(url, headers=operator)
            assert list(stream)[-1]["data"]["status"] == "cancelled"


def test_a_client_that_goes_is_followed_no_longer(site, until):
    watched = site.service.watching._watched
    with site.gate.closed():
        record = site.run(wait=False).json()
        with site.visitor() as client, client.stream("GET", f"{record['url']}/events") as response:
            stream = events(response)  # kept: an iterator that is dropped closes its connection
            next(stream)
            until(lambda: record["id"] in watched)
        until(lambda: record["id"] not in watched)


def test_head_of_a_stream_ends_at_once(site):
    with site.gate.closed():
        url = site.run(wait=False).json()["url"]
        response = site.client.head(f"{url}/events")
        assert (response.status_code, response.content) == (200, b"")


@pytest.mark.parametrize("path", ["none", "a%00b"])
def test_an_unknown_experiment_is_not_found(site, path):
    response = site.client.get(f"/api/v1/experiments/{path}/events")
    assert (response.status_code, response.headers["Content-Type"]) == (404, "application/problem+json")


@pytest.mark.slow
def test_a_server_that_is_told_to_stop_ends_its_streams(tmp_path, until):
    """Over the real command: with a stream open it is gone long before it would be killed, and no error is logged."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    program = f"""
import asyncio
import uvicorn
from app.experiments.model import Snapshot, Status
from app.experiments.service import Service
from app.main import create_app
from app.settings import Settings

class Waiting:
    ready = True
    experiments = watching = property(lambda self: self)
    def start(self): pass
    def close(self): print("closed", flush=True)
    def get(self, experiment_id): pass
    async def watch(self, experiment_id):
        yield Snapshot(Status.QUEUED, position=1)
        await asyncio.Event().wait()

uvicorn.run(create_app(Settings(), Waiting()), port={port}, log_level="warning")
"""
    process = subprocess.Popen(
        [sys.executable, "-c", program], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        until(lambda: process.poll() is not None or answers(port))
        with httpx.stream("GET", f"http://127.0.0.1:{port}/api/v1/experiments/x/events", timeout=20) as response:
            stream = events(response)
            assert next(stream)["data"]["position"] == 1
            process.send_signal(signal.SIGTERM)
            assert [event["event"] for event in stream] == ["status"]
        output, errors = process.communicate(timeout=20)
    finally:
        process.kill()
    assert (output, errors) == ("closed\n", "")


def answers(port):
    try:
        return httpx.get(f"http://127.0.0.1:{port}/healthz").is_success
    except httpx.TransportError:
        return False

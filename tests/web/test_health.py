"""``/healthz``, ``/readyz`` and ``/metrics``."""

import shutil
import threading
from typing import cast

import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families

from app.errors import DATABASE, DISK_SPACE, ENGINE, STORAGE, UnavailableError
from app.experiments.service import Service
from app.main import create_app


def test_alive_and_ready(site):
    assert site.client.get("/healthz").json() == {"status": "alive"}
    assert site.client.get("/readyz").json() == {"status": "ready"}


class Starting:
    """As much of a service as health asks, without workers."""

    ready = False

    def __init__(self) -> None:
        self.availability = self

    def missing(self) -> UnavailableError | None:
        return None if self.ready else UnavailableError(ENGINE, "No worker is there.")

    def close(self) -> None: ...


@pytest.mark.parametrize("part", [DATABASE, STORAGE, DISK_SPACE, ENGINE])
def test_what_is_missing_is_named(site, monkeypatch, part):
    """By a word for programs and in a sentence for people."""
    error = UnavailableError(part, "It is away.")
    monkeypatch.setattr(site.service.availability, "missing", lambda: error)
    response = site.client.get("/readyz")
    assert (response.status_code, response.headers["Retry-After"]) == (503, "1")
    assert (response.json()["part"], response.json()["detail"]) == (part, "It is away.")


def test_alive_long_before_ready(site, serving, until):
    """The web is up while the engine starts, and says that it cannot take work."""
    start = threading.Event()

    class Slow(Starting):
        def start(self) -> None:
            start.wait(20)
            self.ready = True

        def close(self) -> None:
            assert self.ready

    with serving(create_app(site.settings, cast(Service, Slow()))) as url:
        assert httpx.get(f"{url}/healthz").status_code == 200
        response = httpx.get(f"{url}/readyz")
        assert (response.status_code, response.headers["Retry-After"]) == (503, "1")
        assert response.headers["Content-Type"] == "application/problem+json"
        start.set()
        until(lambda: httpx.get(f"{url}/readyz").status_code == 200)


def test_an_engine_that_does_not_start_is_logged_and_leaves_the_web_up(site, serving, until, caplog):
    class Broken(Starting):
        def start(self) -> None:
            raise OSError("no scheduler answers at tcp://nowhere:8786")

    with serving(create_app(site.settings, cast(Service, Broken()))) as url:
        until(lambda: "The engine did not start" in caplog.text)
        assert "nowhere" in caplog.text
        assert [httpx.get(f"{url}{path}").status_code for path in ("/healthz", "/readyz")] == [200, 503]


def metrics(site):
    response = site.client.get("/metrics")
    assert response.headers["Content-Type"].startswith("text/plain")
    return {
        (sample.name, *sorted(sample.labels.items())): sample.value
        for family in text_string_to_metric_families(response.text)
        for sample in family.samples
    }


def requests(found, method, route, status):
    labels = (("method", method), ("route", route), ("status", status))
    return found.get(("microtexture_http_requests_total", *labels), 0)


def test_requests_are_counted_by_route_and_status(site, experiment):
    route = "/api/v1/experiments/{experiment_id}"
    before = metrics(site)
    site.client.get(experiment["url"])
    site.client.head(experiment["url"])
    site.client.get("/api/v1/experiments/none")
    site.client.get("/some/where")
    after = metrics(site)
    for method, path, status in (
        ("GET", route, "200"),
        ("HEAD", route, "200"),
        ("GET", route, "404"),
        ("GET", "none", "404"),
    ):
        assert requests(after, method, path, status) == requests(before, method, path, status) + 1
    seconds = ("microtexture_http_request_seconds_count", ("route", route))
    assert after[seconds] == before.get(seconds, 0) + 3
    assert not any(experiment["id"] in str(name) for name in after)


def test_experiments_and_the_queue_are_told(site, experiment, until):
    with site.gate.closed():
        first = site.run(wait=False).json()
        until(lambda: site.client.get(first["url"]).json()["status"] == "running")
        site.run(wait=False)
        found = metrics(site)
        assert found["microtexture_queue_length",] == 1
        assert found["microtexture_ready",] == 1
        assert found["microtexture_experiments", ("status", "succeeded")] >= 1


def test_the_disk_and_the_cache_are_told(site):
    site.client.get("/api/v1/samples/gravel_gray/image?size=256")
    found = metrics(site)
    kept = sum(path.stat().st_size for path in (site.settings.data_dir / "cache").iterdir())
    assert found["microtexture_cache_bytes",] == kept > 0
    free = shutil.disk_usage(site.settings.data_dir).free
    assert 0.5 < found["microtexture_disk_free_bytes",] / free < 2


def test_refused_uploads_are_counted_by_reason(site):
    name = ("microtexture_refused_uploads_total", ("reason", "UnsupportedFormat"))
    before = metrics(site).get(name, 0)
    assert site.client.post("/api/v1/samples", files={"file": ("notes.txt", b"Not a picture.")}).status_code == 415
    assert metrics(site)[name] == before + 1


def test_requests_beyond_a_share_are_counted_by_kind(serve, tmp_path):
    token = {"Authorization": f"Bearer {32 * 'x'}"}
    with serve(tmp_path, limits=True, limit_experiments="1/hour") as site, site.visitor(headers=token) as visitor:
        answers = [site.run(wait=False, client=visitor).status_code for _ in range(3)]
        assert answers == [202, 429, 429]
        assert metrics(site)["microtexture_limited_requests_total", ("kind", "experiments")] == 2

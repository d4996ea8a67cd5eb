"""Prometheus metrics: counts and durations of requests, and the state of the service."""

import os
import shutil
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from prometheus_client import CollectorRegistry, Counter, Histogram, ProcessCollector, generate_latest
from prometheus_client.core import GaugeMetricFamily
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4
from prometheus_client.metrics_core import Metric
from prometheus_client.registry import Collector
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.experiments.model import Status
from app.experiments.service import Service

CACHE = "cache"  # beside the files, as `Service` has it
_METHODS = {"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}
_BUCKETS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60)


class _ServiceCollector(Collector):
    def __init__(self, service: Service) -> None:
        self.service = service

    def collect(self) -> Iterable[Metric]:
        experiments = GaugeMetricFamily(
            "microtexture_experiments", "Experiments that are kept, by status.", labels=["status"]
        )
        counts = self.service.experiments.counts()
        for status in Status:
            experiments.add_metric([status], counts.get(status, 0))
        yield experiments
        yield GaugeMetricFamily("microtexture_queue_length", "Jobs that wait for a worker.", self.service.waiting)
        yield GaugeMetricFamily("microtexture_ready", "1 if experiments can run.", int(self.service.ready))


class _DiskCollector(Collector):
    def __init__(self, data_dir: Path) -> None:
        self.data_dir = data_dir

    def collect(self) -> Iterable[Metric]:
        with suppress(OSError):  # a disk that is away has no figures, and takes none of the others with it
            free = shutil.disk_usage(self.data_dir).free
            yield GaugeMetricFamily("microtexture_disk_free_bytes", "Room left where the data lie.", free)
        with suppress(OSError):
            cached = [entry.stat().st_size for entry in os.scandir(self.data_dir / CACHE) if entry.is_file()]
            yield GaugeMetricFamily(
                "microtexture_cache_bytes", "Room that files take which can be made again.", sum(cached)
            )


class Metrics:
    """The counters of one application, in a registry of its own."""

    content_type = CONTENT_TYPE_PLAIN_0_0_4

    def __init__(self, service: Service, data_dir: Path) -> None:
        self.registry = CollectorRegistry()
        self.requests = Counter(
            "microtexture_http_requests",
            "Requests by method, route and status code.",
            ["method", "route", "status"],
            registry=self.registry,
        )
        self.seconds = Histogram(
            "microtexture_http_request_seconds",
            "Seconds from a request's headers to the end of its answer.",
            ["route"],
            registry=self.registry,
            buckets=_BUCKETS,
        )
        self.limited = Counter(
            "microtexture_limited_requests",
            "Requests beyond a client's share, by what was asked for.",
            ["kind"],
            registry=self.registry,
        )
        self.refused = Counter(
            "microtexture_refused_uploads",
            "Uploads that could not be taken in, by reason.",
            ["reason"],
            registry=self.registry,
        )
        self.registry.register(_ServiceCollector(service))
        self.registry.register(_DiskCollector(data_dir))
        ProcessCollector(registry=self.registry)

    def text(self) -> bytes:
        """Everything in Prometheus' text format."""
        return generate_latest(self.registry)


class CountRequests:
    """Counts and times every request under its route's template, so that identifiers make no series of their own."""

    def __init__(self, app: ASGIApp, *, metrics: Metrics) -> None:
        self.app = app
        self.metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        start = time.perf_counter()
        status = 500
        method = scope["method"] if scope["method"] in _METHODS else "other"

        async def send_counted(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
            await send(message)

        try:
            await self.app(scope, receive, send_counted)
        finally:
            route = _template(scope)
            self.metrics.requests.labels(method, route, str(status)).inc()
            self.metrics.seconds.labels(route).observe(time.perf_counter() - start)


def _template(scope: Scope) -> str:
    template = getattr(scope.get("route"), "path", None)
    if template is not None:
        return str(template)
    return "/static" if scope["path"].startswith("/static/") else "none"

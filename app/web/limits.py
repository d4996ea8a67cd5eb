"""Rate limits: how much one client may ask for, with the ``RateLimit`` header fields of the IETF's draft.

Counted in this process: of N web processes each counts what it sees. What is shared by all, such as the queue, has its
share in the database.
"""

import math
import threading
from collections import Counter
from collections.abc import AsyncIterator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import cast

from fastapi import Request
from limits import RateLimitItem, RateLimitItemPerDay, parse_many
from limits.strategies import MovingWindowRateLimiter

from app.errors import QuotaError
from app.settings import Settings
from app.web.clients import Client, client_of
from app.web.middleware.body_limit import format_bytes
from app.web.middleware.metrics import Metrics
from app.web.windows import MonotonicWindows

UPLOADS, EXPERIMENTS, CONVERSIONS = "uploads", "experiments", "conversions"
DEEP, VIEWS, STREAMS, BYTES = "deep", "views", "streams", "bytes"
_NOUNS = {
    UPLOADS: "uploads",
    EXPERIMENTS: "experiments",
    CONVERSIONS: "conversions of outputs",
    DEEP: "outputs at 16 bits",
    VIEWS: "views of samples",
}
STREAM_SECONDS = 10  # after which another page may have been closed
SCOPE_KEY = "microtexture.rate_limit"  # where a request's header fields wait for its answer


@dataclass(frozen=True)
class Window:
    """One limit of one client, or of its address: the name of its policy, and how both are called in words."""

    policy: str
    item: RateLimitItem
    key: str
    noun: str
    of: str

    @property
    def seconds(self) -> int:
        """Its length."""
        return int(self.item.get_expiry())


@dataclass(frozen=True)
class _Share:
    """How many times a client's share there is, and how it is called in words and in a policy's name."""

    factor: int
    of: str
    suffix: str


class Limits:
    """What every client has had lately, and how much it may have.

    Parameters
    ----------
    settings : Settings
    """

    def __init__(self, settings: Settings) -> None:
        self._on = settings.limits
        self._storage = MonotonicWindows()
        self._limiter = MovingWindowRateLimiter(self._storage)
        self._lock = threading.Lock()
        self._streams: Counter[str] = Counter()
        self._most_streams = settings.limit_streams
        self._by_address = settings.limit_address
        texts = {
            UPLOADS: settings.limit_uploads,
            EXPERIMENTS: settings.limit_experiments,
            CONVERSIONS: settings.limit_conversions,
            DEEP: settings.limit_deep,
            VIEWS: settings.limit_views,
        }
        self._items = {kind: tuple(parse_many(text)) if text else () for kind, text in texts.items()}
        self._items[BYTES] = (RateLimitItemPerDay(settings.upload_budget),)

    def take(self, kind: str, client: Client) -> dict[str, str]:
        """Take one of this kind; the header fields that say how much is left.

        Raises
        ------
        QuotaError
            If the client, or its address, has had as many lately.
        """
        windows = self._windows(kind, client)
        with self._lock:
            full = [window for window in windows if not self._limiter.test(window.item, window.key)]
            if full:
                worst = max(full, key=self._wait)
                wait = self._wait(worst)
                raise QuotaError(
                    f"Wait {_duration(wait)}: this service takes at most {_count(worst.item.amount, worst.noun)} "
                    f"{_per(worst.seconds)} from one {worst.of}.",
                    wait,
                    self._fields(windows),
                )
            for window in windows:
                self._limiter.hit(window.item, window.key)
            return self._fields(windows)

    def check_budget(self, client: Client) -> None:
        """Refuse an upload of who has filled a day's share of the disk already. Raises `QuotaError`."""
        for window in self._windows(BYTES, client):
            if not self._limiter.test(window.item, window.key):
                wait = self._wait(window)
                raise QuotaError(
                    f"Wait {_duration(wait)}: your uploads of the last day take {format_bytes(window.item.amount)} on "
                    f"this server's disk, where they are stored without loss, and one {window.of} has no more a day.",
                    wait,
                )

    def count_bytes(self, client: Client, size: int) -> None:
        """Count what an upload takes on the disk."""
        with self._lock:
            for window in self._windows(BYTES, client):
                room = self._limiter.get_window_stats(window.item, window.key).remaining
                self._limiter.hit(window.item, window.key, cost=min(size, room))

    @contextmanager
    def stream(self, client: Client) -> Iterator[None]:
        """Hold one of the event streams that a client may have at a time. Raises `QuotaError`."""
        keys = {} if not self._on or client.operator else self._keys(client)
        with self._lock:
            for key, share in keys.items():
                most = share.factor * self._most_streams
                if self._streams[key] >= most:
                    raise QuotaError(
                        "Close another page, or read the record from time to time instead: this service keeps at most "
                        f"{_count(most, 'event streams')} open for one {share.of}.",
                        STREAM_SECONDS,
                    )
            self._streams.update(keys.keys())
        try:
            yield
        finally:
            with self._lock:
                self._streams.subtract(keys.keys())
                for key in keys:
                    if self._streams[key] <= 0:
                        del self._streams[key]

    def _windows(self, kind: str, client: Client) -> list[Window]:
        if not self._on or client.operator:
            return []
        return [
            Window(
                f"{kind}-{share.suffix}-{item.get_expiry()}s",
                _times(item, share.factor),
                f"{kind}/{key}",
                _NOUNS.get(kind, kind),
                share.of,
            )
            for key, share in self._keys(client).items()
            for item in self._items[kind]
        ]

    def _keys(self, client: Client) -> dict[str, _Share]:
        """Give the names that this client counts under."""
        return {
            f"client {client.token or client.address}": _Share(1, "client", "client"),
            f"address {client.address}": _Share(self._by_address, "network address", "address"),
        }

    def _wait(self, window: Window) -> int:
        """Seconds until there is room again."""
        reset = self._limiter.get_window_stats(window.item, window.key).reset_time
        return max(1, math.ceil(reset - self._storage.now()))

    def _fields(self, windows: list[Window]) -> dict[str, str]:
        if not windows:
            return {}
        left = [(window, self._limiter.get_window_stats(window.item, window.key).remaining) for window in windows]
        tightest, remaining = min(left, key=lambda each: each[1] / each[0].item.amount)
        return {
            "RateLimit-Policy": ", ".join(f'"{each.policy}";q={each.item.amount};w={each.seconds}' for each in windows),
            "RateLimit": f'"{tightest.policy}";r={remaining};t={self._wait(tightest)}',
        }


def take(request: Request, kind: str) -> None:
    """Count a request as one of this kind, and remember the header fields of its answer. Raises `QuotaError`."""
    limits = cast(Limits, request.app.state.limits)
    try:
        fields = limits.take(kind, client_of(request))
    except QuotaError as error:
        remember(request, error.fields)
        cast(Metrics, request.app.state.metrics).limited.labels(kind).inc()
        raise
    remember(request, fields)


def take_upload(request: Request) -> None:
    """Count an upload, before it is read. Raises `QuotaError`, also if the client's share of the disk is full."""
    take(request, UPLOADS)
    cast(Limits, request.app.state.limits).check_budget(client_of(request))


async def hold_stream(request: Request) -> AsyncIterator[None]:
    """Hold one of the client's event streams until the answer has ended. Raises `QuotaError`."""
    with cast(Limits, request.app.state.limits).stream(client_of(request)):
        yield


def remember(request: Request, fields: dict[str, str]) -> None:
    """Keep header fields for the answer; those of the last one count."""
    request.scope[SCOPE_KEY] = {**request.scope.get(SCOPE_KEY, {}), **fields}


def _times(item: RateLimitItem, factor: int) -> RateLimitItem:
    return type(item)(item.amount * factor, item.multiples, item.namespace)


def _count(number: int, noun: str) -> str:
    """Number and noun, for which the plural is given.

    Examples
    --------
    >>> _count(2, "views of samples"), _count(1, "views of samples")
    ('2 views of samples', '1 view of samples')
    """
    singular = f"{noun} ".replace("s ", " ", 1).rstrip()
    return f"{number} {noun if number != 1 else singular}"


def _per(seconds: int) -> str:
    words = {1: "a second", 60: "a minute", 3600: "an hour", 86400: "a day"}
    return words.get(seconds) or f"in {_duration(seconds)}"


def _duration(seconds: int) -> str:
    """Seconds in words, rounded up.

    Examples
    --------
    >>> _duration(1), _duration(59), _duration(90), _duration(7000)
    ('1 second', '59 seconds', '2 minutes', '2 hours')
    """
    for size, unit in ((3600, "hour"), (60, "minute"), (1, "second")):
        if seconds >= size:
            count = math.ceil(seconds / size)
            return f"{count} {unit}{'s' if count > 1 else ''}"
    return "a moment"

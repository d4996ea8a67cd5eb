"""Ledger: what a service accepted, kept by who asked for it, and what it said of itself meanwhile."""

import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Outage:
    """A time in which a part was taken away, so that the service could not take work."""

    part: str
    began: float
    ended: float


@dataclass(frozen=True)
class Answer:
    """What `/readyz` of one web process said; the status is None if it did not answer."""

    web: int
    at: float
    status: int | None
    words: str


@dataclass
class Ledger:
    """What was accepted: addresses of experiments with what was asked, of uploads with their pixels."""

    experiments: dict[str, str] = field(default_factory=dict)
    uploads: dict[str, bytes] = field(default_factory=dict)
    #: Answers to submissions by status; "none" where the connection broke.
    answers: Counter[str] = field(default_factory=Counter)
    #: What an answer should not have been.
    wrong: list[str] = field(default_factory=list)
    readiness: list[Answer] = field(default_factory=list)
    outages: list[Outage] = field(default_factory=list)
    faults: Counter[str] = field(default_factory=Counter)
    #: When the last fault ended, by the steady clock.
    healed: float = field(default_factory=time.monotonic)
    lock: threading.Lock = field(default_factory=threading.Lock)

    @contextmanager
    def fault(self, name: str) -> Iterator[None]:
        """Count a fault that the service should get over without saying no."""
        try:
            yield
        finally:
            self.faults[name] += 1
            self.healed = time.monotonic()

    @contextmanager
    def outage(self, name: str, part: str) -> Iterator[None]:
        """Note that a part is away meanwhile, which the service should say."""
        began = time.monotonic()
        try:
            with self.fault(name):
                yield
        finally:
            self.outages.append(Outage(part, began, self.healed))

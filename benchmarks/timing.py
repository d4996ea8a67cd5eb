"""Ratios of run times on a machine whose speed drifts: two calls are timed in turn, and the median ratio is taken."""

import statistics
import time
from collections.abc import Callable
from typing import NamedTuple


class Ratio(NamedTuple):
    """Median, least and greatest ratio, and the two median times in seconds."""

    median: float
    least: float
    greatest: float
    first: float
    second: float


def seconds(work: Callable[[], object]) -> float:
    """Wall-clock seconds of one call."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def alternate(first: Callable[[], object], second: Callable[[], object], rounds: int) -> Ratio:
    """Time both in turn, ``rounds`` times each after one unmeasured call, and compare neighbours."""
    first()
    second()
    times = [(seconds(first), seconds(second)) for _ in range(rounds)]
    ratios = [a / b for a, b in times]
    return Ratio(
        statistics.median(ratios),
        min(ratios),
        max(ratios),
        statistics.median(a for a, _ in times),
        statistics.median(b for _, b in times),
    )

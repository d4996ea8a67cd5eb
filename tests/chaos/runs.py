"""Runs: when workers began and left each job, as their logs say, and which ran twice at once."""

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from tests.chaos.processes import Line

BEGINS = re.compile(r"job (\S+), lease (\d+): begun by process (\d+)")
LEAVES = re.compile(r"job (\S+), lease (\d+): left by process (\d+)")
STOP_SECONDS = 5.0  # a run whose lease is gone ends within


@dataclass
class Run:
    """A run of a job under one lease; without an end its process was killed, or is at it still."""

    job: str
    fence: int
    process: int
    began: float
    ended: float | None = None


def read_runs(lines: Iterable[Line]) -> list[Run]:
    """Read the runs of a log, in the order of their beginnings.

    A worker runs one job at a time: a run without an end has ended when its process begins another. What a killed
    process ran has no end, and can only be told from one that goes on by a run that the same process leaves later.
    """
    runs: list[Run] = []
    open_runs: dict[int, Run] = {}
    for line in lines:
        if begin := BEGINS.search(line.text):
            run = Run(begin[1], int(begin[2]), int(begin[3]), line.at)
            runs.append(run)
            open_runs[run.process] = run
        elif (leave := LEAVES.search(line.text)) and int(leave[3]) in open_runs:
            open_runs.pop(int(leave[3])).ended = line.at
    return runs


def double_runs(lines: Iterable[Line], counts: Counter[str]) -> list[str]:
    """Find jobs that ran twice under one lease, or went on for seconds after another run of theirs had begun."""
    found: list[str] = []
    last: dict[str, Run] = {}
    runs = read_runs(lines)
    for run in runs:
        before = last.get(run.job)
        if before is not None:
            counts["runs again"] += 1
            if before.fence >= run.fence:
                found.append(f"{run.job}: fence {run.fence} began after fence {before.fence}")
            elif before.ended is not None and before.ended > run.began + STOP_SECONDS:
                found.append(
                    f"{run.job}: fence {before.fence} went on {before.ended - run.began:.1f} s beside the next"
                )
        last[run.job] = run
    counts["runs"] = len(runs)
    return found

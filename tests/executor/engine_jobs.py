"""Jobs for the executors' tests, in a module that worker processes can import.

A job's name is ``behaviour!directory``: what it shall do, and where it leaves marks that a test can wait for.
"""

import os
import resource
import signal
import time
from functools import cache
from pathlib import Path

import numpy as np

from app.errors import STORAGE, CancelledError, InvalidInputError, UnavailableError
from app.experiments.failures import explain_failure
from app.experiments.heartbeat import Heartbeat
from app.experiments.model import DEEP, Lease
from app.methods.context import Context, Progress
from app.methods.model import Source
from app.methods.registry import method
from app.settings import Settings
from app.store.queue import SqlQueue
from app.store.sql import SqlStore

PATIENCE = 60.0


def mark(directory: Path, name: str) -> None:
    """Append the process's id to a file of this name."""
    with (directory / name).open("a") as file:
        file.write(f"{os.getpid()}\n")


def marks(directory: Path, name: str) -> list[int]:
    """The ids that `mark` left, oldest first."""
    path = directory / name
    return [int(line) for line in path.read_text().splitlines()] if path.exists() else []


@cache
def queue_of(url: str) -> SqlQueue:
    return SqlQueue(SqlStore(url).database)


def run(settings: Settings, lease: Lease) -> None:
    """Behave as the job's name says; marks ``<name>.started`` first and ``<name>.done`` last."""
    name, _, where = lease.job.partition(DEEP)[0].partition("!")
    directory, queue = Path(where), queue_of(settings.sql_url)
    behaviour = name.split("-")[0]
    with Heartbeat(queue, lease, settings.time_limit) as progress:
        if not progress.held:
            return
        mark(directory, f"{name}.started")
        try:
            BEHAVIOURS[behaviour](directory, name, progress)
        except CancelledError:
            return
        except UnavailableError:
            raise
        except Exception as error:
            queue.finish(lease, explain_failure(lease.job, error))
            return
        mark(directory, f"{name}.done")
        queue.finish(lease)


def quick(directory: Path, name: str, progress: Progress) -> None:
    progress("only stage", 0.5)


def polite(directory: Path, name: str, progress: Progress) -> None:
    """Run until the file ``<name>.go`` is there, calling progress all the time."""
    deadline = time.monotonic() + PATIENCE
    while not (directory / f"{name}.go").exists() and time.monotonic() < deadline:
        progress("waiting", 0.25)
        time.sleep(0.005)


def stubborn(directory: Path, name: str, progress: Progress) -> None:
    """Compute without ever calling progress, as code does that hangs."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        sum(range(1000))


def refused(directory: Path, name: str, progress: Progress) -> None:
    raise InvalidInputError("The crop is too small: make it larger.", "crop")


def broken(directory: Path, name: str, progress: Progress) -> None:
    raise ZeroDivisionError("not for people")


def away(directory: Path, name: str, progress: Progress) -> None:
    """Find the files away, as often as the name's number says."""
    if len(marks(directory, f"{name}.started")) <= int(name.split("-")[1]):
        raise UnavailableError(STORAGE, "The files are away.")


def forgetful(directory: Path, name: str, progress: Progress) -> None:
    """Leave without a record."""
    raise CancelledError("Nobody asked for that.")


def killed(directory: Path, name: str, progress: Progress) -> None:
    """Kill its own process, as often as the name's number says."""
    if len(marks(directory, f"{name}.started")) <= int(name.split("-")[1]):
        os.kill(os.getpid(), signal.SIGKILL)


def greedy(directory: Path, name: str, progress: Progress) -> None:
    """Take memory until killed."""
    taken = []
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        taken.append(b"x" * (1 << 24))
        time.sleep(0.01)


def textured(directory: Path, name: str, progress: Progress) -> None:
    """Make every picture of an RPN of 512², and write down the pages that were brought into memory for it."""
    crop = np.random.default_rng(3).integers(0, 256, (512, 512, 3)).astype(np.float32)
    rpn = method("rpn")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in rpn.pictures([Source(crop, 255)], rpn.params(seed=1), Context(8, 2, progress)):
        pass
    (directory / f"{name}.faults").write_text(str(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before))


def large(directory: Path, name: str, progress: Progress) -> None:
    """Fill 400 MB in blocks of 4 MB, and let go of them."""
    blocks = [np.ones(1 << 22, np.uint8) for _ in range(100)]
    progress("holding them", len(blocks) / 100)


BEHAVIOURS = {
    function.__name__: function
    for function in (quick, polite, stubborn, refused, broken, away, forgetful, killed, greedy, textured, large)
}

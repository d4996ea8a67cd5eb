"""Faults: what hosts do to a service, on real processes; each returns when what it broke is whole again."""

import os
import random
import signal
import sqlite3
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import psutil

from tests.chaos.host import Host
from tests.chaos.ledger import Ledger
from tests.chaos.processes import until

BREATH_SECONDS = 3.0  # between two kills, at the least


@dataclass(frozen=True)
class Size:
    """How much of each fault: of the short form, which runs with all tests, and of the long one."""

    kills: int
    outage_seconds: float
    stops: int
    stop_seconds: float
    restarts: int
    recovery_seconds: float  # until it is ready again: the short form runs on machines that do much else


SHORT = Size(kills=1, outage_seconds=12.0, stops=2, stop_seconds=4.0, restarts=2, recovery_seconds=120.0)
LONG = Size(kills=100, outage_seconds=60.0, stops=6, stop_seconds=5.0, restarts=10, recovery_seconds=30.0)
SIZE = LONG if os.environ.get("CHAOS") == "long" else SHORT

Fault = Callable[[Host, Ledger, random.Random], None]


def killed(name: str, victims: Callable[[Host], list[psutil.Process]], all_at_once: bool = False) -> Fault:
    """Kill -9, at random moments, one of these processes, or all of them."""

    def kill(host: Host, ledger: Ledger, chance: random.Random) -> None:
        for _ in range(SIZE.kills):
            until(lambda: victims(host), f"there is a {name}")
            time.sleep(chance.uniform(0, 1))
            found = victims(host)
            with ledger.fault(f"kill -9 of {name}"):
                for victim in found if all_at_once else found and [chance.choice(found)]:
                    try:
                        victim.kill()
                    except psutil.NoSuchProcess:
                        continue
            time.sleep(BREATH_SECONDS)
            host.until_ready(SIZE.recovery_seconds)

    kill.__name__ = f"kill -9 of {name}"
    return kill


def _webs(host: Host) -> list[psutil.Process]:
    return [web.process for web in host.webs]


one_server = killed("a server", _webs)
one_worker = killed("a worker", Host.engine_workers)
all_workers = killed("all workers", Host.engine_workers, all_at_once=True)
fork_server = killed("the fork server", Host.fork_servers)
decoder = killed("the decoder", Host.decoders)
nanny = killed("an external worker's nanny", lambda host: [worker.process for worker in host.workers])
scheduler = killed("the external scheduler", lambda host: [host.scheduler.process] if host.scheduler else [])


def postgresql_stopped(host: Host, ledger: Ledger, chance: random.Random) -> None:
    """Stop it at once, as a loss of power would, and start it after seconds."""
    assert host.postgresql is not None
    for _ in range(SIZE.stops):
        with ledger.outage("PostgreSQL stopped", "database"), host.postgresql.stopped(SIZE.stop_seconds):
            pass
        host.until_ready(SIZE.recovery_seconds)
        time.sleep(chance.uniform(0, 2))


def sqlite_locked(host: Host, ledger: Ledger, chance: random.Random) -> None:
    """Hold the write lock of the database as another program might."""
    with sqlite3.connect(host.data / "microtexture.sqlite3", timeout=60, isolation_level=None) as connection:
        connection.execute("BEGIN IMMEDIATE")
        with ledger.outage("SQLite locked", "database"):
            time.sleep(SIZE.outage_seconds)
            connection.execute("ROLLBACK")
    connection.close()
    host.until_ready(SIZE.recovery_seconds)


def disk_full(host: Host, ledger: Ledger, chance: random.Random) -> None:
    """Fill the file system of the data directory to the last byte; it must be one of its own."""
    filler = host.data / "filler"
    with ledger.outage("disk full", "disk space"):
        with filler.open("wb", buffering=0) as file:
            deadline = time.monotonic() + SIZE.outage_seconds
            size = 1 << 20
            while time.monotonic() < deadline:
                try:
                    file.write(bytes(size))
                except OSError:
                    size = max(1, size // 2)
                    time.sleep(0.05 if size == 1 else 0)
        filler.unlink()
    host.until_ready(SIZE.recovery_seconds)


def directory_gone(host: Host, ledger: Ledger, chance: random.Random) -> None:
    """Take the files away, as a network file system does that is not mounted."""
    files, away = host.data / "files", host.data / "files.away"
    with ledger.outage("storage away", "storage"):
        files.rename(away)
        time.sleep(SIZE.outage_seconds)
        if files.exists():
            ledger.wrong.append("a new directory of files was made while the old one was away")
            subprocess.run(["rm", "-rf", str(files)], check=True)
        away.rename(files)
    host.until_ready(SIZE.recovery_seconds)


def clock_set(host: Host, ledger: Ledger, chance: random.Random) -> None:
    """Set the clock of all processes two days ahead, then two days back, then right."""
    for offset in ("+2d", "-2d", "+0"):
        with ledger.fault("clock set by two days"):
            host.clock.write_text(offset)
            time.sleep(min(SIZE.outage_seconds, 20) / 2)
        host.until_ready(SIZE.recovery_seconds)


def restarted(host: Host, ledger: Ledger, chance: random.Random) -> None:
    """Restart every server by SIGTERM, again and again, while the same experiments are under way."""
    for _ in range(SIZE.restarts):
        with ledger.fault("restart by SIGTERM"):
            for web in host.webs:
                started = web.starts
                web.send(signal.SIGTERM)
                until(lambda web=web, started=started: web.starts > started, f"{web.name} is started again", 45)
        host.until_ready(SIZE.recovery_seconds)


@contextmanager
def small_disk(host_directory: os.PathLike[str], megabytes: int) -> Iterator[None]:
    """Mount a file system of its own on a directory; only root may."""
    options = ["-o", f"size={megabytes}m", "chaos", str(host_directory)]
    subprocess.run(["mount", "-t", "tmpfs", *options], check=True)
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", str(host_directory)], check=True)

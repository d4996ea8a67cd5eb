"""Processes of a service that may be killed: each started again when it has ended, as a supervisor would do."""

import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import psutil

RESTART_SECONDS = 0.5  # a supervisor's pause before it starts a process again
STOP_SECONDS = 30.0


@dataclass(frozen=True)
class Line:
    """A line of a log, and when it came by this program's own steady clock: those of the processes may be set."""

    at: float
    text: str


class Supervised:
    """A program that is started again whenever it ends, with all that it and its children write.

    Parameters
    ----------
    name : str
        For messages, and the name of its log.
    command : list of str
    environment : mapping
        Of the program, whole.
    log : Path
        File that keeps what it writes.
    """

    def __init__(self, name: str, command: list[str], environment: Mapping[str, str], log: Path) -> None:
        self.name = name
        self.lines: list[Line] = []
        self.starts = 0
        self._command = command
        self._environment = dict(environment)
        self._log = log
        self._stopping = threading.Event()
        self._held = threading.Event()
        self._changed = threading.Condition()
        self._process: subprocess.Popen[str] | None = None
        self._thread = threading.Thread(target=self._supervise, name=name, daemon=True)
        self._thread.start()

    @property
    def process(self) -> psutil.Process:
        """The process that runs now; waits for it while it is being started."""
        with self._changed:
            found = self._changed.wait_for(lambda: self._process is not None, STOP_SECONDS)
            assert found, f"{self.name} is not started again"
            assert self._process is not None
            return psutil.Process(self._process.pid)

    def children(self) -> list[psutil.Process]:
        try:
            return self.process.children(recursive=True)
        except psutil.NoSuchProcess:
            return []

    def send(self, number: signal.Signals) -> None:
        with self._changed:
            process = self._process
        if process is not None:
            process.send_signal(number)

    @contextmanager
    def held_down(self, number: signal.Signals = signal.SIGKILL) -> Iterator[None]:
        """End it, and let it be started again afterwards only."""
        self._held.set()
        self.send(number)
        try:
            yield
        finally:
            self._held.clear()

    def stop(self) -> None:
        """End it by SIGTERM, once; what is left of its children after that is killed."""
        if self._stopping.is_set():
            return
        family = self.children()
        self._stopping.set()
        self._held.clear()
        self.send(signal.SIGTERM)
        self._thread.join(STOP_SECONDS)
        for process in family:
            with suppress(psutil.NoSuchProcess):
                process.kill()
        if self._thread.is_alive():
            self.send(signal.SIGKILL)
            self._thread.join(STOP_SECONDS)
            raise AssertionError(f"{self.name} did not end within {STOP_SECONDS:.0f} seconds of SIGTERM")

    def abandon(self) -> None:
        """Kill it and all its children, if it was not stopped."""
        self._stopping.set()
        family = self.children() if self._process is not None else []
        self.send(signal.SIGKILL)
        for process in family:
            with suppress(psutil.NoSuchProcess):
                process.kill()
        self._thread.join(STOP_SECONDS)

    def _supervise(self) -> None:
        while not self._stopping.is_set():
            process = subprocess.Popen(
                self._command,
                env=self._environment,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                cwd=self._log.parent,
            )
            threading.Thread(target=self._read, args=(process,), daemon=True).start()
            with self._changed:
                self._process = process
                self.starts += 1
                self._changed.notify_all()
            process.wait()
            with self._changed:
                self._process = None
            while self._held.is_set() and not self._stopping.is_set():
                time.sleep(0.05)
            self._stopping.wait(RESTART_SECONDS)

    def _read(self, process: "subprocess.Popen[str]") -> None:
        """Keep the lines of the process and of the children that outlive it."""
        assert process.stdout is not None
        with process.stdout, self._log.open("a") as log:
            for text in process.stdout:
                self.lines.append(Line(time.monotonic(), text.rstrip("\n")))
                log.write(text)
                log.flush()


def until(condition: Callable[[], object], what: str, seconds: float = 120.0) -> None:
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"waited {seconds:.0f} seconds for this in vain: {what}"
        time.sleep(0.05)


def clean_environment() -> dict[str, str]:
    """The environment without settings of a service."""
    return {name: value for name, value in os.environ.items() if not name.startswith("MICROTEXTURE_")}

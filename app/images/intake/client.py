"""Client of the decoding server: has an upload decoded in a process that may be killed, and stored as our own PNG."""

import atexit
import json
import os
import socket
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from threading import BoundedSemaphore, Lock
from typing import Any

from app.child_environment import allowed
from app.errors import AppError, BrokenFileError, BusyError, TooLargeError, UnsupportedFormatError
from app.images.decode import Limits
from app.images.intake import server as decoding_server
from app.images.media import Media

AT_ONCE = max(2, os.cpu_count() or 2)
WAIT_SECONDS = 60.0
PACKAGES = Path(__file__).resolve().parents[3]  # the directory of the package `app`
GRACE_SECONDS = 10.0  # the server kills late children itself; if nothing comes for this much longer, it hangs
ENVIRONMENT = {
    "OPENBLAS_NUM_THREADS": "1",  # a process that forks should have only one thread
    "MALLOC_ARENA_MAX": "1",  # every thread of a decoder would reserve memory that counts as used
}
ERRORS: dict[str, type[AppError]] = {
    error.__name__: error for error in (BrokenFileError, TooLargeError, UnsupportedFormatError)
}


@dataclass(frozen=True, kw_only=True)
class Intake(Media):
    """A stored picture or video."""

    #: Where its PNG file is; of a video its frame stack.
    path: Path


class DecodingServer:
    """The process that forks the decoders: started when it is needed, and again when it has died."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._control: socket.socket | None = None

    def start(self) -> None:
        """Start the process without waiting for it, so that the first upload does not wait either."""
        with self._lock:
            self._ensure_running()

    def ask(self, message: bytes) -> socket.socket:
        """Send a request, and return the socket on which the answer comes."""
        ours, theirs = socket.socketpair()
        with theirs, self._lock:
            try:
                socket.send_fds(self._ensure_running(), [message], [theirs.fileno()])
            except OSError:
                # It has died since the check.
                self._stop()
                socket.send_fds(self._ensure_running(), [message], [theirs.fileno()])
        return ours

    def stop(self) -> None:
        """End the process, and every decoder with it."""
        with self._lock:
            self._stop()

    def _ensure_running(self) -> socket.socket:
        if self._process is None or self._control is None or self._process.poll() is not None:
            self._stop()
            self._control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            with theirs:
                self._process = subprocess.Popen(  # noqa: S603 - our own interpreter and module
                    [sys.executable, "-m", decoding_server.__name__],
                    stdin=theirs.fileno(),
                    stdout=subprocess.DEVNULL,
                    cwd=PACKAGES,
                    env=allowed(os.environ) | ENVIRONMENT,
                    start_new_session=True,
                )
        return self._control

    def _stop(self) -> None:
        if self._control is not None:
            self._control.close()
        if self._process is not None:
            self._process.kill()
            self._process.wait()
        self._process = self._control = None


server = DecodingServer()
atexit.register(server.stop)
_turn = BoundedSemaphore(AT_ONCE)


def take_in(path: Path, directory: Path, limits: Limits) -> Intake:
    """Decode an upload in a process of its own and store it as PNG. Thread-safe; blocks.

    Parameters
    ----------
    path : Path
        The uploaded file, which is only read.
    directory : Path
        Where the PNG file is written, under a temporary name; the caller moves or removes it. After an error nothing is
        left there.
    limits : Limits

    Returns
    -------
    Intake

    Raises
    ------
    UnsupportedFormatError, BrokenFileError, TooLargeError
        As `app.images.decode.decode`; also if decoding takes more seconds or more memory than the limits allow.
    OSError
        If the disk is full, or its files are away for now.
    BusyError
        If no decoder becomes free within a minute: only so many files are decoded at once.
    """
    if not _turn.acquire(timeout=WAIT_SECONDS):
        raise BusyError("Try again in a minute: many pictures are being read at the moment.")
    try:
        descriptor, name = tempfile.mkstemp(prefix="intake-", suffix=".png", dir=directory.resolve())
        os.close(descriptor)
        stored = Path(name)
        try:
            return Intake(
                path=stored, **_decode(decoding_server.encode_request(path.resolve(), stored, limits), limits)
            )
        except BaseException:
            stored.unlink(missing_ok=True)
            raise
    finally:
        _turn.release()


def _decode(message: bytes, limits: Limits) -> dict[str, Any]:
    report: dict[str, Any] = {}
    for _ in range(2):  # once more if the server was killed, which says nothing about the file
        report = collect_answer(message, limits)
        if report:
            break
    if "width" in report:
        del report["ended"]
        return report
    if error := ERRORS.get(report.get("error", "")):
        raise error(report["message"])
    if report.get("error") == "OSError":
        raise OSError(report["errno"], "The decoder cannot read or write its files")
    if report.get("error") == "MemoryError":
        raise TooLargeError(
            f"Decoding this file takes more than the {limits.memory / (1 << 20):,.0f} MB of memory that it may use: "
            "make it smaller, or save it as an ordinary PNG, JPEG or MP4 (H.264), and upload it again."
        )
    if report.get("ended") == "late":
        raise TooLargeError(
            f"Decoding this file takes more than the {limits.seconds:g} seconds that it may: make it smaller, a video "
            "shorter, or save it as an ordinary (not progressive) JPEG or MP4 (H.264), and upload it again."
        )
    raise BrokenFileError(
        "The decoder failed on this file; it is probably damaged. "
        "Open it in the program that made it, save it again and upload the new file."
    )


def collect_answer(message: bytes, limits: Limits) -> dict[str, Any]:
    """Collect the reports of the child and of the server; empty if the server dies."""
    report: dict[str, Any] = {}
    with server.ask(message) as answer:
        answer.settimeout(limits.seconds + GRACE_SECONDS)
        try:
            with answer.makefile("rb") as lines:
                for line in lines:
                    report |= json.loads(line)
                    if "ended" in report:
                        return report
        except TimeoutError:
            server.stop()
            return {"ended": "late"}
        except OSError:
            pass
    return {}

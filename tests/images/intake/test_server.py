"""The decoding server from within: each end of a child becomes one report, and a client that is gone harms nothing."""

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from app.errors import BrokenFileError, TooLargeError
from app.images.decode import Limits
from app.images.intake import client, server
from app.images.media import Media

SAMPLES = Path(__file__).parents[3] / "samples"
MEDIA = Media(4, 3, 1, 8, transparent=False)


def raising(error: BaseException) -> Callable[..., Any]:
    def work(*args: object) -> None:
        raise error

    return work


@pytest.mark.parametrize(
    ("work", "report"),
    [
        (lambda *args: MEDIA, MEDIA.properties()),
        (raising(BrokenFileError("It is broken.")), {"error": "BrokenFileError", "message": "It is broken."}),
        (raising(TooLargeError("It is large.")), {"error": "TooLargeError", "message": "It is large."}),
        (raising(MemoryError()), {"error": "MemoryError"}),
        (raising(ZeroDivisionError()), {"error": "Exception"}),
    ],
)
def test_what_becomes_of_a_file_is_reported(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], work: Any, report: dict[str, Any]
) -> None:
    """What nobody foresaw leaves its traceback for the operator; it is no text for people."""
    monkeypatch.setattr(server, "store", work)
    assert server._decode(Path("upload"), Path("stored"), Limits()) == report
    assert ("ZeroDivisionError" in capfd.readouterr().err) == (report == {"error": "Exception"})


def test_a_client_that_is_gone_is_no_error() -> None:
    ours, theirs = socket.socketpair()
    with theirs:
        ours.close()
        server._send(theirs, {"ended": "itself"})


@pytest.mark.parametrize(
    ("number", "late", "ended"),
    [
        (None, False, "itself"),
        (None, True, "late"),
        (signal.SIGKILL, False, "killed"),
        (signal.SIGKILL, True, "late"),
        (signal.SIGXCPU, False, "late"),  # the kernel's limit of CPU time
    ],
)
def test_how_a_child_ended_is_reported(number: signal.Signals | None, late: bool, ended: str) -> None:
    program = "" if number is None else f"import os; os.kill(os.getpid(), {int(number)})"
    ours, theirs = socket.socketpair()
    process = subprocess.Popen([sys.executable, "-c", program])
    deadline = time.monotonic() + (-1 if late else 3600)
    server._finish_child(os.pidfd_open(process.pid), server._Child(process.pid, theirs, deadline))
    process.wait()
    with ours, ours.makefile("rb") as lines:
        assert [json.loads(line) for line in lines] == [{"ended": ended}]


@pytest.fixture
def decoding(monkeypatch: pytest.MonkeyPatch) -> Iterator[client.DecodingServer]:
    """A server of this test's own, which may be stopped and replaced."""
    own = client.DecodingServer()
    monkeypatch.setattr(client, "server", own)
    yield own
    own.stop()


def test_a_server_that_does_not_answer_is_replaced(
    decoding: client.DecodingServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is stopped by a signal that it cannot ignore, and the file is told to have taken too long."""
    monkeypatch.setattr(client, "GRACE_SECONDS", 0.2)
    decoding.start()
    assert decoding._process is not None
    hung = decoding._process
    os.kill(hung.pid, signal.SIGSTOP)
    with pytest.raises(TooLargeError, match=r"more than the 0\.1 seconds"):
        client.take_in(SAMPLES / "tiles02.png", tmp_path, Limits(seconds=0.1))
    assert hung.poll() == -signal.SIGKILL
    assert not list(tmp_path.iterdir())
    monkeypatch.undo()
    monkeypatch.setattr(client, "server", decoding)
    assert client.take_in(SAMPLES / "tiles02.png", tmp_path, Limits()).width == 256


def test_a_server_that_dies_between_the_check_and_the_request_is_replaced(
    decoding: client.DecodingServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    decoding.start()
    first, running = decoding._process, decoding._ensure_running
    assert first is not None
    checks = []

    def check() -> socket.socket:
        control = running()
        checks.append(control)
        if len(checks) == 1:
            first.kill()
            first.wait()
        return control

    monkeypatch.setattr(decoding, "_ensure_running", check)
    assert client.take_in(SAMPLES / "tiles02.png", tmp_path, Limits()).width == 256
    assert len(checks) == 2
    assert decoding._process is not first


@pytest.mark.parametrize("unread", [b"", b"a request that nobody read"], ids=["closed", "reset"])
def test_a_file_that_ends_the_server_twice_is_refused(
    decoding: client.DecodingServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, unread: bytes
) -> None:
    """Nothing is known of it then; it is tried once more, and not for ever."""
    tries = []

    def ask(message: bytes) -> socket.socket:
        ours, theirs = socket.socketpair()
        ours.sendall(unread)
        theirs.close()
        tries.append(json.loads(message)["path"])
        return ours

    monkeypatch.setattr(decoding, "ask", ask)
    with pytest.raises(BrokenFileError, match="The decoder failed on this file"):
        client.take_in(SAMPLES / "tiles02.png", tmp_path, Limits())
    assert tries == [str(SAMPLES / "tiles02.png")] * 2
    assert not list(tmp_path.iterdir())


def test_a_turn_is_given_back_after_a_failure(
    decoding: client.DecodingServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    turn = threading.BoundedSemaphore(1)
    monkeypatch.setattr(client, "_turn", turn)
    monkeypatch.setattr(decoding, "ask", raising(KeyboardInterrupt()))
    with pytest.raises(KeyboardInterrupt):
        client.take_in(SAMPLES / "tiles02.png", tmp_path, Limits())
    assert not list(tmp_path.iterdir())
    assert turn.acquire(blocking=False)


def test_a_disk_that_is_away_is_not_taken_for_a_damaged_file(
    decoding: client.DecodingServer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    report = server._decode(SAMPLES / "tiles02.png", tmp_path / "nowhere" / "stored.png", Limits())
    ended = {**report, "ended": "itself"}
    monkeypatch.setattr(client, "collect_answer", lambda *_arguments: ended)
    with pytest.raises(FileNotFoundError):
        client.take_in(SAMPLES / "tiles02.png", tmp_path, Limits())
    assert not list(tmp_path.iterdir())

"""Decoding server: a process that decodes each upload in a child that may be killed; the client starts it.

It imports the decoders once and forks one child for each upload, so that a child costs milliseconds. A child is limited
in memory and CPU time by the kernel, and killed when its time is over. No process outlives its parent: this one ends
when its socket closes, and the kernel then kills the children. Linux only.

The socket (file descriptor 0) receives one JSON request per message, with a socket to answer on. The answer is at most
two lines: what the child reports, then how it ended.
"""

import ctypes
import errno
import json
import logging
import math
import os
import resource
import selectors
import signal
import socket
import sys
import time
import traceback
import warnings
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import imagecodecs
from PIL import Image

from app.errors import AppError, InvalidInputError
from app.images.decode import Limits
from app.images.intake.store import store
from app.images.intake.tasks import perform

MESSAGE_BYTES = 1 << 16
PR_SET_PDEATHSIG = 1
LATE_IMPORTS = ("png_decode", "cms_transform", "jpeg8_decode", "lzw_decode", "zlib_decode", "packbits_decode")
PAGE = resource.getpagesize()
# What a disk says that is full or away; a damaged file makes libraries raise errors of no number, or of others.
AWAY = {errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EROFS, errno.ENOENT, errno.ENOTDIR, errno.ESTALE, errno.EACCES}


@dataclass(frozen=True)
class _Child:
    pid: int
    answer: socket.socket
    deadline: float


def encode_request(path: Path, destination: Path, limits: Limits) -> bytes:
    """Encode a request as one message.

    Parameters
    ----------
    path : Path
        The upload.
    destination : Path
        The PNG file to write.
    limits : Limits
    """
    return json.dumps({"path": str(path), "destination": str(destination), "limits": asdict(limits)}).encode()


def serve(control: socket.socket) -> None:
    """Answer requests until the other end of the socket is closed."""
    children: dict[int, _Child] = {}
    with selectors.DefaultSelector() as selector:
        selector.register(control, selectors.EVENT_READ)
        while True:
            now = time.monotonic()
            next_deadline = min((child.deadline for child in children.values()), default=math.inf)
            ready = selector.select(None if math.isinf(next_deadline) else max(0.0, next_deadline - now))
            for key, _ in ready:
                if key.fileobj is not control:
                    selector.unregister(key.fileobj)
                    _finish_child(key.fd, children.pop(key.fd))
                    continue
                message, descriptors, _, _ = socket.recv_fds(control, MESSAGE_BYTES, 1)
                if not message:
                    return
                watch, child = _start_child(message, socket.socket(fileno=descriptors[0]))
                children[watch] = child
                selector.register(watch, selectors.EVENT_READ)
            for child in children.values():
                if child.deadline <= time.monotonic():
                    # It is not reaped yet, so its number cannot be another process's.
                    os.kill(child.pid, signal.SIGKILL)


def _start_child(message: bytes, answer: socket.socket) -> tuple[int, _Child]:
    fields = json.loads(message)
    limits = Limits(**fields["limits"])
    server = os.getpid()
    pid = os.fork()
    if pid == 0:
        try:
            _confine(server, limits)
            _send(answer, _work(fields, limits))
        finally:
            os._exit(0)
    return os.pidfd_open(pid), _Child(pid, answer, time.monotonic() + limits.seconds)


def _finish_child(watch: int, child: _Child) -> None:
    os.close(watch)
    _, status = os.waitpid(child.pid, 0)
    late = time.monotonic() >= child.deadline or (os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGXCPU)
    _send(child.answer, {"ended": "late" if late else "killed" if os.WIFSIGNALED(status) else "itself"})
    child.answer.close()


def _send(answer: socket.socket, message: dict[str, Any]) -> None:
    try:
        answer.sendall(json.dumps(message).encode() + b"\n")
    except BrokenPipeError:
        return  # nobody waits for the answer any more


def _confine(server: int, limits: Limits) -> None:
    """Limit this process, which decodes one file."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != server:
        os._exit(1)
    mapped = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * PAGE
    resource.setrlimit(resource.RLIMIT_AS, (mapped + limits.memory, mapped + limits.memory))
    seconds = (math.ceil(limits.seconds) + 1) * (os.cpu_count() or 1)  # of all threads together
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    Image.MAX_IMAGE_PIXELS = limits.pixels
    warnings.simplefilter("error", Image.DecompressionBombWarning)


def _work(fields: dict[str, Any], limits: Limits) -> dict[str, Any]:
    if "task" not in fields:
        return _decode(Path(fields["path"]), Path(fields["destination"]), limits)
    sources, destinations = (list(map(Path, fields[name])) for name in ("sources", "destinations"))

    def make() -> dict[str, Any]:
        perform(fields["task"], sources, destinations, fields["arguments"])
        return {"made": True}

    return _report(make)


def _decode(path: Path, destination: Path, limits: Limits) -> dict[str, Any]:
    return _report(lambda: store(path, destination, limits).properties())


def _report(work: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    try:
        return work()
    except AppError as error:
        return {"error": type(error).__name__, "message": error.message} | (
            {"field": error.field} if isinstance(error, InvalidInputError) else {}
        )
    except MemoryError:
        return {"error": "MemoryError"}
    except OSError as error:
        traceback.print_exc()
        return {"error": "OSError", "errno": error.errno} if error.errno in AWAY else {"error": "Exception"}
    except Exception:
        traceback.print_exc()
        return {"error": "Exception"}


def _warm_up() -> None:
    """Load what the libraries load on first use, so that not every child has to."""
    Image.preinit()
    for name in LATE_IMPORTS:
        getattr(imagecodecs, name)


if __name__ == "__main__":
    logging.disable()  # tifffile logs what is wrong with every broken file
    # Ctrl-C is for the parent: this process ends when its parent does.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _warm_up()
    serve(socket.socket(fileno=sys.stdin.fileno()))

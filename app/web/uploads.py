"""File uploads: streams multipart/form-data to disk, bounded, below the data directory."""

import tempfile
import time
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, cast

import anyio.to_thread
from fastapi import Request
from python_multipart.exceptions import FormParserError
from python_multipart.multipart import MultipartParser, parse_options_header
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException

from app import threads
from app.errors import AppError, TooLargeError
from app.experiments.model import Sample
from app.web.clients import client_of
from app.web.deps import get_service, get_settings
from app.web.limits import Limits
from app.web.middleware.body_limit import format_bytes
from app.web.middleware.metrics import Metrics

if TYPE_CHECKING:
    from python_multipart.multipart import MultipartCallbacks

MAX_FIELDS = 256
MAX_FIELD_BYTES = 16 * 1024
INCOMING, PREFIX = "incoming", "upload-"
ABANDONED_SECONDS = 3600.0  # without a write: longer than any upload that still goes on, here or in another web process


@dataclass
class Form:
    """A received form: text fields by name (the last of several wins), and files by name, gone when the route returns.

    A field in which no file was chosen is not among the files.
    """

    fields: dict[str, str] = field(default_factory=dict)
    files: dict[str, Path] = field(default_factory=dict)

    @property
    def file(self) -> Path | None:
        """The file of the field ``file``."""
        return self.files.get("file")


class _Parts:
    """What the parser calls: keeps fields, and collects the files' bytes in ``pending`` until they are written.

    ``pending`` are pairs of a field's name and bytes, in the order in which they came.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self.fields: dict[str, str] = {}
        self.filenames: dict[str, str] = {}
        self.pending: list[tuple[str, bytes]] = []
        self.complete = False
        self._names = names
        self._disposition = b""
        self._header = bytearray()
        self._value = bytearray()
        self._name = ""
        self._text: bytearray | None = None

    def callbacks(self) -> "MultipartCallbacks":
        return {
            "on_part_begin": self.on_part_begin,
            "on_header_field": self.on_header_field,
            "on_header_value": self.on_header_value,
            "on_header_end": self.on_header_end,
            "on_headers_finished": self.on_headers_finished,
            "on_part_data": self.on_part_data,
            "on_part_end": self.on_part_end,
            "on_end": self.on_end,
        }

    def on_part_begin(self) -> None:
        self._disposition = b""

    def on_header_field(self, data: bytes, start: int, end: int) -> None:
        self._header += data[start:end]

    def on_header_value(self, data: bytes, start: int, end: int) -> None:
        self._value += data[start:end]

    def on_header_end(self) -> None:
        if self._header.lower() == b"content-disposition":
            self._disposition = bytes(self._value)
        self._header.clear()
        self._value.clear()

    def on_headers_finished(self) -> None:
        _, options = parse_options_header(self._disposition)
        if b"name" not in options:
            raise HTTPException(400, "A part of the form has no name.")
        self._name = _decode(options[b"name"])
        if b"filename" not in options:
            if len(self.fields) >= MAX_FIELDS:
                raise HTTPException(400, f"The form has more than {MAX_FIELDS} fields.")
            self._text = bytearray()
            return
        self._text = None
        if self._name not in self._names or self._name in self.filenames:
            names = ", ".join(f"'{name}'" for name in self._names)
            raise HTTPException(400, f"The form has one file a field, in: {names}.")
        self.filenames[self._name] = _decode(options[b"filename"])

    def on_part_data(self, data: bytes, start: int, end: int) -> None:
        if self._text is None:
            self.pending.append((self._name, data[start:end]))
        elif len(self._text) + end - start > MAX_FIELD_BYTES:
            raise HTTPException(400, f"The form's field {self._name!r} is longer than {format_bytes(MAX_FIELD_BYTES)}.")
        else:
            self._text += data[start:end]

    def on_part_end(self) -> None:
        if self._text is not None:
            self.fields[self._name] = _decode(bytes(self._text))

    def on_end(self) -> None:
        self.complete = True

    def take(self) -> list[tuple[str, bytes]]:
        pending, self.pending = self.pending, []
        return pending


@asynccontextmanager
async def receive_form(request: Request, names: Sequence[str] = ("file",)) -> AsyncIterator[Form]:
    """Receive a ``multipart/form-data`` body with at most one file in each field of ``names``.

    Raises
    ------
    TooLargeError
        If the files together have more bytes than the settings allow; they are then not on the disk any more.
    HTTPException
        400 for a malformed form, 415 for a body of another kind.
    UnavailableError
        If it could not be kept now; nothing of it was read.
    """
    kind, options = parse_options_header(request.headers.get("content-type"))
    if kind != b"multipart/form-data":
        raise HTTPException(415, f"Send the file as multipart/form-data, in the field '{names[0]}'.")
    if not options.get(b"boundary"):
        raise HTTPException(400, "The Content-Type of the form names no boundary.")
    await run_in_threadpool(get_service(request).availability.require)
    directory = get_settings(request).data_dir / INCOMING
    targets: dict[str, BinaryIO] = {}
    try:
        yield await _read(request, options[b"boundary"], _Parts(names), directory, targets)
    finally:
        for target in targets.values():
            target.close()
            Path(target.name).unlink(missing_ok=True)


async def _read(
    request: Request, boundary: bytes, parts: _Parts, directory: Path, targets: dict[str, BinaryIO]
) -> Form:
    """Write what arrives into files, added to ``targets`` as they are opened."""
    limit, written = get_settings(request).max_upload_bytes, 0
    try:
        parser = MultipartParser(boundary, parts.callbacks())
        async for chunk in request.stream():
            parser.write(chunk)
            for name, data in parts.take():
                written += len(data)
                # What is more is read to its end, so that the client sees the answer, but not kept.
                if written <= limit:
                    if name not in targets:
                        targets[name] = await anyio.to_thread.run_sync(_open, directory)
                    await anyio.to_thread.run_sync(targets[name].write, data)
    except FormParserError:
        raise HTTPException(400, "The form is malformed: it does not follow multipart/form-data.") from None
    if written > limit:
        several = len(parts.filenames) > 1
        what, advice = ("files together are", "smaller ones") if several else ("file is", "a smaller one")
        raise TooLargeError(f"The {what} larger than {format_bytes(limit)}: send {advice}.")
    if not parts.complete:
        raise HTTPException(400, "The form ends in the middle: send it again.")
    for name, filename in parts.filenames.items():
        if filename and name not in targets:  # an empty file; without a file name a browser means that none was chosen
            targets[name] = await anyio.to_thread.run_sync(_open, directory)
    for target in targets.values():
        await anyio.to_thread.run_sync(target.flush)
    return Form(parts.fields, {name: Path(target.name) for name, target in targets.items()})


async def add_sample(request: Request, path: Path, owner: str | None) -> Sample:
    """Make a sample of a received file; what it takes on the disk counts for the client."""
    service = get_service(request)
    try:
        sample = await threads.run(threads.UPLOADS, service.samples.add, path, owner)
    except AppError as error:
        reason = type(error).__name__.removesuffix("Error")
        cast(Metrics, request.app.state.metrics).refused.labels(reason).inc()
        raise
    limits = cast(Limits, request.app.state.limits)
    limits.count_bytes(client_of(request), await run_in_threadpool(service.samples.stored_bytes, sample))
    return sample


def remove_abandoned(data_dir: Path) -> None:
    """Remove the files of uploads that a web process left behind when it was killed."""
    for path in (data_dir / INCOMING).glob(f"{PREFIX}*"):
        with suppress(FileNotFoundError):  # another process on this directory was faster
            if time.time() - path.stat().st_mtime > ABANDONED_SECONDS:
                path.unlink()


def _open(directory: Path) -> BinaryIO:
    directory.mkdir(parents=True, exist_ok=True)
    return tempfile.NamedTemporaryFile(dir=directory, prefix=PREFIX, delete=False)  # type: ignore[return-value]


def _decode(text: bytes) -> str:
    try:
        return text.decode()
    except UnicodeDecodeError:
        raise HTTPException(400, "The form's text is not UTF-8.") from None

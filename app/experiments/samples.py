"""Samples: takes in uploaded and bundled pictures and videos, each decoded and stored once, and finds them again."""

import logging
import threading
from datetime import UTC, datetime
from pathlib import Path

from app.errors import AppError, UnavailableError
from app.experiments.failures import unavailability
from app.experiments.model import Sample
from app.experiments.ports import BlobStore, ExperimentStore
from app.experiments.tokens import new_identifier, token_digest
from app.images.crop import Frames, Rectangle
from app.images.decode import Limits
from app.images.intake.client import server, take_in
from app.images.stored_video import frames_have_transparency
from app.samples import read_catalogue
from app.settings import Settings

log = logging.getLogger(__name__)


class Samples:
    """Uploaded and bundled samples; files are decoded in a process that can be killed."""

    def __init__(self, store: ExperimentStore, blobs: BlobStore, settings: Settings) -> None:
        self._store = store
        self._blobs = blobs
        self._directory = settings.samples_dir
        self._limits = Limits.from_settings(settings)

    def add(self, upload: Path, owner: str | None) -> Sample:
        """Make a sample of an uploaded file, which is gone afterwards, whatever comes of it; ``owner`` is a token.

        Raises `UnsupportedFormatError`, `BrokenFileError`, `TooLargeError`, or `BusyError` if too many are decoded.
        """
        try:
            return self._add(upload, new_identifier(), None if owner is None else token_digest(owner), title=None)
        finally:
            upload.unlink(missing_ok=True)

    def get(self, sample_id: str) -> Sample:
        """Read one. Raises `NotFoundError`."""
        return self._store.sample(sample_id)

    def stored_bytes(self, sample: Sample) -> int:
        """Tell how much of the disk a sample takes."""
        return self._blobs.path(sample.digest).stat().st_size

    def bundled(self) -> list[Sample]:
        """List the bundled ones that have come in so far, in the order of the catalogue."""
        return self._store.bundled_samples()

    def add_bundled(self, closing: threading.Event) -> None:
        """Take in the bundled samples that are not stored yet, until ``closing`` is set."""
        known = {sample.id for sample in self._store.bundled_samples()}
        for entry in read_catalogue(self._directory):
            if closing.is_set():
                return
            if entry.id in known:
                continue
            try:
                self._add(entry.path, entry.id, None, title=entry.title)
            except UnavailableError:
                raise
            except AppError as error:
                log.error("the bundled sample %s cannot be used: %s", entry.path, error)
            except OSError as error:
                if entry.path.is_file():
                    raise unavailability(error) from error
                log.error("the bundled sample %s is not there", entry.path)
            except Exception:
                if not self._is_bundled(entry.id):  # otherwise another process took it in at the same time
                    raise

    def open(self) -> None:
        """Start the process that decodes, so that the first upload need not wait for it."""
        server.start()

    def close(self) -> None:
        """End the process that decodes."""
        server.stop()

    def has_transparency(self, sample: Sample, crop: Rectangle, frames: Frames) -> bool:
        """Whether the crop holds pixels that are not opaque."""
        return frames_have_transparency(self._blobs.path(sample.digest), crop, frames, sample.height)

    def _is_bundled(self, sample_id: str) -> bool:
        return any(sample.id == sample_id for sample in self._store.bundled_samples())

    def _add(self, path: Path, sample_id: str, owner: str | None, *, title: str | None) -> Sample:
        found = take_in(path, self._blobs.temporary_directory, self._limits)
        with self._blobs.lease():
            sample = Sample(
                **found.properties(),
                id=sample_id,
                digest=self._blobs.put_file(found.path),
                created_at=datetime.now(UTC),
                title=title,
                bundled=title is not None,
            )
            self._store.add_sample(sample, owner)
        return sample

"""Uploaded and bundled photographs: from a file somebody gave to a sample."""

import logging
import threading
from datetime import UTC, datetime
from pathlib import Path

from app.errors import AppError
from app.experiments.model import Sample
from app.experiments.ports import BlobStore, ExperimentStore
from app.experiments.tokens import new_identifier
from app.images.crop import Frames, Rectangle
from app.images.decode import Limits
from app.images.intake.client import server, take_in
from app.images.stored_video import frames_have_transparency
from app.samples import bundled
from app.settings import Settings

log = logging.getLogger(__name__)


class SampleIntake:
    """Keeps photographs: each is decoded and stored once, in a process that can be killed."""

    def __init__(self, store: ExperimentStore, blobs: BlobStore, settings: Settings) -> None:
        self._store = store
        self._blobs = blobs
        self._directory = settings.samples_dir
        self._limits = Limits.from_settings(settings)

    def add(self, upload: Path, owner: str | None) -> Sample:
        """A new sample of this file; ``owner`` is the digest of a token.

        Raises
        ------
        UnsupportedFormatError, BrokenFileError, TooLargeError
            As `app.images.intake.client` finds.
        BusyError
            If too many others are being decoded.
        """
        return self._add(upload, new_identifier(), owner, title=None)

    def add_bundled(self, closing: threading.Event) -> None:
        """Keep the bundled photographs that are not kept yet, until told to stop."""
        known = {sample.id for sample in self._store.bundled_samples()}
        for entry in bundled(self._directory):
            if closing.is_set():
                return
            if entry.id in known:
                continue
            try:
                self._add(entry.path, entry.id, None, title=entry.title)
            except AppError as error:
                log.error("the bundled photograph %s cannot be used: %s", entry.path, error)

    def open(self) -> None:
        """Start the process that decodes, so that the first upload need not wait for it."""
        server.start()

    def close(self) -> None:
        """End the process that decodes."""
        server.stop()

    def transparent(self, sample: Sample, crop: Rectangle, frames: Frames) -> bool:
        """Whether the crop holds pixels that are not opaque."""
        return frames_have_transparency(self._blobs.path(sample.digest), crop, frames, sample.height)

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

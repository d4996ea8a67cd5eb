"""Samples are taken in once; what comes with the service is found again, and one that is broken keeps no other out."""

import errno
import logging
import shutil
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.errors import DATABASE, BrokenFileError, NotFoundError, UnavailableError
from app.experiments import samples as module
from app.experiments.model import Sample
from app.experiments.samples import Samples
from app.experiments.service import Service
from app.experiments.tokens import token_digest
from app.images.crop import Frames, Rectangle
from app.images.png_writer import encode_png
from app.samples import BundledSample


def entry(path: Path) -> BundledSample:
    return BundledSample(path, path.stem.capitalize(), "micro-texture", Rectangle(0, 0, 8, 8), "the tests", "CC0", "")


@pytest.fixture
def three(tmp_path: Path, photograph: Path, monkeypatch: pytest.MonkeyPatch) -> list[BundledSample]:
    """Bundled samples, the second of which is no picture."""
    paths = [tmp_path / f"{name}.png" for name in ("first", "second", "third")]
    for path in paths:
        shutil.copy(photograph, path)
    paths[1].write_bytes(b"\x89PNG\r\n\x1a\n and no more")
    entries = [entry(path) for path in paths]
    monkeypatch.setattr(module, "read_catalogue", lambda directory: entries)
    return entries


def test_a_bundled_sample_that_cannot_be_read_is_logged_and_keeps_no_other_out(
    make_service: Callable[..., Service], three: list[BundledSample], caplog: pytest.LogCaptureFixture
) -> None:
    samples = make_service().samples
    samples.add_bundled(threading.Event())
    found = samples.bundled()
    assert [(sample.id, sample.title, sample.bundled) for sample in found] == [
        ("first", "First", True),
        ("third", "Third", True),
    ]
    assert [record.levelno for record in caplog.records] == [logging.ERROR]
    assert f"the bundled sample {three[1].path} cannot be used: " in caplog.records[0].message


def test_bundled_samples_may_be_taken_in_by_two_services_at_once(
    make_service: Callable[..., Service], three: list[BundledSample], monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = make_service().samples, make_service().samples
    add = Samples._add

    def late(self: Samples, path: Path, sample_id: str, owner: str | None, *, title: str | None) -> Sample:
        if self is one and path == three[0].path:
            add(other, path, sample_id, owner, title=title)
        return add(self, path, sample_id, owner, title=title)

    monkeypatch.setattr(Samples, "_add", late)
    one.add_bundled(threading.Event())
    assert [sample.id for sample in one.bundled()] == ["first", "third"]


@pytest.mark.parametrize("error", [UnavailableError(DATABASE, "It is away."), OSError(errno.ENOSPC, "full")])
def test_bundled_samples_wait_for_what_is_away(
    make_service: Callable[..., Service],
    three: list[BundledSample],
    monkeypatch: pytest.MonkeyPatch,
    error: Exception,
) -> None:
    def fail(*_arguments: object, title: str | None) -> Sample:
        raise error

    samples = make_service().samples
    monkeypatch.setattr(Samples, "_add", fail)
    with pytest.raises(UnavailableError, match=r"away|room"):
        samples.add_bundled(threading.Event())


def test_bundled_samples_are_taken_in_once(
    make_service: Callable[..., Service], three: list[BundledSample], monkeypatch: pytest.MonkeyPatch
) -> None:
    samples = make_service().samples
    samples.add_bundled(threading.Event())
    before, taken = samples.bundled(), []
    add = Samples._add

    def noting(self: Samples, path: Path, sample_id: str, owner: str | None, *, title: str | None) -> Sample:
        taken.append(sample_id)
        return add(self, path, sample_id, owner, title=title)

    monkeypatch.setattr(Samples, "_add", noting)
    samples.add_bundled(threading.Event())
    assert taken == ["second"]  # which is not there yet, and may have been mended
    assert samples.bundled() == before


def test_taking_bundled_samples_in_stops_when_the_service_does(
    make_service: Callable[..., Service], three: list[BundledSample]
) -> None:
    closing = threading.Event()
    closing.set()
    samples = make_service().samples
    samples.add_bundled(closing)
    assert samples.bundled() == []


@pytest.mark.parametrize("owner", [None, "a token"])
def test_an_upload_is_found_again_and_only_its_owners_digest_is_kept(
    service: Service, upload: Path, monkeypatch: pytest.MonkeyPatch, owner: str | None
) -> None:
    owners: list[str | None] = []
    add_sample = service._store.add_sample

    def noting(sample: Sample, owner: str | None = None) -> None:
        owners.append(owner)
        add_sample(sample, owner)

    monkeypatch.setattr(service._store, "add_sample", noting)
    sample = service.samples.add(upload, owner)
    assert service.samples.get(sample.id) == sample
    assert (sample.title, sample.bundled, sample.moving) == (None, False, False)
    assert service.samples.bundled() == []
    assert owners == [None if owner is None else token_digest(owner)]
    with pytest.raises(NotFoundError, match="There is no such photograph"):
        service.samples.get("nothing")


def test_an_upload_that_cannot_be_read_leaves_nothing(
    service: Service, upload: Path, stored: Callable[[], set[str]]
) -> None:
    upload.write_bytes(b"\x89PNG\r\n\x1a\n and no more")
    with pytest.raises(BrokenFileError, match="This PNG file is damaged or incomplete"):
        service.samples.add(upload, None)
    assert not upload.exists()
    assert stored() == set()


@pytest.mark.parametrize(("x", "expected"), [(0, True), (4, False)])
def test_a_crop_has_transparency_if_a_pixel_of_it_does(
    service: Service, tmp_path: Path, x: int, expected: bool
) -> None:
    pixels = np.full((8, 8, 4), 255, np.uint8)
    pixels[2, 3, 3] = 0
    path = tmp_path / "hole.png"
    path.write_bytes(encode_png(pixels))
    sample = service.samples.add(path, None)
    assert sample.transparent
    assert service.samples.has_transparency(sample, Rectangle(x, 0, 4, 8), Frames()) is expected

"""What is known of a picture or a video goes through all that derives from it, whole."""

from dataclasses import fields
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.experiments.model import Output, Sample
from app.images.decode import Decoded
from app.images.formats.clip import ClipStream
from app.images.intake.client import Intake
from app.images.media import STILL, Media
from app.methods.model import Fact, Picture
from app.store import schema

VIDEO = Media(64, 48, 3, 8, True, 30, 12.5, "video/webm")
NOW = datetime(2026, 1, 1, tzinfo=UTC)


@pytest.mark.parametrize(
    "derived",
    [
        Intake(**VIDEO.properties(), path=Path("stored.png")),
        Decoded(**VIDEO.properties(), pixels=np.zeros((1440, 64, 3), np.uint8), alpha=None),
        Sample(**VIDEO.properties(), id="sea", digest="", created_at=NOW, title="Sea"),
    ],
    ids=lambda derived: type(derived).__name__,
)
def test_what_derives_from_media_keeps_every_property_and_passes_on_no_more(derived: Media) -> None:
    assert Media(**derived.properties()) == VIDEO


def test_an_output_keeps_every_property_of_its_picture() -> None:
    shown: dict[str, Any] = {"kind": "texture", "media_type": "video/mp4", "frames": 9, "rate": 5.0}
    picture = Picture("texture", "Texture", 64, 48, b"", (Fact("r", "R", 1),), **shown)
    output = Output(**picture.properties(), bytes=7, digest="00")
    assert output == Output("texture", "Texture", 64, 48, bytes=7, digest="00", **shown)


def test_the_database_has_a_column_for_every_field() -> None:
    """So a property that is added to a picture cannot be lost on the way to the store."""
    assert {field.name for field in fields(Sample)} == set(schema.samples.c.keys()) - {"owner"}
    assert {field.name for field in fields(Output)} == set(schema.outputs.c.keys()) - {"experiment", "place"}


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("transparent", [False, True])
def test_a_still_picture_is_described_by_its_arrays(channels: int, dtype: type, transparent: bool) -> None:
    pixels = np.zeros((5, 7, channels), dtype)
    found = Decoded.still(pixels, np.zeros((5, 7), dtype) if transparent else None)
    assert Media(**found.properties()) == Media(
        7, 5, channels, np.dtype(dtype).itemsize * 8, transparent, 1, 0.0, STILL
    )
    assert not found.moving


@pytest.mark.parametrize(
    ("channels", "colours", "transparent"), [(1, 1, False), (2, 1, True), (3, 3, False), (4, 3, True)]
)
def test_a_clip_is_described_once_its_frames_are_counted(channels: int, colours: int, transparent: bool) -> None:
    clip = ClipStream(64, 48, channels, "image/gif", iter(()))
    assert clip.media([0.0, 0.25, 0.5]) == Media(64, 48, colours, 8, transparent, 3, 4.0, "image/gif")
    assert clip.media([0.0, 0.25, 0.5]).moving


def test_a_clip_of_one_frame_is_a_still_picture() -> None:
    found = ClipStream(64, 48, 3, "image/gif", iter(())).media([0.0])
    assert (found.frames, found.rate, found.media_type, found.moving) == (1, 0.0, STILL, False)

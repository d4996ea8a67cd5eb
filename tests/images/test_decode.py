"""Decoding of uploads: what is read comes back, and a refusal says in words what helps."""

import io
import struct
from collections.abc import Callable
from dataclasses import astuple
from pathlib import Path
from typing import Any

import imagecodecs
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from app.errors import BrokenFileError, TooLargeError, UnsupportedFormatError
from app.images import decode as module
from app.images.decode import Decoded, Limits, decode
from app.images.intake.store import encode_picture
from app.settings import Settings

Read = Callable[..., Decoded]
Noise = Callable[..., NDArray[Any]]
SAMPLES = Path(__file__).parents[2] / "samples"
FORMATS = ["png", "jpeg", "webp", "tiff"]


@pytest.fixture(scope="module", params=FORMATS)
def file(request: pytest.FixtureRequest) -> bytes:
    """A photograph of 96 × 64 pixels in each format."""
    written = io.BytesIO()
    with Image.open(SAMPLES / "scene_china.jpg") as photograph:
        photograph.resize((96, 64)).save(written, request.param)
    return written.getvalue()


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (b"Dear service, here is a photograph.", "This file is not"),
        (b"<!doctype html><html><body><img src=x onerror=alert(1)></body></html>", "This file is not"),
        (b'<svg xmlns="http://www.w3.org/2000/svg"><rect width="9" height="9"/></svg>', "This file is not"),
        (b"BM" + bytes(40), "BMP"),
        (b"%PDF-1.7", "PDF"),
        (b"\0\0\0\x18ftypheic" + bytes(40), "HEIC"),
        (b"\0\0\0\x18ftypavis" + bytes(40), "HEIC or AVIF"),
        (b"RIFF" + bytes(4) + b"AVI " + bytes(40), "AVI"),
        (b"OggS" + bytes(40), "Ogg"),
        (b"\0", "This file is not"),
    ],
)
def test_other_formats_are_refused_and_the_right_ones_named(read: Read, data: bytes, kind: str) -> None:
    with pytest.raises(UnsupportedFormatError, match=kind) as refusal:
        read(data)
    assert "PNG, JPEG, WebP, TIFF and GIF pictures, and MP4 (H.264), WebM" in refusal.value.message


def test_an_empty_file_is_refused(read: Read) -> None:
    with pytest.raises(BrokenFileError, match="empty"):
        read(b"")


def test_the_name_does_not_make_the_format(tmp_path: Path, read: Read, file: bytes) -> None:
    assert read(file).pixels.shape == (64, 96, 3)  # in a file called upload.tmp
    with pytest.raises(UnsupportedFormatError, match="a BMP picture"):
        read(b"BM" + file)


@pytest.mark.parametrize("part", [0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97])
def test_a_truncated_file_is_refused(read: Read, file: bytes, part: float) -> None:
    with pytest.raises(BrokenFileError, match=r"damaged or incomplete[:.] (open it|Open it)"):
        read(file[: max(12, int(len(file) * part))])


def test_too_many_pixels_are_refused_with_numbers(read: Read, file: bytes) -> None:
    with pytest.raises(TooLargeError, match=r"96 × 64 pixels.*at most 0\.0 megapixels"):
        read(file, pixels=96 * 64 - 1)
    read(file, pixels=96 * 64)


def test_too_many_bytes_are_refused_with_numbers(read: Read, file: bytes) -> None:
    with pytest.raises(TooLargeError, match=r"MB; at most"):
        read(file, bytes=len(file) - 1)


def test_a_huge_size_is_refused_by_the_header_alone(read: Read, png_saying: Callable[..., bytes]) -> None:
    headers = [
        png_saying(100_000, 100_000, 8, 2, b""),
        b"\xff\xd8\xff\xc0\0\x11\x08" + struct.pack(">HH", 60_000, 60_000) + b"\3" + bytes(20),
        b"RIFF" + struct.pack("<I", 30) + b"WEBPVP8X" + struct.pack("<I", 10) + bytes(4) + b"\xfe\xff\xff" * 2,
        b"RIFF" + struct.pack("<I", 30) + b"WEBPVP8L" + struct.pack("<I", 10) + b"\x2f\xff\xff\xff\x0f" + bytes(9),
        b"RIFF" + struct.pack("<I", 30) + b"WEBPVP8 " + struct.pack("<I", 10) + b"\0\0\0\x9d\x01\x2a\xff\x3f\xff\x3f",
        b"II*\0\x08\0\0\0\x02\0"
        + struct.pack("<HHII", 256, 4, 1, 70_000)
        + struct.pack("<HHII", 257, 4, 1, 70_000)
        + bytes(4),
    ]
    for header in headers:
        with pytest.raises(TooLargeError, match="megapixels"):
            read(header)


def test_what_is_written_is_what_was_decoded(read: Read, noise: Noise) -> None:
    for channels, dtype in ((1, np.uint8), (2, np.uint16), (3, np.uint16), (4, np.uint8)):
        picture = read(imagecodecs.png_encode(noise(70, 50, channels, dtype=dtype)))
        again = read(encode_picture(picture))
        np.testing.assert_array_equal(again.pixels, picture.pixels)
        np.testing.assert_array_equal(again.alpha, picture.alpha)


@pytest.mark.parametrize("error", [IndexError("out of range"), struct.error("short"), ZeroDivisionError(), OSError()])
def test_whatever_a_library_raises_is_damage(
    tmp_path: Path, file: bytes, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    def fail(data: bytes, max_pixels: int) -> None:
        raise error

    monkeypatch.setattr(module, "_choose_decoder", lambda data: fail)
    (tmp_path / "upload").write_bytes(file)
    with pytest.raises(BrokenFileError, match="This file cannot be decoded") as refusal:
        decode(tmp_path / "upload", Limits())
    assert refusal.value.__cause__ is error


def test_a_lack_of_memory_is_no_damage(tmp_path: Path, file: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(data: bytes, max_pixels: int) -> None:
        raise MemoryError

    monkeypatch.setattr(module, "_choose_decoder", lambda data: fail)
    (tmp_path / "upload").write_bytes(file)
    with pytest.raises(MemoryError):
        decode(tmp_path / "upload", Limits())


def test_the_limits_are_those_of_the_settings() -> None:
    """Each of its own setting: seven numbers of which no two are alike."""
    settings = Settings(
        max_upload_bytes=1 << 20,
        max_upload_pixels=2_000_000,
        decode_seconds=3,
        decode_memory=1 << 28,
        max_film_frames=50,
        max_film_seconds=6,
        max_film_pixels=7_000_000,
    )
    limits = Limits.from_settings(settings)
    assert astuple(limits) == (1 << 20, 2_000_000, 3, 1 << 28, 50, 6, 7_000_000)
    assert astuple(limits.clip) == (50, 6, 7_000_000)

"""Uploads that are refused, in words that help: other formats, damage, lies about the size, too much of anything."""

import io
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from app.errors import BrokenFileError, TooLargeError, UnsupportedFormatError
from app.images.decode import Decoded

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
    with pytest.raises(UnsupportedFormatError, match="This file is a BMP picture, which is not in a format that"):
        read(b"BM" + file)


@pytest.mark.parametrize("part", [0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97])
def test_a_truncated_file_is_refused(read: Read, file: bytes, part: float) -> None:
    with pytest.raises(BrokenFileError, match="is damaged or incomplete"):
        read(file[: max(12, int(len(file) * part))])


def patched(png: bytes, width: int, height: int) -> bytes:
    header = b"IHDR" + struct.pack(">II", width, height) + png[24:29]
    return png[:12] + header + struct.pack(">I", zlib.crc32(header)) + png[33:]


@pytest.mark.parametrize(("width", "height"), [(96, 65), (96, 63), (96, 640), (97, 64), (95, 64), (1, 1)])
def test_a_png_that_lies_about_its_size_is_refused(read: Read, noise: Noise, width: int, height: int) -> None:
    written = io.BytesIO()
    Image.fromarray(noise(64, 96, 3)).save(written, "png")
    with pytest.raises(BrokenFileError, match="This PNG file is damaged or incomplete"):
        read(patched(written.getvalue(), width, height))


@pytest.mark.parametrize("progressive", [False, True])
@pytest.mark.parametrize(("width", "height"), [(96, 128), (96, 1000), (400, 64)])
def test_a_jpeg_with_fewer_pixels_than_it_says_is_refused(
    read: Read, width: int, height: int, progressive: bool
) -> None:
    written = io.BytesIO()
    with Image.open(SAMPLES / "scene_china.jpg") as photograph:
        photograph.resize((96, 64)).save(written, "jpeg", progressive=progressive)
    data = written.getvalue()
    at = data.index(b"\xff\xc2" if progressive else b"\xff\xc0") + 5
    with pytest.raises(BrokenFileError, match="This JPEG file is damaged or incomplete"):
        read(data[:at] + struct.pack(">HH", height, width) + data[at + 4 :])


def test_a_jpeg_cut_short_and_closed_again_is_refused(read: Read) -> None:
    data = (SAMPLES / "scene_china.jpg").read_bytes()
    with pytest.raises(BrokenFileError, match="This JPEG file is damaged or incomplete"):
        read(data[: len(data) // 2] + b"\xff\xd9")


@pytest.mark.parametrize("mode", ["L", "RGB"])
@pytest.mark.parametrize("progressive", [False, True])
def test_a_jpeg_that_is_really_mid_grey_is_read(read: Read, mode: str, progressive: bool) -> None:
    written = io.BytesIO()
    Image.new(mode, (96, 64), 0x808080 if mode == "RGB" else 128).save(written, "jpeg", progressive=progressive)
    assert np.ptp(read(written.getvalue()).pixels) == 0


def test_damage_in_a_png_is_noticed_wherever_it_is(read: Read, noise: Noise) -> None:
    written = io.BytesIO()
    Image.fromarray(noise(16, 16, 3)).save(written, "png")
    data = bytearray(written.getvalue())
    for at in range(8, len(data) - 12, 11):
        damaged = data.copy()
        damaged[at] ^= 0x55
        with pytest.raises(BrokenFileError, match="This PNG file is damaged or incomplete"):
            read(bytes(damaged))


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


def test_twelve_bits_in_a_jpeg_are_refused_with_advice(read: Read) -> None:
    with pytest.raises(UnsupportedFormatError, match="12 bits per channel"):
        read(b"\xff\xd8\xff\xc1\0\x0b\x0c\0\x10\0\x10\1\1\x11\0" + bytes(20))

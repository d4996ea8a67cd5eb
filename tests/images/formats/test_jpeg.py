"""JPEG: every kind is read as Pillow decodes it; what a decoder would make up is refused."""

import io
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from app.errors import BrokenFileError, UnsupportedFormatError
from app.images.decode import Decoded

Read = Callable[..., Decoded]
SAMPLES = Path(__file__).parents[3] / "samples"


def saved(image: Image.Image, file_format: str, **options: Any) -> bytes:
    file = io.BytesIO()
    image.save(file, file_format, **options)
    return file.getvalue()


@pytest.mark.parametrize("options", [{}, {"progressive": True}, {"subsampling": 2}, {"optimize": True}])
@pytest.mark.parametrize("mode", ["L", "RGB"])
def test_a_jpeg_is_what_pillow_decodes(
    read: Read, photograph: NDArray[np.uint8], mode: str, options: dict[str, Any]
) -> None:
    data = saved(Image.fromarray(photograph).convert(mode), "jpeg", **options)
    with Image.open(io.BytesIO(data)) as image:
        np.testing.assert_array_equal(read(data).pixels.squeeze(), np.asarray(image))


def test_a_cmyk_jpeg_without_a_profile_shows_its_inks(read: Read) -> None:
    inks = np.zeros((32, 32, 4), np.uint8)
    inks[:16, :16, 0] = 255  # cyan
    inks[16:, 16:, 3] = 255  # black
    picture = read(saved(Image.fromarray(inks, "CMYK"), "jpeg", quality=100, subsampling=0))
    for place, colour in (((4, 4), (0, 255, 255)), ((28, 28), (0, 0, 0)), ((4, 28), (255, 255, 255))):
        np.testing.assert_allclose(picture.pixels[place].astype(int), colour, atol=3)


def test_a_phone_s_jpeg_with_a_second_picture_gives_the_first(read: Read, photograph: NDArray[np.uint8]) -> None:
    first, second = Image.fromarray(photograph), Image.fromarray(photograph[::-1].copy())
    data = saved(first, "mpo", save_all=True, append_images=[second], quality=95)
    assert abs(read(data).pixels.astype(int) - photograph).mean() < 4


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
    with pytest.raises(BrokenFileError, match="This JPEG file is damaged"):
        read(data[:at] + struct.pack(">HH", height, width) + data[at + 4 :])


def test_a_jpeg_cut_short_and_closed_again_is_refused(read: Read) -> None:
    data = (SAMPLES / "scene_china.jpg").read_bytes()
    with pytest.raises(BrokenFileError, match="This JPEG file is damaged"):
        read(data[: len(data) // 2] + b"\xff\xd9")


@pytest.mark.parametrize("mode", ["L", "RGB"])
@pytest.mark.parametrize("progressive", [False, True])
def test_a_jpeg_that_is_really_mid_grey_is_read(read: Read, mode: str, progressive: bool) -> None:
    written = io.BytesIO()
    Image.new(mode, (96, 64), 0x808080 if mode == "RGB" else 128).save(written, "jpeg", progressive=progressive)
    assert np.ptp(read(written.getvalue()).pixels) == 0


def test_twelve_bits_in_a_jpeg_are_refused_with_advice(read: Read) -> None:
    with pytest.raises(UnsupportedFormatError, match="12 bits per channel"):
        read(b"\xff\xd8\xff\xc1\0\x0b\x0c\0\x10\0\x10\1\1\x11\0" + bytes(20))

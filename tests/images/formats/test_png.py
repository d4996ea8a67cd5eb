"""PNG: every kind is read at full depth; damage and wrong sizes are refused."""

import io
import struct
import zlib
from collections.abc import Callable
from typing import Any

import imagecodecs
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from app.errors import BrokenFileError
from app.images.decode import Decoded

Read = Callable[..., Decoded]
Noise = Callable[..., NDArray[Any]]


def saved(image: Image.Image, file_format: str, **options: Any) -> bytes:
    file = io.BytesIO()
    image.save(file, file_format, **options)
    return file.getvalue()


@pytest.mark.parametrize("mode", ["1", "L", "LA", "P", "RGB", "RGBA"])
def test_every_kind_of_png_has_the_pixels_that_pillow_sees(read: Read, noise: Noise, mode: str) -> None:
    image = Image.fromarray(noise(21, 34, 4))
    image = image.convert("RGB").quantize(50) if mode == "P" else image.convert(mode)
    picture = read(saved(image, "png"))
    grey = mode in ("1", "L", "LA")
    expected = np.asarray(image.convert("L" if grey else "RGB"))
    np.testing.assert_array_equal(picture.pixels, expected[..., None] if grey else expected)
    if mode in ("LA", "RGBA"):
        np.testing.assert_array_equal(picture.alpha, np.asarray(image.getchannel("A")))
    else:
        assert picture.alpha is None


def test_a_large_flat_png_is_read(read: Read, png_saying: Callable[..., bytes]) -> None:
    picture = read(png_saying(3000, 3000, 8, 2, bytes(3000 * 9001)))
    assert picture.pixels.shape == (3000, 3000, 3)
    assert not picture.pixels.any()


def test_palette_and_colour_key_transparency_become_an_alpha_channel(read: Read, noise: Noise) -> None:
    image = Image.fromarray(noise(9, 12, 3)).quantize(8)
    for source in (image, image.convert("RGB"), image.convert("L")):
        key = 3 if source.mode == "P" else source.getpixel((0, 0))
        data = saved(source, "png", transparency=key)
        with Image.open(io.BytesIO(data)) as seen:
            expected = np.asarray(seen.convert("RGBA"))[..., 3]
        np.testing.assert_array_equal(read(data).alpha, expected)


@pytest.mark.parametrize("bits", [2, 4])
def test_grey_of_few_bits_spreads_over_the_whole_range(read: Read, png_saying: Callable[..., bytes], bits: int) -> None:
    shades = 2**bits
    packed = bytes(
        int("".join(f"{value:0{bits}b}" for value in range(i, i + 8 // bits)), 2) for i in range(0, shades, 8 // bits)
    )
    picture = read(png_saying(shades, 1, bits, 0, b"\0" + packed))
    np.testing.assert_array_equal(picture.pixels[0, :, 0], np.arange(shades) * 255 // (shades - 1))


@pytest.mark.parametrize("shape", [(13, 17), (1, 1), (3, 2), (8, 8)])
def test_an_interlaced_png_is_put_together(
    read: Read, noise: Noise, png_saying: Callable[..., bytes], shape: tuple[int, int]
) -> None:
    pixels = noise(*shape, 3)
    rows = b""
    for x, y, dx, dy in [
        (0, 0, 8, 8),
        (4, 0, 8, 8),
        (0, 4, 4, 8),
        (2, 0, 4, 4),
        (0, 2, 2, 4),
        (1, 0, 2, 2),
        (0, 1, 1, 2),
    ]:
        if (part := pixels[y::dy, x::dx]).size:
            rows += b"".join(b"\0" + row.tobytes() for row in part)
    np.testing.assert_array_equal(read(png_saying(shape[1], shape[0], 8, 2, rows, 1)).pixels, pixels)


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_sixteen_bits_of_a_png_stay_sixteen_bits(read: Read, noise: Noise, channels: int) -> None:
    pixels = noise(15, 22, channels, dtype=np.uint16)
    picture = read(imagecodecs.png_encode(pixels))
    colours = channels - 1 + channels % 2
    assert picture.depth == 16
    np.testing.assert_array_equal(picture.pixels, pixels[..., :colours])
    if channels in (2, 4):
        np.testing.assert_array_equal(picture.alpha, pixels[..., -1])


def patched(png: bytes, width: int, height: int) -> bytes:
    header = b"IHDR" + struct.pack(">II", width, height) + png[24:29]
    return png[:12] + header + struct.pack(">I", zlib.crc32(header)) + png[33:]


@pytest.mark.parametrize(("width", "height"), [(96, 65), (96, 63), (96, 640), (97, 64), (95, 64), (1, 1)])
def test_a_png_that_lies_about_its_size_is_refused(read: Read, noise: Noise, width: int, height: int) -> None:
    written = io.BytesIO()
    Image.fromarray(noise(64, 96, 3)).save(written, "png")
    with pytest.raises(BrokenFileError, match="This PNG file is damaged"):
        read(patched(written.getvalue(), width, height))


def test_damage_in_a_png_is_noticed_wherever_it_is(read: Read, noise: Noise) -> None:
    written = io.BytesIO()
    Image.fromarray(noise(16, 16, 3)).save(written, "png")
    data = bytearray(written.getvalue())
    for at in range(8, len(data) - 12, 11):
        damaged = data.copy()
        damaged[at] ^= 0x55
        with pytest.raises(BrokenFileError, match="This PNG file is damaged"):
            read(bytes(damaged))

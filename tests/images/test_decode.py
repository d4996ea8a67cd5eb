"""Uploads of pictures: every kind of the four formats is read at full depth, upright and in sRGB."""

import io
from collections.abc import Callable
from typing import Any

import imagecodecs
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image, ImageOps

from app.images.decode import Decoded
from app.images.intake.store import encode_picture

Read = Callable[..., Decoded]
Noise = Callable[..., NDArray[Any]]
ORIENTATION = 0x0112


def saved(image: Image.Image, file_format: str, **options: Any) -> bytes:
    file = io.BytesIO()
    image.save(file, file_format, **options)
    return file.getvalue()


def oriented(orientation: int) -> Image.Exif:
    exif = Image.Exif()
    exif[ORIENTATION] = orientation
    return exif


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


def test_webp_is_read_with_and_without_transparency(read: Read, noise: Noise) -> None:
    pixels = noise(20, 30, 4)
    picture = read(saved(Image.fromarray(pixels), "webp", lossless=True, exact=True))
    np.testing.assert_array_equal(picture.pixels, pixels[..., :3])
    np.testing.assert_array_equal(picture.alpha, pixels[..., 3])
    opaque = read(saved(Image.fromarray(pixels[..., :3]), "webp", lossless=True))
    np.testing.assert_array_equal(opaque.pixels, pixels[..., :3])
    assert opaque.alpha is None


def test_lossy_webp_looks_like_its_source(read: Read, photograph: NDArray[np.uint8]) -> None:
    picture = read(saved(Image.fromarray(photograph), "webp", quality=95))
    assert abs(picture.pixels.astype(int) - photograph).mean() < 4


@pytest.mark.parametrize("lowest", [255, 254])
def test_an_alpha_channel_that_is_opaque_is_dropped(read: Read, noise: Noise, lowest: int) -> None:
    pixels = noise(8, 8, 4)
    pixels[..., 3] = 255
    pixels[3, 3, 3] = lowest
    assert read(saved(Image.fromarray(pixels), "png")).alpha is None


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("file_format", ["jpeg", "png", "webp", "tiff"])
def test_the_picture_stands_as_its_orientation_says(
    read: Read, photograph: NDArray[np.uint8], file_format: str, orientation: int
) -> None:
    image = Image.fromarray(photograph)
    options = {"lossless": True} if file_format == "webp" else {"quality": 95} if file_format == "jpeg" else {}
    data = saved(image, file_format, exif=oriented(orientation), **options)
    with Image.open(io.BytesIO(data)) as seen:
        expected = np.asarray(ImageOps.exif_transpose(seen))
    np.testing.assert_array_equal(read(data).pixels, expected)


def test_transparency_turns_with_the_picture(read: Read, noise: Noise) -> None:
    pixels = noise(5, 9, 4)
    picture = read(saved(Image.fromarray(pixels), "png", exif=oriented(6)))
    np.testing.assert_array_equal(picture.alpha, np.rot90(pixels[..., 3], -1))


def test_an_impossible_orientation_is_ignored(read: Read, photograph: NDArray[np.uint8]) -> None:
    picture = read(saved(Image.fromarray(photograph), "png", exif=oriented(77)))
    np.testing.assert_array_equal(picture.pixels, photograph)


def test_what_is_written_is_what_was_decoded(read: Read, noise: Noise) -> None:
    for channels, dtype in ((1, np.uint8), (2, np.uint16), (3, np.uint16), (4, np.uint8)):
        picture = read(imagecodecs.png_encode(noise(70, 50, channels, dtype=dtype)))
        again = read(encode_picture(picture))
        np.testing.assert_array_equal(again.pixels, picture.pixels)
        np.testing.assert_array_equal(again.alpha, picture.alpha)

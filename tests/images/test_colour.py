"""Colours: profiles of light and of ink are turned into sRGB at full depth."""

import io
import struct
from collections.abc import Callable
from itertools import product
from typing import Any

import imagecodecs
import numpy as np
import pytest
import tifffile
from numpy.typing import NDArray
from PIL import Image

from app.images.decode import Decoded

Read = Callable[..., Decoded]
Noise = Callable[..., NDArray[Any]]
D65 = (0.3127, 0.3290, 1.0)
LINEAR = imagecodecs.cms_profile(
    "rgb", gamma=1.0, whitepoint=D65, primaries=[0.64, 0.33, 1, 0.30, 0.60, 1, 0.15, 0.06, 1]
)


def saved(image: Image.Image, file_format: str, **options: Any) -> bytes:
    file = io.BytesIO()
    image.save(file, file_format, **options)
    return file.getvalue()


def as_tiff(pixels: NDArray[Any], **options: Any) -> bytes:
    file = io.BytesIO()
    tifffile.imwrite(file, pixels, **options)
    return file.getvalue()


def srgb_of_linear(light: NDArray[Any]) -> NDArray[np.float64]:
    """IEC 61966-2-1, of values from 0 to 1."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("channels", [1, 3])
def test_a_linear_profile_is_converted_to_srgb_at_full_depth(
    read: Read, noise: Noise, dtype: type, channels: int
) -> None:
    peak = np.iinfo(dtype).max
    pixels = noise(16, 24, channels, dtype=dtype)
    pixels[0, 0] = 0
    pixels[0, 1] = peak
    profile = imagecodecs.cms_profile("gray", gamma=1.0) if channels == 1 else LINEAR
    picture = read(as_tiff(pixels, photometric="minisblack" if channels == 1 else "rgb", iccprofile=profile))
    assert picture.pixels.dtype == dtype
    # One step of 8 bits; of 16 bits a few, for profiles hold their numbers in 16 bits themselves.
    expected = srgb_of_linear(pixels / peak) * peak
    assert abs(picture.pixels - expected).max() <= (1 if dtype == np.uint8 else 8)


def test_a_wide_profile_is_converted_as_the_exact_transform_does(read: Read, noise: Noise) -> None:
    wide = imagecodecs.cms_profile(
        "rgb", gamma=2.2, whitepoint=D65, primaries=[0.64, 0.33, 1, 0.21, 0.71, 1, 0.15, 0.06, 1]
    )
    pixels = noise(64, 64, 3, dtype=np.uint16)
    exact = imagecodecs.cms_transform(
        pixels,
        wide,
        imagecodecs.cms_profile("srgb"),
        colorspace="rgb",
        outcolorspace="rgb",
        flags=imagecodecs.CMS.FLAGS.NOOPTIMIZE,
    )
    picture = read(as_tiff(pixels, photometric="rgb", iccprofile=wide))
    assert abs(picture.pixels.astype(int) - exact).max() <= 8


def table_profile(lightness: Callable[[int, int, int], int]) -> bytes:
    """Make an ICC profile that is no matrix and curves: a table from RGB to Lab with two points an axis.

    ``lightness`` is L* (255 is 100) at each corner of the cube, by red, green and blue, each 0 or 1; a* and b* are 0.
    """
    ramp = bytes(range(256))
    grid = b"".join(bytes([lightness(*corner), 128, 128]) for corner in product((0, 1), repeat=3))
    identity = b"".join(struct.pack(">i", 65536 * (i % 4 == 0)) for i in range(9))
    table = b"mft1" + bytes(4) + bytes([3, 3, 2, 0]) + identity + ramp * 3 + grid + ramp * 3
    table += bytes(-len(table) % 4)
    white = b"XYZ " + bytes(4) + struct.pack(">iii", 63190, 65536, 54061)
    start = 128 + 4 + 2 * 12
    tags = struct.pack(">I4sII4sII", 2, b"A2B0", start, len(table), b"wtpt", start + len(table), len(white))
    header = struct.pack(">II", start + len(table) + len(white), 0) + b"\x02\x10\0\0" + b"mntrRGB Lab " + bytes(12)
    header += b"acsp" + bytes(28) + struct.pack(">iii", 63190, 65536, 54061) + bytes(48)
    return header + tags + table + white


def srgb_of_lightness(lightness: NDArray[Any]) -> NDArray[np.float64]:
    """CIE 1976: the luminance of L* from 0 to 100, as a grey of sRGB."""
    light = np.where(lightness > 8, ((lightness + 16) / 116) ** 3, lightness / 903.2963)
    return srgb_of_linear(light)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("extreme", [max, min])
def test_a_profile_that_is_no_matrix_and_curves_is_converted_exactly(
    read: Read, noise: Noise, dtype: type, extreme: Callable[..., Any]
) -> None:
    """L* is the largest, or the smallest, of the three channels.

    Between the corners colour management interpolates in tetrahedra, in which both are linear: the formula is exact.
    They are no sum of what the channels give alone.
    """
    pixels = noise(60, 80, 3, dtype=dtype)
    pixels[0, :4] = np.array([[0, 0, 0], [1, 1, 1], [1, 0, 0], [1, 1, 0]]) * np.iinfo(dtype).max
    profile = table_profile(lambda *corner: 255 * extreme(corner))
    picture = read(as_tiff(pixels, photometric="rgb", iccprofile=profile)).pixels
    peak = np.iinfo(dtype).max
    expected = srgb_of_lightness((pixels.max(2) if extreme is max else pixels.min(2)) / peak * 100) * peak
    assert abs(picture - expected[..., None]).max() <= (0.6 if dtype == np.uint8 else 2)  # a rounding, or two


def test_a_profile_of_srgb_changes_nothing(read: Read, noise: Noise) -> None:
    pixels = noise(32, 32, 3)
    data = saved(Image.fromarray(pixels), "png", icc_profile=imagecodecs.cms_profile("srgb"))
    assert abs(read(data).pixels.astype(int) - pixels).max() <= 1


@pytest.mark.parametrize("file_format", ["png", "jpeg", "webp"])
def test_profiles_are_found_in_every_format(read: Read, file_format: str) -> None:
    image = Image.new("RGB", (16, 16), (55, 55, 55))
    data = saved(image, file_format, icc_profile=LINEAR, quality=100)
    expected = srgb_of_linear(np.array(55 / 255)) * 255
    np.testing.assert_allclose(read(data).pixels.mean(), expected, atol=2)


@pytest.mark.parametrize("profile", [b"broken", b"\0" * 500, imagecodecs.cms_profile("gray")])
def test_a_broken_or_foreign_profile_is_ignored(read: Read, noise: Noise, profile: bytes) -> None:
    pixels = noise(8, 8, 3)
    np.testing.assert_array_equal(read(saved(Image.fromarray(pixels), "png", icc_profile=profile)).pixels, pixels)


def test_a_profile_leaves_transparency_alone(read: Read, noise: Noise) -> None:
    pixels = noise(8, 8, 4)
    data = saved(Image.fromarray(pixels), "png", icc_profile=LINEAR)
    np.testing.assert_array_equal(read(data).alpha, pixels[..., 3])


def ink_profile() -> bytes:
    """Make a printer's ICC profile (version 2, CMYK to Lab, two grid points an axis): cyan prints as Lab 50, 0, 0."""

    def tag(name: bytes, content: bytes) -> bytes:
        return name + bytes(4) + content

    ramp = bytes(range(256))
    lightness = [
        0 if k else 255 if not (c or m or y) else 128 if not (m or y) else 64
        for c, m, y, k in product((0, 1), repeat=4)
    ]
    grid = b"".join(bytes([each, 128, 128]) for each in lightness)
    identity = b"".join(struct.pack(">i", 65536 * (i % 4 == 0)) for i in range(9))
    table = tag(b"mft1", bytes([4, 3, 2, 0]) + identity + ramp * 4 + grid + ramp * 3)
    table += bytes(-len(table) % 4)
    white = tag(b"XYZ ", struct.pack(">iii", 63190, 65536, 54061))
    start = 128 + 4 + 2 * 12
    tags = struct.pack(">I4sII4sII", 2, b"A2B0", start, len(table), b"wtpt", start + len(table), len(white))
    header = struct.pack(">II", start + len(table) + len(white), 0) + b"\x02\x10\0\0" + b"prtrCMYKLab " + bytes(12)
    header += b"acsp" + bytes(28) + struct.pack(">iii", 63190, 65536, 54061) + bytes(48)
    return header + tags + table + white


@pytest.mark.parametrize("file_format", ["jpeg", "tiff"])
def test_inks_with_a_profile_become_what_the_printer_prints(read: Read, file_format: str) -> None:
    inks = np.zeros((32, 48, 4), np.uint8)
    inks[:, 16:32, 0] = 255  # cyan
    inks[:, 32:, 3] = 255  # black
    picture = read(saved(Image.fromarray(inks, "CMYK"), file_format, icc_profile=ink_profile()))
    white, cyan, black = (picture.pixels[:, x].astype(int) for x in (5, 24, 42))
    assert white.min() >= 250
    assert black.max() <= 5
    # L* = 50 is 0.184 of white's light, and sRGB 119.
    np.testing.assert_allclose(cyan, 119, atol=3)


def test_inks_with_a_profile_for_light_are_shown_as_plain_inks(read: Read) -> None:
    image = Image.new("CMYK", (16, 16), (255, 0, 0, 0))
    picture = read(saved(image, "jpeg", icc_profile=LINEAR, quality=100))
    np.testing.assert_allclose(picture.pixels[8, 8].astype(int), (0, 255, 255), atol=3)

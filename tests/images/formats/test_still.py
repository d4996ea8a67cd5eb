"""Still pictures of every format: upright, and without an alpha channel that hides nothing."""

import io
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image, ImageOps

from app.images.decode import Decoded

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

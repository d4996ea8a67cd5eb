"""WebP: lossless and lossy, with and without transparency."""

import io
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from app.images.decode import Decoded

Read = Callable[..., Decoded]
Noise = Callable[..., NDArray[Any]]


def saved(image: Image.Image, file_format: str, **options: Any) -> bytes:
    file = io.BytesIO()
    image.save(file, file_format, **options)
    return file.getvalue()


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

"""Crops of stored pictures: the same pixels as of the whole, wherever they lie."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from app.errors import InvalidInputError
from app.images.crop import Rectangle
from app.images.decode import Decoded
from app.images.intake.store import encode_picture
from app.images.png_writer import PngWriter, encode_png
from app.images.read import has_transparency, read_crop

Noise = Callable[..., NDArray[Any]]
HEIGHT, WIDTH = 300, 7  # narrow, so that few pixels make several strips


@pytest.fixture(scope="module")
def strips(tmp_path_factory: pytest.TempPathFactory, noise: Noise) -> tuple[Path, NDArray[Any]]:
    """A 16-bit picture in strips of uneven height."""
    pixels = noise(HEIGHT, WIDTH, 3, dtype=np.uint16)
    writer = PngWriter(WIDTH, HEIGHT, 3, 16)
    for y in range(0, HEIGHT, 44):
        writer.write(y, pixels[y : y + 44])
    path = tmp_path_factory.mktemp("strips") / "picture.png"
    path.write_bytes(writer.finish())
    return path, pixels


@given(data=st.data())
def test_a_crop_is_what_it_is_in_the_whole_picture(strips: tuple[Path, NDArray[Any]], data: st.DataObject) -> None:
    path, pixels = strips
    x, y = data.draw(st.integers(0, WIDTH - 1)), data.draw(st.integers(0, HEIGHT - 1))
    width, height = data.draw(st.integers(1, WIDTH - x)), data.draw(st.integers(1, HEIGHT - y))
    crop = read_crop(path, Rectangle(x, y, width, height))
    assert crop.dtype == np.float32
    np.testing.assert_array_equal(crop, pixels[y : y + height, x : x + width])


@pytest.mark.parametrize(("channels", "dtype"), [(1, np.uint8), (3, np.uint8), (1, np.uint16), (3, np.uint16)])
def test_every_kind_of_stored_picture_is_read(tmp_path: Path, noise: Noise, channels: int, dtype: type) -> None:
    pixels = noise(200, 1000, channels, dtype=dtype)
    (tmp_path / "picture.png").write_bytes(encode_picture(Decoded.still(pixels, None)))
    crop = read_crop(tmp_path / "picture.png", Rectangle(3, 130, 990, 40))
    np.testing.assert_array_equal(crop, pixels[130:170, 3:993])


def test_a_png_by_others_is_read_too(tmp_path: Path, noise: Noise) -> None:
    pixels = noise(50, 60, 3)
    Image.fromarray(pixels).save(tmp_path / "picture.png")
    crop = read_crop(tmp_path / "picture.png", Rectangle(10, 20, 30, 25))
    np.testing.assert_array_equal(crop, pixels[20:45, 10:40])


def test_of_a_large_picture_only_the_strips_of_the_crop_are_read(tmp_path: Path, noise: Noise) -> None:
    pixels = noise(640, 2000, 3)
    data = bytearray(encode_picture(Decoded.still(pixels, None)))
    middle = len(data) // 2
    data[middle:] = bytes(len(data) - middle)
    (tmp_path / "picture.png").write_bytes(data)
    crop = read_crop(tmp_path / "picture.png", Rectangle(500, 10, 300, 200))
    np.testing.assert_array_equal(crop, pixels[10:210, 500:800])


def test_transparent_pixels_matter_only_inside_the_crop(tmp_path: Path, noise: Noise) -> None:
    pixels = noise(20, 30, 4)
    pixels[..., 3] = 255
    pixels[12, 17, 3] = 254  # as good as opaque
    pixels[5, 9, 3] = 128
    path = tmp_path / "picture.png"
    path.write_bytes(encode_png(pixels))
    clear, holding = Rectangle(10, 0, 20, 20), Rectangle(9, 5, 1, 1)
    assert not has_transparency(path, clear)
    np.testing.assert_array_equal(read_crop(path, clear), pixels[:, 10:, :3])
    assert has_transparency(path, holding)
    with pytest.raises(InvalidInputError, match="transparent pixels") as refusal:
        read_crop(path, holding)
    assert refusal.value.field == "crop"


@pytest.mark.parametrize("crop", ["0,0,0,5", "-1,0,5,5", "0,0,8,5", "0,296,5,5", "7,0,1,1"])
def test_a_crop_outside_the_picture_is_refused(strips: tuple[Path, NDArray[Any]], crop: str) -> None:
    with pytest.raises(InvalidInputError, match="crop"):
        read_crop(strips[0], Rectangle.parse(crop))

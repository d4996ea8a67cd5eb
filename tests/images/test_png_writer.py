"""The PNG writer: every decoder reads back what was written, however it was cut into strips."""

import io
import zlib
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path
from typing import Any

import imagecodecs
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from app.images.png_writer import PngWriter, combine_adler32, encode_png
from tests.profiles import examples

Picture = NDArray[np.uint8] | NDArray[np.uint16]


def noise(height: int, width: int, channels: int, dtype: Any = np.uint8, seed: int = 0) -> Any:
    rng = np.random.default_rng(seed)
    return rng.integers(0, np.iinfo(dtype).max, (height, width, channels), dtype=dtype, endpoint=True)


def texture(size: int, seed: int = 0) -> NDArray[np.uint8]:
    """Smooth noise of three channels: as hard to compress as a synthesised texture."""
    spectrum = np.fft.rfft2(np.random.default_rng(seed).normal(size=(size, size, 3)), axes=(0, 1))
    y, x = np.fft.fftfreq(size)[:, None], np.fft.rfftfreq(size)[None, :]
    spectrum /= (0.02 + np.hypot(y, x))[..., None]
    field = np.fft.irfft2(spectrum, s=(size, size), axes=(0, 1))
    return np.clip(128 + 40 * field / field.std(), 0, 255).astype(np.uint8)


def read(png: bytes, shape: tuple[int, ...]) -> Picture:
    return np.asarray(imagecodecs.png_decode(png)).reshape(shape)


@settings(max_examples=examples(80))
@given(
    st.integers(1, 70),
    st.integers(1, 70),
    st.sampled_from([1, 2, 3, 4]),
    st.sampled_from([np.uint8, np.uint16]),
    st.data(),
)
def test_strips_of_any_height_in_any_order_decode_to_the_same_pixels(
    height: int, width: int, channels: int, dtype: type, data: st.DataObject
) -> None:
    picture = noise(height, width, channels, dtype, seed=height * 71 + width)
    cuts = sorted({0, height, *data.draw(st.lists(st.integers(1, height), max_size=6))})
    strips = data.draw(st.permutations(list(pairwise(cuts))))
    writer = PngWriter(width, height, channels, picture.itemsize * 8)
    for start, stop in strips:
        writer.write(start, picture[start:stop])
    np.testing.assert_array_equal(read(writer.finish(), picture.shape), picture)


@pytest.mark.parametrize(("channels", "mode"), [(1, "L"), (2, "LA"), (3, "RGB"), (4, "RGBA")])
def test_pillow_reads_eight_bits_in_the_right_mode_and_calls_it_srgb(channels: int, mode: str) -> None:
    picture = noise(33, 47, channels)
    with Image.open(io.BytesIO(encode_png(picture))) as image:
        assert image.mode == mode
        assert image.info["srgb"] == 0
        np.testing.assert_array_equal(np.asarray(image).reshape(picture.shape), picture)


def test_pillow_reads_sixteen_bits_of_grey() -> None:
    picture = noise(20, 31, 1, np.uint16)
    with Image.open(io.BytesIO(encode_png(picture[..., 0]))) as image:
        np.testing.assert_array_equal(np.asarray(image), picture[..., 0])


def test_blocks_that_are_not_contiguous_are_written_as_they_read() -> None:
    picture = noise(24, 30, 3, np.uint16)
    for view in (picture[::-1, ::2], picture.transpose(1, 0, 2)):
        np.testing.assert_array_equal(read(encode_png(view), view.shape), view)


def test_many_threads_write_the_same_bytes_as_one() -> None:
    picture = noise(2000, 900, 3)
    assert encode_png(picture, threads=4) == encode_png(picture, threads=1)
    writer = PngWriter(900, 2000, 3, 8)
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda y: writer.write(y, picture[y : y + 7]), range(0, 2000, 7)))
    np.testing.assert_array_equal(read(writer.finish(), picture.shape), picture)


def test_the_block_may_change_after_it_was_written() -> None:
    picture = noise(8, 9, 3)
    block = picture.copy()
    writer = PngWriter(9, 8, 3, 8)
    writer.write(0, block)
    block[:] = 0
    np.testing.assert_array_equal(read(writer.finish(), picture.shape), picture)


def test_a_texture_is_no_larger_than_pillow_makes_it() -> None:
    picture = texture(512)
    theirs = io.BytesIO()
    Image.fromarray(picture).save(theirs, "png")
    assert len(encode_png(picture)) <= 1.02 * len(theirs.getvalue())


def test_missing_and_doubled_rows_are_refused() -> None:
    picture = noise(10, 4, 3)
    writer = PngWriter(4, 10, 3, 8)
    with pytest.raises(ValueError, match="row 0 is missing"):
        writer.finish()
    writer.write(0, picture[:4])
    writer.write(6, picture[6:])
    with pytest.raises(ValueError, match="row 4 is missing"):
        writer.finish()
    with pytest.raises(ValueError, match="row 6 was written twice"):
        writer.write(6, picture[6:7])
    writer.write(4, picture[4:7])
    with pytest.raises(ValueError, match="row 6 was written twice"):
        writer.finish()


@pytest.mark.parametrize(
    ("y", "block"),
    [
        (0, np.zeros((1, 4, 3), np.uint16)),
        (0, np.zeros((1, 5, 3), np.uint8)),
        (0, np.zeros((0, 4, 3), np.uint8)),
        (-1, np.zeros((1, 4, 3), np.uint8)),
        (9, np.zeros((2, 4, 3), np.uint8)),
    ],
)
def test_blocks_that_do_not_fit_are_refused(y: int, block: Picture) -> None:
    with pytest.raises(ValueError, match="picture"):
        PngWriter(4, 10, 3, 8).write(y, block)


def test_a_file_whose_height_nobody_knew_is_as_high_as_what_was_written(tmp_path: Path) -> None:
    picture = np.random.default_rng(0).integers(0, 256, (30, 7, 3), np.uint8)
    known, unknown = PngWriter(7, 30, 3, 8), PngWriter(7, None, 3, 8)
    with pytest.raises(ValueError, match="row 0 is missing"):
        unknown.finish()
    for y in range(0, 30, 10):
        known.write(y, picture[y : y + 10])
        unknown.write(y, picture[y : y + 10])
    unknown.save(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes() == unknown.finish() == known.finish()


def test_arrays_and_sizes_that_no_png_has_are_refused() -> None:
    for array in (np.zeros((4, 4, 5), np.uint8), np.zeros((0, 4), np.uint8), np.zeros(4, np.uint8)):
        with pytest.raises(ValueError, match="cannot write a PNG"):
            encode_png(array)
    with pytest.raises(ValueError, match="cannot write a PNG"):
        encode_png(np.zeros((4, 4), np.float32))  # what a caller may do by mistake


@given(st.binary(max_size=300), st.binary(max_size=300))
def test_combined_checksums_are_those_of_the_joined_bytes(first: bytes, second: bytes) -> None:
    assert combine_adler32(zlib.adler32(first), zlib.adler32(second), len(second)) == zlib.adler32(first + second)


def test_combined_checksums_hold_for_long_strings() -> None:
    first, second = b"\xff" * 3_000_000, b"\xfe" * 5_000_001
    assert combine_adler32(zlib.adler32(first), zlib.adler32(second), len(second)) == zlib.adler32(first + second)

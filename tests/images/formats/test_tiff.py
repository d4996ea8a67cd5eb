"""TIFF: every layout of whole numbers is read; what cannot be read is refused in words."""

import io
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import tifffile
from numpy.typing import NDArray
from PIL import Image

from app.errors import BrokenFileError, UnsupportedFormatError
from app.images.decode import Decoded

Read = Callable[..., Decoded]
Noise = Callable[..., NDArray[Any]]


def tiff(pixels: NDArray[Any], **options: Any) -> bytes:
    file = io.BytesIO()
    tifffile.imwrite(file, pixels, metadata=None, **({"photometric": "rgb"} | options))
    return file.getvalue()


LAYOUTS: list[dict[str, Any]] = [
    {},
    {"compression": "lzw"},
    {"compression": "lzw", "predictor": True},
    {"compression": "zlib", "predictor": True},
    {"compression": "packbits"},
    {"compression": "zstd"},
    {"rowsperstrip": 7},
    {"tile": (16, 32), "compression": "zlib"},
    {"byteorder": ">"},
    {"bigtiff": True},
]


@pytest.mark.parametrize("layout", LAYOUTS, ids=str)
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_every_layout_of_rgb_is_read_exactly(read: Read, noise: Noise, dtype: type, layout: dict[str, Any]) -> None:
    if layout.get("byteorder"):
        file = io.BytesIO()
        with tifffile.TiffWriter(file, byteorder=">") as writer:
            writer.write(noise(40, 50, 3, dtype=dtype), photometric="rgb", metadata=None)
        data = file.getvalue()
    elif layout.get("bigtiff"):
        file = io.BytesIO()
        with tifffile.TiffWriter(file, bigtiff=True) as writer:
            writer.write(noise(40, 50, 3, dtype=dtype), photometric="rgb", metadata=None)
        data = file.getvalue()
    else:
        data = tiff(noise(40, 50, 3, dtype=dtype), **layout)
    picture = read(data)
    assert picture.depth == np.dtype(dtype).itemsize * 8
    np.testing.assert_array_equal(picture.pixels, noise(40, 50, 3, dtype=dtype))


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_separate_planes_are_put_together(read: Read, noise: Noise, dtype: type) -> None:
    pixels = noise(3, 20, 30, dtype=dtype)
    picture = read(tiff(pixels, planarconfig="separate", compression="zlib"))
    np.testing.assert_array_equal(picture.pixels, np.moveaxis(pixels, 0, -1))


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_grey_is_read_whichever_end_is_white(read: Read, noise: Noise, dtype: type) -> None:
    pixels = noise(20, 30, dtype=dtype)
    np.testing.assert_array_equal(read(tiff(pixels, photometric="minisblack")).pixels[..., 0], pixels)
    peak = np.iinfo(dtype).max
    np.testing.assert_array_equal(read(tiff(pixels, photometric="miniswhite")).pixels[..., 0], peak - pixels)


@pytest.mark.parametrize("compression", [None, "group4", "tiff_lzw"])
def test_bilevel_becomes_black_and_white(read: Read, noise: Noise, compression: str | None) -> None:
    image = Image.fromarray(noise(33, 45)).convert("1")
    file = io.BytesIO()
    image.save(file, "tiff", compression=compression)
    np.testing.assert_array_equal(read(file.getvalue()).pixels[..., 0], np.asarray(image.convert("L")))


def test_twelve_bits_spread_over_sixteen(read: Read) -> None:
    pixels = np.array([[0, 1, 2048, 4095]], np.uint16)
    data = tiff(pixels, photometric="minisblack", bitspersample=12, compression=None)
    np.testing.assert_array_equal(read(data).pixels[0, :, 0], pixels[0].astype(int) * 65535 // 4095)


def test_a_palette_becomes_colours(read: Read, noise: Noise) -> None:
    image = Image.fromarray(noise(9, 14, 3)).quantize(20)
    file = io.BytesIO()
    image.save(file, "tiff")
    np.testing.assert_array_equal(read(file.getvalue()).pixels, np.asarray(image.convert("RGB")))


def test_a_jpeg_inside_is_decoded(read: Read, photograph: NDArray[np.uint8]) -> None:
    file = io.BytesIO()
    Image.fromarray(photograph).save(file, "tiff", compression="jpeg", quality=95)
    assert abs(read(file.getvalue()).pixels.astype(int) - photograph).mean() < 4


def test_inks_become_colours(read: Read) -> None:
    inks = np.zeros((1, 3, 4), np.uint16)
    inks[0, 0, 0] = inks[0, 1, 3] = 65535
    picture = read(tiff(inks, photometric="separated"))
    np.testing.assert_array_equal(picture.pixels[0], [[0, 65535, 65535], [0, 0, 0], [65535, 65535, 65535]])


def test_only_an_extra_channel_of_opacity_is_transparency(read: Read, noise: Noise) -> None:
    pixels = noise(12, 10, 4)
    clear = read(tiff(pixels, extrasamples=["unassalpha"]))
    np.testing.assert_array_equal(clear.alpha, pixels[..., 3])
    np.testing.assert_array_equal(clear.pixels, pixels[..., :3])
    assert read(tiff(pixels, extrasamples=["unspecified"])).alpha is None


def test_premultiplied_colours_are_divided_again(read: Read) -> None:
    colours = np.full((1, 3, 3), 200, np.uint8)
    alpha = np.array([[255, 128, 0]], np.uint8)
    premultiplied = np.round(colours * (alpha[..., None] / 255)).astype(np.uint8)
    data = tiff(np.concatenate([premultiplied, alpha[..., None]], axis=2), extrasamples=["assocalpha"])
    picture = read(data)
    np.testing.assert_allclose(picture.pixels[0, :2].astype(int), 200, atol=2)
    np.testing.assert_array_equal(picture.alpha, alpha)


def test_of_several_pages_the_first_is_taken(read: Read, noise: Noise) -> None:
    pages = noise(3, 16, 20, 3)
    np.testing.assert_array_equal(read(tiff(pages)).pixels, pages[0])


@pytest.mark.parametrize(
    ("pixels", "options", "words"),
    [
        (np.zeros((4, 4, 3), np.float32), {}, "floating-point"),
        (np.zeros((4, 4), np.float16), {"photometric": "minisblack"}, "floating-point"),
        (np.zeros((4, 4), np.int16), {"photometric": "minisblack"}, "16 bits per channel of a kind"),
        (np.zeros((4, 4), np.uint32), {"photometric": "minisblack"}, "32 bits per channel"),
        (np.zeros((4, 4, 3), np.uint8), {"photometric": "cielab"}, "colours of a kind"),
        (np.zeros((16, 16, 3), np.uint8), {"compression": "jpeg2000"}, "compressed in a way"),
    ],
)
def test_other_kinds_are_refused_with_advice(
    read: Read, pixels: NDArray[Any], options: dict[str, Any], words: str
) -> None:
    with pytest.raises(UnsupportedFormatError, match=words) as refusal:
        read(tiff(pixels, **options))
    assert "save it as" in refusal.value.message


@pytest.mark.parametrize("layout", LAYOUTS[:5], ids=str)
@pytest.mark.parametrize("height", [41, 80, 400])
def test_a_header_that_promises_more_rows_is_refused(
    read: Read, noise: Noise, layout: dict[str, Any], height: int
) -> None:
    data = tiff(noise(40, 50, 3), rowsperstrip=10, **layout)
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        at = file.pages.first.tags["ImageLength"].valueoffset
    with pytest.raises(BrokenFileError, match="This TIFF file is damaged"):
        read(data[:at] + height.to_bytes(2, "little") + data[at + 2 :])


def patched(data: bytes, tag: str, value: int, index: int = 0) -> bytes:
    """A TIFF file in which one number of a tag is another."""
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        entry = file.pages.first.tags[tag]
        size = {3: 2, 4: 4, 16: 8}[int(entry.dtype)]
        at = entry.valueoffset + index * size
    return data[:at] + value.to_bytes(size, "little") + data[at + size :]


def numbers(data: bytes, tag: str) -> list[int]:
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        value = file.pages.first.tags[tag].value
    return list(value) if isinstance(value, tuple) else [value]


SEGMENTS: list[tuple[str, dict[str, Any]]] = [
    ("Strip", {"rowsperstrip": 8}),
    ("Strip", {"rowsperstrip": 8, "compression": "zlib"}),
    ("Tile", {"tile": (16, 16)}),
    ("Tile", {"tile": (16, 16), "compression": "lzw"}),
]


@pytest.mark.parametrize(("kind", "layout"), SEGMENTS, ids=str)
@pytest.mark.parametrize("index", [0, 2, 3])
def test_an_empty_segment_is_refused(read: Read, noise: Noise, kind: str, layout: dict[str, Any], index: int) -> None:
    """Alone wrong: the library would leave its pixels black. The other segments lie where they should."""
    data = tiff(noise(32, 32, 3), **layout)
    counts = numbers(data, f"{kind}ByteCounts")
    assert len(counts) == 4
    empty = patched(data, f"{kind}ByteCounts", 0, index)
    if "compression" not in layout:  # so that the sum of all is right, which is looked at as well
        empty = patched(empty, f"{kind}ByteCounts", 2 * counts[1], 1)
    with pytest.raises(BrokenFileError, match="This TIFF file is damaged"):
        read(empty)


@pytest.mark.parametrize(("kind", "layout"), SEGMENTS, ids=str)
@pytest.mark.parametrize("index", [0, 3])
def test_a_segment_outside_the_file_is_refused(
    read: Read, noise: Noise, kind: str, layout: dict[str, Any], index: int
) -> None:
    data = tiff(noise(32, 32, 3), **layout)
    length = numbers(data, f"{kind}ByteCounts")[index]
    last = len(data) - length
    for start, right in ((last, True), (last + 1, False), (len(data) + 1000, False)):
        moved = patched(data, f"{kind}Offsets", start, index)
        if right:  # the last place that lies inside: no other check refuses it
            assert numbers(moved, f"{kind}Offsets")[index] + length == len(data)
            if "compression" not in layout:
                assert read(moved).pixels.shape == (32, 32, 3)
            continue
        with pytest.raises(BrokenFileError, match="This TIFF file is damaged"):
            read(moved)


@pytest.mark.parametrize(("kind", "layout"), SEGMENTS, ids=str)
def test_a_segment_that_is_not_listed_is_refused(read: Read, noise: Noise, kind: str, layout: dict[str, Any]) -> None:
    """Rows or columns of tiles that the header promises, and no list of segments has."""
    data = tiff(noise(32, 32, 3), **layout)
    more = patched(data, "ImageLength", 33)
    with pytest.raises(BrokenFileError, match="This TIFF file is damaged"):
        read(more)
    if kind == "Tile":
        with pytest.raises(BrokenFileError, match="This TIFF file is damaged"):
            read(patched(data, "ImageWidth", 33))


@pytest.mark.parametrize("missing", [1, 100])
def test_an_uncompressed_strip_that_is_too_short_is_refused(read: Read, noise: Noise, missing: int) -> None:
    data = tiff(noise(32, 32, 3), rowsperstrip=8)
    full = 8 * 32 * 3
    assert numbers(data, "StripByteCounts") == [full] * 4
    with pytest.raises(BrokenFileError, match="This TIFF file is damaged"):
        read(patched(data, "StripByteCounts", full - missing, 2))
    np.testing.assert_array_equal(read(data).pixels, noise(32, 32, 3))


def test_a_row_of_few_bits_has_fewer_bytes(read: Read) -> None:
    """Twelve bits: the sum of the strips is compared with bits, not with the bytes of what they become."""
    pixels = np.arange(6 * 10, dtype=np.uint16).reshape(6, 10) * 60
    data = tiff(pixels, photometric="minisblack", bitspersample=12, compression=None)
    assert sum(numbers(data, "StripByteCounts")) == 6 * 15
    np.testing.assert_array_equal(read(data).pixels[..., 0], pixels.astype(int) * 65535 // 4095)
    with pytest.raises(BrokenFileError, match="This TIFF file is damaged"):
        read(patched(data, "StripByteCounts", 6 * 15 - 1))


def test_a_palette_of_eight_bits_in_a_table_of_sixteen_is_read(read: Read, noise: Noise) -> None:
    """Some programs wrote 8 bits into it; 256 in the table is 1 of 16 bits."""
    indices = noise(9, 14) % 4
    table = np.zeros((3, 256), np.uint16)
    table[:, :4] = [[0, 255, 10, 200], [1, 2, 3, 4], [40, 30, 20, 255]]
    for scale in (1, 257):
        data = tiff(indices, photometric="palette", colormap=table * scale)
        np.testing.assert_array_equal(read(data).pixels, np.moveaxis(table[:, indices], 0, -1))


def test_more_channels_than_it_has_colours_for_are_refused(read: Read, noise: Noise) -> None:
    data = patched(tiff(noise(8, 8, 3)), "PhotometricInterpretation", 5)  # inks, of which it has only three
    with pytest.raises(UnsupportedFormatError, match="colours of a kind that is not supported"):
        read(data)


def test_a_volume_is_refused(read: Read, noise: Noise) -> None:
    file = io.BytesIO()
    tifffile.imwrite(file, noise(4, 16, 16), photometric="minisblack", volumetric=True, tile=(4, 16, 16), metadata=None)
    with pytest.raises(UnsupportedFormatError, match="a volume, not a picture"):
        read(file.getvalue())


def test_premultiplied_sixteen_bits_and_opaque_ones_are_exact(read: Read) -> None:
    alpha = np.array([[65535, 32768, 1, 0]], np.uint16)
    colours = np.array([[[65535, 0, 7]] * 4], np.uint16)
    premultiplied = (colours.astype(np.uint64) * alpha[..., None] // 65535).astype(np.uint16)
    data = tiff(np.concatenate([premultiplied, alpha[..., None]], axis=2), extrasamples=["assocalpha"])
    picture = read(data)
    expected = np.minimum(premultiplied.astype(np.uint64) * 65535 // np.maximum(alpha, 1)[..., None], 65535)
    np.testing.assert_array_equal(picture.pixels, expected)
    np.testing.assert_array_equal(picture.pixels[0, 0], colours[0, 0])
    alpha[:] = 65535
    opaque = tiff(np.concatenate([colours, alpha[..., None]], axis=2), extrasamples=["assocalpha"])
    np.testing.assert_array_equal(read(opaque).pixels, colours)

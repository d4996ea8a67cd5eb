"""Downloads, renditions, thumbnails and link previews show the picture they were made from, in sRGB."""

import io
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import imagecodecs
import numpy as np
import pytest
import tifffile
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image, ImageCms

from app.errors import InvalidInputError
from app.images.convert import (
    GROUND,
    Format,
    convert,
    flatten,
    make_link_preview,
    make_rendition,
    make_thumbnails,
    read_depth,
)
from app.images.decode import Limits, decode
from app.images.png_writer import encode_png

Noise = Callable[..., NDArray[Any]]
SAMPLES = Path(__file__).parents[2] / "samples"


@pytest.fixture(scope="module")
def texture() -> NDArray[np.uint8]:
    return np.ascontiguousarray(decode(SAMPLES / "soil_ground010.png", Limits()).pixels[:300, :400])


def opened(data: bytes) -> Image.Image:
    image = Image.open(io.BytesIO(data))
    image.load()
    return image


@pytest.mark.parametrize("file_format", get_args(Format))
def test_every_format_has_its_media_type_and_its_pixels(texture: NDArray[np.uint8], file_format: Format) -> None:
    data, media_type = convert(encode_png(texture), file_format)
    image = opened(data)
    assert media_type == f"image/{file_format}" == Image.MIME[image.format or ""]
    difference = abs(np.asarray(image).astype(int) - texture)
    assert difference.mean() == 0 if file_format in ("png", "tiff") else difference.mean() < 6


@pytest.mark.parametrize("file_format", ["jpeg", "webp", "tiff"])
def test_every_format_says_that_it_is_srgb(texture: NDArray[np.uint8], file_format: Format) -> None:
    profile = opened(convert(encode_png(texture), file_format)[0]).info["icc_profile"]
    assert "sRGB" in ImageCms.getProfileDescription(ImageCms.ImageCmsProfile(io.BytesIO(profile)))


def test_jpeg_keeps_colour_at_full_resolution(texture: NDArray[np.uint8]) -> None:
    image = opened(convert(encode_png(texture), "jpeg")[0])
    layer: Any = getattr(image, "layer")  # noqa: B009 -- of JPEG files only
    assert [component[1:3] for component in layer] == [(1, 1)] * 3


def smooth(channels: int, dtype: type) -> NDArray[Any]:
    """A picture that lossy formats keep well, (60, 80, C); its alpha, if it has one, goes from 0 to full."""
    y, x = np.mgrid[0:60, 0:80]
    colours = np.stack([40 + 2 * x, 220 - x - y, 60 + 2 * y], axis=-1)[..., : 1 if channels < 3 else 3]
    alpha = np.clip(x * 255 // 60, 0, 255)
    picture = colours if channels % 2 else np.dstack([colours, alpha])
    return (picture * 257).astype(np.uint16) if dtype == np.uint16 else picture.astype(np.uint8)


def on_grey(picture: NDArray[Any]) -> NDArray[np.float64]:
    """What is seen of 8 bits with alpha on mid-grey, (H, W, 1 or 3)."""
    if picture.ndim == 2 or picture.shape[2] in (1, 3):
        return picture.reshape(*picture.shape[:2], -1).astype(float)
    alpha = picture[..., -1:] / 255
    return np.asarray(picture[..., :-1] * alpha + GROUND * (1 - alpha))


@pytest.mark.parametrize("file_format", get_args(Format))
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_every_kind_of_picture_converts(file_format: Format, channels: int, dtype: type) -> None:
    """PNG and TIFF keep every number; what is seen of the others is within a few levels."""
    picture = smooth(channels, dtype)
    data = convert(encode_png(picture), file_format)[0]
    if file_format in ("png", "tiff"):
        decoded = tifffile.imread(io.BytesIO(data)) if file_format == "tiff" else imagecodecs.png_decode(data)
        assert decoded.dtype == dtype
        np.testing.assert_array_equal(decoded.reshape(picture.shape), picture)
        return
    image = opened(data)
    transparent, grey = channels % 2 == 0, channels < 3
    mode = ("L" if grey else "RGB") if file_format == "jpeg" else ("RGBA" if transparent else "RGB")
    assert image.mode == ("RGB" if file_format == "jpeg" and transparent else mode)
    seen = on_grey(np.asarray(image))
    expected = np.broadcast_to(on_grey(smooth(channels, np.uint8)), (*seen.shape[:2], 1 if grey else 3))
    difference = abs(seen - expected)
    assert difference.mean() < 2
    assert difference.max() < 12


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_flattening_lays_what_is_transparent_on_mid_grey(channels: int) -> None:
    picture = smooth(channels, np.uint8)
    flat = flatten(picture)
    assert flat.dtype == np.uint8
    assert flat.shape == (60, 80, 1 if channels < 3 else 3)
    assert abs(flat - on_grey(picture)).max() <= 1


@pytest.mark.parametrize(("channels", "longest"), [(2, None), (4, None), (1, None), (3, None), (4, 40)])
def test_a_rendition_shows_every_pixel(tmp_path: Path, channels: int, longest: int | None) -> None:
    """Exactly, where it is transparent and its size is kept; else within what JPEG and a reduced size allow."""
    for dtype in (np.uint8, np.uint16):
        (tmp_path / "picture.png").write_bytes(encode_png(smooth(channels, dtype)))
        shown = np.asarray(opened(make_rendition(tmp_path / "picture.png", longest)[0]))
        expected = smooth(channels, np.uint8)
        if longest is not None:
            assert shown.shape == (30, 40, 4)
            assert abs(on_grey(shown)[8:-8, 8:-8] - on_grey(expected[::2, ::2])[8:-8, 8:-8]).max() < 8
        elif channels in (2, 4):
            np.testing.assert_array_equal(shown, expected)
        else:
            assert abs(shown.reshape(expected.shape).astype(int) - expected).max() < 12


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_sixteen_bits_survive_in_png_and_tiff(noise: Noise, channels: int) -> None:
    pixels = noise(30, 40, channels, dtype=np.uint16)
    for given_depth in (None, 16):
        png, tiff = (convert(encode_png(pixels), each, given_depth)[0] for each in ("png", "tiff"))
        np.testing.assert_array_equal(imagecodecs.png_decode(png).reshape(pixels.shape), pixels)
        np.testing.assert_array_equal(tifffile.imread(io.BytesIO(tiff)).reshape(pixels.shape), pixels)


@pytest.mark.parametrize("file_format", ["png", "tiff"])
def test_depth_changes_when_asked_for(noise: Noise, file_format: Format) -> None:
    pixels = noise(64, 64, 3)
    deep = convert(encode_png(pixels), file_format, 16)[0]
    read = imagecodecs.png_decode if file_format == "png" else lambda data: tifffile.imread(io.BytesIO(data))
    np.testing.assert_array_equal(read(deep), pixels.astype(int) * 257)
    shallow = convert(encode_png(pixels.astype(np.uint16) * 257), file_format, 8)[0]
    np.testing.assert_array_equal(read(shallow), pixels)


def test_sixteen_bits_are_rounded_to_the_nearest_of_eight() -> None:
    every = np.arange(65536, dtype=np.uint16).reshape(256, 256)
    narrowed = imagecodecs.png_decode(convert(encode_png(every), "png", 8)[0])
    assert abs(narrowed - every / 257).max() < 0.51


def test_the_same_picture_gives_the_same_file(texture: NDArray[np.uint8]) -> None:
    for file_format in get_args(Format):
        assert convert(encode_png(texture), file_format) == convert(encode_png(texture), file_format)


def test_transparency_is_kept_where_the_format_has_it(noise: Noise) -> None:
    pixels = noise(30, 40, 4)
    pixels[:15, :, 3] = 0
    for file_format in ("png", "webp", "tiff"):
        alpha = np.asarray(opened(convert(encode_png(pixels), file_format)[0]).getchannel("A"))
        np.testing.assert_array_equal(alpha, pixels[..., 3])
    flat = np.asarray(opened(convert(encode_png(pixels), "jpeg")[0]))
    np.testing.assert_allclose(flat[:8].astype(int), 128, atol=3)


@pytest.mark.parametrize(("file_format", "side"), [("webp", 16_384), ("jpeg", 65_501)])
def test_a_format_that_is_too_small_says_so(file_format: Format, side: int) -> None:
    with pytest.raises(InvalidInputError, match="Choose PNG or TIFF"):
        convert(encode_png(np.zeros((1, side), np.uint8)), file_format)


@given(st.integers(1, 600), st.integers(1, 600), st.sampled_from([1, 64, 256]))
def test_a_rendition_fits_and_keeps_its_proportions(width: int, height: int, longest: int) -> None:
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "picture.png"
        path.write_bytes(encode_png(np.zeros((height, width), np.uint8)))
        shown = opened(make_rendition(path, longest)[0]).size
    scale = min(1, longest / max(width, height))
    assert max(shown) == min(longest, max(width, height))
    assert abs(shown[0] - width * scale) <= 1
    assert abs(shown[1] - height * scale) <= 1


def test_a_rendition_is_jpeg_or_png_if_transparent(tmp_path: Path, noise: Noise) -> None:
    for pixels, media_type in (
        (noise(40, 50, 3), "image/jpeg"),
        (noise(40, 50, 1), "image/jpeg"),
        (noise(40, 50, 3, dtype=np.uint16), "image/jpeg"),
        (noise(40, 50, 4), "image/png"),
        (noise(40, 50, 2, dtype=np.uint16), "image/png"),
    ):
        (tmp_path / "picture.png").write_bytes(encode_png(pixels))
        for longest in (None, 20):
            data, found = make_rendition(tmp_path / "picture.png", longest)
            assert found == media_type == Image.MIME[opened(data).format or ""]


def test_a_rendition_looks_like_its_picture(tmp_path: Path, texture: NDArray[np.uint8]) -> None:
    (tmp_path / "picture.png").write_bytes(encode_png(texture))
    shown = np.asarray(opened(make_rendition(tmp_path / "picture.png", 200)[0]).resize((400, 300)))
    assert abs(shown.mean((0, 1)) - texture.mean((0, 1))).max() < 2


def test_no_byte_of_metadata_comes_out(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x010E] = "48.8584 N"
    written = io.BytesIO()
    with Image.open(SAMPLES / "tiles02.png") as image:
        image.save(written, "png", exif=exif)
    (tmp_path / "picture.png").write_bytes(written.getvalue())
    assert b"48.8584" in written.getvalue()
    assert b"48.8584" not in make_rendition(tmp_path / "picture.png", 128)[0]
    for file_format in ("jpeg", "webp", "tiff"):
        assert b"48.8584" not in convert(tmp_path / "picture.png", file_format)[0]


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_the_depth_of_a_file_is_read(tmp_path: Path, dtype: type) -> None:
    (tmp_path / "picture.png").write_bytes(encode_png(smooth(3, dtype)))
    assert read_depth(tmp_path / "picture.png") == np.dtype(dtype).itemsize * 8


@pytest.mark.parametrize("file_format", get_args(Format))
def test_a_file_and_its_bytes_convert_alike(tmp_path: Path, file_format: Format) -> None:
    data = encode_png(smooth(4, np.uint16))
    (tmp_path / "picture.png").write_bytes(data)
    assert convert(tmp_path / "picture.png", file_format) == convert(data, file_format)
    if file_format == "png":
        assert convert(data, "png", 16)[0] is data  # nothing to do: not one byte changes


@pytest.mark.parametrize(("file_format", "side"), [("webp", 16_383), ("jpeg", 65_500)])
def test_the_longest_side_that_a_format_holds_is_written(file_format: Format, side: int) -> None:
    assert opened(convert(encode_png(np.zeros((1, side), np.uint8)), file_format)[0]).size == (side, 1)
    assert opened(convert(encode_png(np.zeros((side, 1), np.uint8)), file_format)[0]).size == (1, side)


def test_a_rendition_that_is_too_long_for_jpeg_is_a_png(tmp_path: Path) -> None:
    for side, media_type in ((65_500, "image/jpeg"), (65_501, "image/png")):
        (tmp_path / "picture.png").write_bytes(encode_png(np.zeros((side, 1), np.uint8)))
        assert make_rendition(tmp_path / "picture.png", None)[1] == media_type


def test_small_pictures_are_enlarged_four_times_in_a_link_preview_and_stand_in_the_middle() -> None:
    white, black = np.full((50, 40), 255, np.uint8), np.zeros((20, 60), np.uint8)
    grey = np.asarray(Image.open(io.BytesIO(make_link_preview(white, black))).convert("L")).astype(int)
    for place, top, left, height, width in ((grey > 192, 215, 385, 200, 160), (grey < 64, 275, 575, 80, 240)):
        found = np.argwhere(place)
        assert abs(found.min(0) - (top, left)).max() <= 1  # a margin of 30 between them
        assert abs(found.max(0) - (top + height - 1, left + width - 1)).max() <= 1


def test_thumbnails_have_one_scale(noise: Noise) -> None:
    crop, texture = (opened(each) for each in make_thumbnails(noise(256, 128, 3), encode_png(noise(1024, 512, 3))))
    assert (crop.size, texture.size) == ((40, 80), (160, 320))
    small = [opened(each).size for each in make_thumbnails(noise(20, 30, 1), noise(40, 10, 3, dtype=np.uint16))]
    assert small == [(30, 20), (10, 40)]


@pytest.mark.parametrize(
    ("crop", "texture"),
    [((512, 512), (512, 512)), ((64, 64), (2000, 1000)), ((30, 900), (40, 40)), ((1, 1), (4000, 1))],
)
def test_a_link_preview_has_its_size_and_both_pictures(crop: tuple[int, int], texture: tuple[int, int]) -> None:
    white, black = np.full((*crop, 3), 255, np.uint8), np.zeros(texture, np.uint8)
    sheet = opened(make_link_preview(white, encode_png(black)))
    assert (sheet.format, sheet.mode, sheet.size) == ("JPEG", "RGB", (1200, 630))
    grey = np.asarray(sheet.convert("L")).astype(int)
    assert abs(grey[:10] - 128).max() <= 3
    assert abs(grey[:, :10] - 128).max() <= 3
    assert abs(grey[:, -10:] - 128).max() <= 3
    bright, dark = np.argwhere(grey > 160), np.argwhere(grey < 96)
    assert len(bright)
    assert len(dark)
    assert bright[:, 1].max() < dark[:, 1].min()

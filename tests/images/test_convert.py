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
from app.images.convert import Format, convert, make_link_preview, make_rendition, make_thumbnails
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


@pytest.mark.parametrize("file_format", get_args(Format))
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_every_kind_of_picture_converts(noise: Noise, file_format: Format, channels: int) -> None:
    for dtype in (np.uint8, np.uint16):
        data = convert(encode_png(noise(30, 40, channels, dtype=dtype)), file_format)[0]
        decoded = tifffile.imread(io.BytesIO(data)) if file_format == "tiff" else np.asarray(opened(data))
        assert decoded.shape[:2] == (30, 40)


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

"""Uploads of animations: GIF, PNG and WebP are composed as browsers show them, with their timing at one rate."""

import io
import struct
from collections.abc import Callable
from typing import Any

import imagecodecs
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from app.errors import UnsupportedFormatError
from app.images.decode import Decoded
from tests.images.clips import VideoArray, animation, chunk, moving

Read = Callable[..., Decoded]
Noise = Callable[..., NDArray[Any]]
FORMS = {"GIF": "image/gif", "PNG": "image/apng", "WEBP": "image/webp"}


def frames_of(decoded: Decoded) -> VideoArray:
    return decoded.pixels.reshape(decoded.frames, -1, *decoded.pixels.shape[1:])


@pytest.fixture(params=FORMS)
def form(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def few_colours(noise: Noise) -> VideoArray:
    """A video that a palette holds exactly."""
    colours = noise(200, 3)
    return colours[noise(7, 30, 41, seed=1) % 200]


def test_an_animation_is_read_exactly(read: Read, few_colours: VideoArray, form: str) -> None:
    decoded = read(animation(few_colours, form))
    np.testing.assert_array_equal(frames_of(decoded), few_colours)
    assert (decoded.frames, decoded.rate, decoded.media_type) == (7, 25.0, FORMS[form])
    assert (decoded.alpha, decoded.depth, decoded.height) == (None, 8, 30)


@pytest.mark.parametrize("kind", ["transparent", "opaque"])
def test_alpha_is_kept_if_a_pixel_is_not_opaque(read: Read, few_colours: VideoArray, form: str, kind: str) -> None:
    alpha = np.full(few_colours.shape[:3], 255, np.uint8)
    if kind == "transparent":
        alpha[5, 3:9, 4:11] = 0
    film = np.concatenate([few_colours, alpha[..., None]], 3)
    decoded = read(animation(film, form, disposal=2) if form == "GIF" else animation(film, form))
    seen = frames_of(decoded)
    if kind == "opaque":
        assert decoded.alpha is None
        return
    assert decoded.alpha is not None
    np.testing.assert_array_equal(decoded.alpha.reshape(alpha.shape), alpha)
    wrong = abs(seen[alpha > 0].astype(int) - few_colours[alpha > 0])
    assert wrong.max() <= (20 if form == "GIF" else 0)  # its writer finds a palette for red, green, blue and alpha


@pytest.mark.parametrize(("form", "channels"), [("GIF", 1), ("PNG", 1), ("WEBP", 3)])
def test_grey_is_one_channel_where_the_stills_of_the_format_have_one(read: Read, form: str, channels: int) -> None:
    film = moving(5)[..., :1]
    seen = frames_of(read(animation(film, form)))
    np.testing.assert_array_equal(seen, film.repeat(channels, 3))


def test_a_gif_that_only_begins_grey_keeps_its_colours(read: Read, few_colours: VideoArray) -> None:
    few_colours[0] = few_colours[0, ..., :1]
    np.testing.assert_array_equal(frames_of(read(animation(few_colours, "GIF"))), few_colours)


def test_a_frame_shown_longer_is_repeated(read: Read, few_colours: VideoArray, form: str) -> None:
    decoded = read(animation(few_colours, form, [50, 50, 100, 50, 150, 50, 50]))
    assert decoded.rate == 20
    np.testing.assert_array_equal(frames_of(decoded), few_colours[[0, 1, 2, 2, 3, 4, 4, 4, 5, 6]])


def test_times_rounded_to_hundredths_make_no_repetition(read: Read, few_colours: VideoArray) -> None:
    decoded = read(animation(few_colours, "GIF", [30, 30, 40, 30, 30, 40, 30]))
    assert decoded.frames == 7
    assert decoded.rate == pytest.approx(7 / 0.23, abs=0.001)


def test_where_repetition_would_be_too_much_the_rate_is_the_average(read: Read, few_colours: VideoArray) -> None:
    data = animation(few_colours, "PNG", [20, 20, 1000, 20, 20, 20, 20])
    decoded = read(data, video_frames=55)
    assert (decoded.frames, decoded.rate) == (7, pytest.approx(7 / 1.12))
    assert (read(data, video_frames=56).frames, read(data, video_frames=56).rate) == (56, 50)


@pytest.mark.parametrize("duration", [0, 10])
def test_no_time_at_all_is_a_tenth_of_a_second(read: Read, few_colours: VideoArray, form: str, duration: int) -> None:
    assert read(animation(few_colours, form, duration)).rate == 10


def test_a_gif_of_one_picture_is_a_still(read: Read, few_colours: VideoArray) -> None:
    decoded = read(animation(few_colours[:1], "GIF"))
    assert (decoded.frames, decoded.rate, decoded.media_type) == (1, 0.0, "image/png")
    np.testing.assert_array_equal(decoded.pixels, few_colours[0])


def test_a_picture_that_is_not_of_the_animation_is_not_shown(read: Read, few_colours: VideoArray) -> None:
    decoded = read(animation(few_colours, "PNG", default_image=True))
    np.testing.assert_array_equal(frames_of(decoded), few_colours[1:])


@pytest.mark.parametrize(("form", "disposal"), [("GIF", 0), ("GIF", 1), ("GIF", 2), ("PNG", 0), ("PNG", 1)])
def test_frames_are_composed_whatever_is_left_of_the_one_before(
    read: Read, few_colours: VideoArray, form: str, disposal: int
) -> None:
    few_colours[:, 10:] = few_colours[0, 10:]  # encoders then write the part that changes
    decoded = read(animation(few_colours, form, disposal=disposal))
    seen = frames_of(decoded)
    alpha = np.full(seen.shape[:3], 255) if decoded.alpha is None else decoded.alpha.reshape(seen.shape[:3])
    np.testing.assert_array_equal(seen[alpha > 0], few_colours[alpha > 0])
    assert (alpha[:, :10] == 255).all()


def test_an_animation_stands_as_its_orientation_says(read: Read) -> None:
    film, exif = moving(3), Image.Exif()
    exif[0x0112] = 6
    for form in ("PNG", "WEBP"):
        np.testing.assert_array_equal(frames_of(read(animation(film, form, exif=exif))), np.rot90(film, -1, (1, 2)))


def test_the_colours_of_a_profile_become_srgb(read: Read) -> None:
    """Each frame becomes what a still picture of the same numbers and profile becomes."""
    film, profile = moving(2), imagecodecs.cms_profile("adobergb")
    seen = frames_of(read(animation(film, "PNG", icc_profile=profile)))
    still = io.BytesIO()
    Image.fromarray(film[1]).save(still, "PNG", icc_profile=profile)
    np.testing.assert_array_equal(seen[1], read(still.getvalue()).pixels)
    assert abs(seen.astype(int) - film).max() > 10


def test_an_animated_png_of_sixteen_bits_is_refused_with_advice(read: Read, noise: Noise) -> None:
    still = imagecodecs.png_encode(noise(4, 4, 3, dtype=np.uint16))
    animated = still[:33] + chunk(b"acTL", struct.pack(">II", 2, 0)) + still[33:]
    with pytest.raises(UnsupportedFormatError, match=r"with 8 bits per channel.*with 16 bits it cannot"):
        read(animated)

"""Limits of videos: each holds to the frame, whatever the file says of itself, and its message says what to do."""

import struct
from collections.abc import Callable

import numpy as np
import pytest

from app.errors import BrokenFileError, TooLargeError
from app.images.decode import Decoded
from app.images.formats.clip import ClipLimits, TimedFrame, check_clip, limit_clip
from tests.images.clips import VideoArray, animation, chunk, lossless, moving, video

Read = Callable[..., Decoded]
FRAMES, HEIGHT, WIDTH = 12, 32, 48


def mp4(film: VideoArray) -> bytes:
    return video(film)


def live(film: VideoArray) -> bytes:
    """WebM as a browser records it: neither its length nor the time it plays is said."""
    return video(film, "libvpx", form="webm", container={"live": "1"})


def gif(film: VideoArray) -> bytes:
    return animation(film, "GIF")


def apng(film: VideoArray) -> bytes:
    return animation(film, "PNG")


def webp(film: VideoArray) -> bytes:
    return animation(film, "WEBP")


Write = Callable[[VideoArray], bytes]


@pytest.fixture(params=[mp4, live, lossless, gif, apng, webp], ids=lambda write: write.__name__)
def write(request: pytest.FixtureRequest) -> Write:
    found: Write = request.param
    return found


@pytest.fixture
def data(write: Write) -> bytes:
    """Twelve frames of 48 × 32 pixels, 25 a second."""
    return write(moving(FRAMES, HEIGHT, WIDTH))


def test_as_many_frames_as_allowed_are_read_and_one_more_is_not(read: Read, data: bytes) -> None:
    assert read(data, video_frames=FRAMES).frames == FRAMES
    with pytest.raises(TooLargeError, match=f"at most {FRAMES - 1} frames.*rim it to its first {FRAMES - 1} frames"):
        read(data, video_frames=FRAMES - 1)


def test_as_many_pixels_as_allowed_are_read_and_one_more_is_not(read: Read, data: bytes) -> None:
    pixels = FRAMES * HEIGHT * WIDTH
    assert read(data, video_pixels=pixels).frames == FRAMES
    with pytest.raises(TooLargeError, match=rf"of 48 × 32 pixels.*rim it to its first {FRAMES - 1} frames"):
        read(data, video_pixels=pixels - 1)


def test_a_frame_has_no_more_pixels_than_a_picture_may(read: Read, data: bytes) -> None:
    assert read(data, pixels=HEIGHT * WIDTH).frames == FRAMES
    with pytest.raises((TooLargeError, BrokenFileError), match=r"32 pixels \(0\.0 megapixels\)|This video is damaged"):
        read(data, pixels=HEIGHT * WIDTH - 1)


def test_a_video_plays_as_long_as_allowed_and_no_longer(read: Read, data: bytes) -> None:
    """What says nothing of its length is measured up to the start of its last frame."""
    assert read(data, video_seconds=FRAMES / 25 + 0.001).frames == FRAMES
    with pytest.raises(TooLargeError, match=r"at most 12 frames|at most .* seconds"):
        read(data, video_seconds=(FRAMES - 1) / 25 - 0.001)


def test_more_bytes_than_allowed_are_refused(read: Read, data: bytes) -> None:
    with pytest.raises(TooLargeError, match="the video smaller or shorter"):
        read(data, bytes=len(data) - 1)


def test_an_mp4_that_says_it_is_shorter_than_it_is_is_found_out(read: Read) -> None:
    data = bytearray(mp4(moving(FRAMES)).replace(b"edts", b"free"))
    for name, at in ((b"mvhd", 20), (b"tkhd", 24), (b"mdhd", 20)):
        place = data.index(name) + at
        data[place : place + 4] = struct.pack(">I", 1)
    for limits in ({"video_frames": FRAMES - 1}, {"video_pixels": 48 * 64 * (FRAMES - 1)}):
        with pytest.raises(TooLargeError, match="rim it to its first 11 frames"):
            read(bytes(data), **limits)


def test_a_video_that_says_it_is_endless_is_refused_at_once(read: Read) -> None:
    data = bytearray(mp4(moving(3)).replace(b"edts", b"free"))
    at = data.index(b"stts") + 16  # how long each frame is shown
    data[at : at + 4] = struct.pack(">I", 0x7FFFFFFF)
    with pytest.raises(TooLargeError, match="at most 600 frames, 60 seconds"):
        read(bytes(data))


@pytest.mark.parametrize(
    "header",
    [
        b"GIF89a" + struct.pack("<HHBBB", 65_535, 65_535, 0, 0, 0),
        b"RIFF"
        + struct.pack("<I", 30)
        + b"WEBPVP8X"
        + struct.pack("<I", 10)
        + b"\2\0\0\0"
        + b"\xff\x3f\0" * 2
        + b"ANIM" * 3,
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", 16_384, 16_384, 8, 2, 0, 0, 0))
        + chunk(b"acTL", struct.pack(">II", 2, 0))
        + chunk(b"IEND", b""),
    ],
    ids=["gif", "webp", "png"],
)
def test_a_huge_size_is_refused_by_the_header_alone(read: Read, header: bytes) -> None:
    with pytest.raises(TooLargeError, match="megapixels are accepted"):
        read(header)


@pytest.mark.parametrize("form", ["mp4", "webm"])
def test_a_container_that_claims_a_huge_picture_costs_nothing(read: Read, form: str) -> None:
    """Its picture is as large as the coded frames say; who believes the container refuses it."""
    film = moving(3)
    if form == "mp4":
        data = bytearray(mp4(film))
        at = data.index(b"avc1", data.index(b"stsd")) + 28
        assert data[at : at + 4] == struct.pack(">HH", 64, 48)
        data[at : at + 4] = struct.pack(">HH", 16_384, 16_384)
    else:
        data = bytearray(lossless(film))
        at = data.index(b"\xb0\x81\x40\xba\x81\x30")
        data[at : at + 6] = b"\xb0\x81\xff\xba\x81\xff"
    try:
        decoded = read(bytes(data))
    except (TooLargeError, BrokenFileError):
        return
    assert decoded.pixels.size <= 4 * film.size


def test_an_endless_gif_is_refused_before_it_ends(read: Read) -> None:
    """Half a million frames in 9 MB; going through them all would take minutes."""
    frame = b"!\xf9\4\0\4\0\0\0,\0\0\0\0\1\0\1\0\0\2\2\x4c\1\0"
    start = b"GIF89a" + struct.pack("<HHBBB", 1, 1, 0x80, 0, 0) + bytes(6)
    with pytest.raises(TooLargeError, match="at least 601 frames"):
        read(start + frame * 400_000 + b";")


def test_a_bomb_of_flat_frames_is_refused_by_its_pixels(read: Read) -> None:
    flat = np.zeros((40, 500, 500, 3), np.uint8)
    flat[::2] += 1
    data = animation(flat, "PNG")
    assert len(data) < flat.size / 100
    with pytest.raises(TooLargeError, match="megapixels"):
        read(data, video_pixels=1_000_000)


@pytest.mark.parametrize(
    ("found", "advice"),
    [
        (
            (1920, 1080, 1800, 60.0),
            "Trim it to its first 129 frames (4.3 seconds), or scale it to 891 × 501 pixels and",
        ),
        ((320, 240, 1800, 60.0), "Trim it to its first 600 frames (20.0 seconds), and upload it again."),
        ((320, 240, 100, 100.0), "Trim it to its first 60 frames (60.0 seconds), and upload it again."),
        (
            (1920, 1080, 200, 8.0),
            "Trim it to its first 129 frames (5.2 seconds), or scale it to 1544 × 868 pixels, and",
        ),
    ],
)
def test_the_message_says_how_much_is_accepted(found: tuple[int, int, int, float], advice: str) -> None:
    limits = ClipLimits(frames=600, seconds=60, pixels=1 << 28)
    with pytest.raises(TooLargeError, match="The video has") as refusal:
        check_clip(*found, limits)
    assert "at most 600 frames, 60 seconds and 268.4 megapixels" in refusal.value.message
    assert advice in refusal.value.message


def test_what_the_message_advises_is_accepted() -> None:
    limits = ClipLimits(frames=600, seconds=60, pixels=1 << 28)
    check_clip(1920, 1080, 129, 4.3, limits)
    check_clip(891, 501, 600, 20.0, limits)
    check_clip(1544, 868, 200, 8.0, limits)


def test_a_clip_plays_from_its_first_frame_on() -> None:
    """Its clock may start anywhere: only what lies between the frames counts."""
    picture = np.zeros((4, 5, 3), np.uint8)
    frames = [TimedFrame(picture, 1000.0 + seconds) for seconds in (0.0, 1.0, 2.0, 2.5)]
    limits = ClipLimits(frames=4, seconds=2, pixels=1000)
    assert list(limit_clip(iter(frames[:3]), limits)) == frames[:3]
    passed = limit_clip(iter(frames), limits)
    assert [next(passed).seconds for _ in range(3)] == [1000.0, 1001.0, 1002.0]
    with pytest.raises(TooLargeError, match="at least 4 frames"):
        next(passed)

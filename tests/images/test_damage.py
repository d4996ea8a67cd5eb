"""Damaged videos: truncated, altered or inconsistent, each is read or refused in words, and harms nothing."""

import io
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import av
import numpy as np
import psutil
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.errors import AppError, BrokenFileError, TooLargeError
from app.images.crop import Frames, Rectangle
from app.images.decode import Decoded, Limits, decode
from app.images.intake import client as module
from app.images.intake.client import take_in
from app.images.stored_video import read_frames
from app.settings import ROOT
from tests.images.clips import FULL, animation, lossless, moving, video
from tests.profiles import examples

pytestmark = pytest.mark.slow

Read = Callable[..., Decoded]
CLIP = moving(8)
WRITERS: dict[str, Callable[[], bytes]] = {
    "mp4": lambda: video(CLIP),
    "mov": lambda: video(CLIP, form="mov", options={"bf": "0", "g": "3"}),
    "fragments": lambda: video(CLIP, options={"g": "2"}, container={"movflags": "frag_keyframe+empty_moov"}),
    "vp8": lambda: video(CLIP, "libvpx", form="webm"),
    "vp9": lambda: lossless(CLIP),
    "av1": lambda: video(CLIP, "libsvtav1", form="webm", options={"preset": "12"}),
    "mkv": lambda: video(CLIP, form="matroska"),
    "gif": lambda: animation(CLIP, "GIF"),
    "png": lambda: animation(CLIP, "PNG"),
    "webp": lambda: animation(CLIP, "WEBP"),
}


@pytest.fixture(scope="module")
def files() -> dict[str, bytes]:
    return {name: write() for name, write in WRITERS.items()}


@pytest.fixture
def directory(tmp_path: Path) -> Path:
    (tmp_path / "kept").mkdir()
    return tmp_path / "kept"


@pytest.fixture(scope="module", autouse=True)
def _stopped() -> Iterator[None]:
    yield
    module.server.stop()


@pytest.mark.parametrize("name", WRITERS)
def test_what_is_stored_is_the_strip_of_what_is_decoded(
    tmp_path: Path, directory: Path, files: dict[str, bytes], name: str
) -> None:
    (tmp_path / "upload").write_bytes(files[name])
    stored, decoded = take_in(tmp_path / "upload", directory, Limits()), decode(tmp_path / "upload", Limits())
    assert (stored.width, stored.height, stored.frames, stored.depth) == (64, 48, 8, 8)
    assert (stored.rate, stored.media_type, stored.channels) == (decoded.rate, decoded.media_type, 3)
    strip = read_frames(stored.path, Rectangle(0, 0, 64, 48), Frames(0, 8), 48)
    np.testing.assert_array_equal(strip.reshape(decoded.pixels.shape), decoded.pixels)
    assert list(directory.iterdir()) == [stored.path]


@pytest.mark.parametrize("name", [name for name in WRITERS if name != "fragments"])
def test_a_truncated_video_is_refused_wherever_it_ends(read: Read, files: dict[str, bytes], name: str) -> None:
    data = files[name]
    for end in np.linspace(16, len(data) - 1, 40).astype(int):
        with pytest.raises(BrokenFileError, match="damaged or incomplete"):
            read(data[:end])


def test_a_truncated_fragment_is_refused_and_the_whole_ones_before_it_are_not(
    read: Read, files: dict[str, bytes]
) -> None:
    """A recording that ends between two fragments is a shorter one: nothing in it says that more came."""
    data = files["fragments"]
    borders = [at - 4 for at in range(len(data)) if data[at : at + 4] in (b"moof", b"mfra")]
    assert len(borders) >= 4
    assert [read(data[:border]).frames for border in borders[1:4]] == [2, 4, 6]
    for border in borders[1:]:
        for end in (border - 1, border + 9):
            with pytest.raises(BrokenFileError, match="This video is damaged"):
                read(data[:end])


@pytest.mark.parametrize("name", WRITERS)
@settings(max_examples=examples(40), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damaged_videos_are_read_or_refused_and_harm_nothing(
    tmp_path: Path, directory: Path, files: dict[str, bytes], name: str, data: st.DataObject
) -> None:
    content = bytearray(files[name])
    for _ in range(data.draw(st.integers(1, 4))):
        # Headers come first, or last in an MP4 file, and are where damage does most.
        end = len(content) - 1
        at = data.draw(st.one_of(st.integers(0, 300), st.integers(0, end), st.integers(max(0, end - 900), end)))
        change = data.draw(st.binary(min_size=1, max_size=6))
        content[at : at + len(change)] = change
    (tmp_path / "upload").write_bytes(content)
    try:
        stored = take_in(
            tmp_path / "upload", directory, Limits(pixels=1_000_000, video_pixels=1 << 22, seconds=10, memory=512 << 20)
        )
    except AppError:
        assert not list(directory.iterdir())
    else:
        assert decode(stored.path, Limits()).pixels.shape == (
            stored.height * stored.frames,
            stored.width,
            stored.channels,
        )
        stored.path.unlink()


def test_frames_that_change_their_size_are_refused(read: Read) -> None:
    joined = io.BytesIO()
    with av.open(joined, "w", format="webm") as target:
        track = None
        for part, size in enumerate(((48, 64), (64, 96))):
            with av.open(io.BytesIO(lossless(moving(3, *size)))) as source:
                if track is None:
                    track = target.add_stream_from_template(source.streams.video[0])
                for packet in source.demux(video=0):
                    if packet.dts is not None:
                        packet.pts = (packet.pts or 0) + part * 120
                        packet.dts += part * 120
                        packet.stream = track
                        target.mux(packet)
    with pytest.raises(BrokenFileError, match="do not all have the same size"):
        read(joined.getvalue())


def test_a_gif_whose_picture_lies_outside_it_is_read_or_refused(read: Read, files: dict[str, bytes]) -> None:
    data = bytearray(files["gif"])
    at = data.rindex(b",\0\0\0\0@\0000\0")
    data[at + 1] = 200
    with pytest.raises(BrokenFileError, match="This GIF file is damaged"):
        read(bytes(data))


def test_nothing_is_said_on_standard_error(tmp_path: Path, files: dict[str, bytes]) -> None:
    for name, data in files.items():
        (tmp_path / name).write_bytes(data[:700] + bytes(50) + data[750:])
    program = f"""
from pathlib import Path
from app.errors import AppError
from app.images.decode import Limits, decode
for path in sorted(Path({str(tmp_path)!r}).iterdir()):
    try:
        decode(path, Limits())
    except AppError:
        print(path.name)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT)
    assert done.stderr == ""
    assert {"mov", "mp4", "png"} <= {*done.stdout.split()}  # not every format can tell


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A video of 83 megapixels: 0.15 seconds of decoding on a fast machine, more on others."""
    path = tmp_path_factory.mktemp("large") / "upload"
    flat = np.zeros((40, 1080, 1920, 1), np.uint8)
    path.write_bytes(video(flat, colours=FULL, options={"preset": "ultrafast", "g": "1"}))
    return path


def test_a_video_that_takes_too_long_is_killed(
    large: Path, tmp_path: Path, directory: Path, files: dict[str, bytes]
) -> None:
    (tmp_path / "upload").write_bytes(files["mp4"])
    take_in(tmp_path / "upload", directory, Limits()).path.unlink()  # the server runs: its start is not what is late
    with pytest.raises(TooLargeError, match=r"more than the 0\.01 seconds"):
        take_in(large, directory, Limits(seconds=0.01))
    assert not list(directory.iterdir())
    assert module.server._process is not None
    assert not psutil.Process(module.server._process.pid).children()


def test_a_video_that_takes_too_much_memory_is_refused(large: Path, directory: Path) -> None:
    # FFmpeg itself sometimes takes a lack of memory in one of its threads for damage.
    with pytest.raises((TooLargeError, BrokenFileError), match=r"more than the 32 MB of memory|This video is damaged"):
        take_in(large, directory, Limits(memory=32 << 20))
    assert not list(directory.iterdir())


def test_the_server_still_forks_from_a_single_thread_after_videos(
    tmp_path: Path, directory: Path, files: dict[str, bytes]
) -> None:
    (tmp_path / "upload").write_bytes(files["mp4"])
    take_in(tmp_path / "upload", directory, Limits())
    assert module.server._process is not None
    assert psutil.Process(module.server._process.pid).num_threads() == 1

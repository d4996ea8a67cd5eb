"""Taking uploads in: what is stored, and that no file can take more time, memory or processes than it may."""

import io
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import imagecodecs
import numpy as np
import psutil
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from app.errors import AppError, BrokenFileError, BusyError, TooLargeError, UnsupportedFormatError
from app.images.decode import Limits, decode
from app.images.intake import client as module
from app.images.intake.client import take_in
from tests.profiles import examples

Noise = Callable[..., NDArray[Any]]
SAMPLES = Path(__file__).parents[3] / "samples"
PATIENCE = 30.0


@pytest.fixture
def directory(tmp_path: Path) -> Path:
    (tmp_path / "kept").mkdir()
    return tmp_path / "kept"


@pytest.fixture
def slow(tmp_path: Path, slow_jpeg: bytes) -> Path:
    path = tmp_path / "slow"
    path.write_bytes(slow_jpeg)
    return path


@pytest.fixture(scope="module", autouse=True)
def _stopped() -> Iterator[None]:
    yield
    module.server.stop()


def until(condition: Callable[[], Any]) -> Any:
    """Wait for a condition without taking the processor from those it depends on."""
    end = time.monotonic() + PATIENCE
    pause = threading.Event()
    while not (value := condition()):
        assert time.monotonic() < end, "it never came true"
        pause.wait(0.01)
    return value


def server_process() -> psutil.Process:
    module.server.start()
    assert module.server._process is not None
    return psutil.Process(module.server._process.pid)


@pytest.mark.parametrize("name", ["scene_china.jpg", "gravel_gray.png", "tiles02.png", "bark_fir.png"])
def test_a_photograph_is_stored_as_a_png_of_the_pixels_that_were_decoded(directory: Path, name: str) -> None:
    stored = take_in(SAMPLES / name, directory, Limits())
    picture = decode(SAMPLES / name, Limits())
    assert list(directory.iterdir()) == [stored.path]
    assert (stored.height, stored.width, stored.channels) == picture.pixels.shape
    assert (stored.depth, stored.transparent) == (8, False)
    np.testing.assert_array_equal(decode(stored.path, Limits()).pixels, picture.pixels)


def test_sixteen_bits_and_transparency_are_stored(tmp_path: Path, directory: Path, noise: Noise) -> None:
    pixels = noise(40, 30, 4, dtype=np.uint16)
    (tmp_path / "upload").write_bytes(imagecodecs.png_encode(pixels))
    stored = take_in(tmp_path / "upload", directory, Limits())
    assert (stored.width, stored.height, stored.channels, stored.depth, stored.transparent) == (30, 40, 3, 16, True)
    np.testing.assert_array_equal(imagecodecs.png_decode(stored.path.read_bytes()), pixels)


def test_no_byte_of_the_metadata_is_stored(tmp_path: Path, directory: Path) -> None:
    secret = b"48.8584 N 2.2945 E"
    exif = Image.Exif()
    exif.get_ifd(0x8825)[29] = secret.decode()  # GPSDateStamp, a text
    exif[0x010E] = secret.decode()  # ImageDescription
    for file_format in ("jpeg", "png", "webp", "tiff"):
        written = io.BytesIO()
        with Image.open(SAMPLES / "tiles02.png") as image:
            image.save(written, file_format, exif=exif, xmp=b"<x>" + secret + b"</x>", comment=secret)
        (tmp_path / "upload").write_bytes(written.getvalue() + secret)
        assert secret in written.getvalue()
        data = take_in(tmp_path / "upload", directory, Limits()).path.read_bytes()
        assert secret not in data
        names, at = [], 8
        while at < len(data):
            names.append(data[at + 4 : at + 8])
            at += 12 + int.from_bytes(data[at : at + 4], "big")
        assert set(names) == {b"IHDR", b"sRGB", b"stRP", b"IDAT", b"IEND"}


def test_the_server_forks_from_a_single_thread(directory: Path) -> None:
    take_in(SAMPLES / "tiles02.png", directory, Limits())
    assert server_process().num_threads() == 1


def test_those_who_wait_too_long_for_their_turn_are_told(directory: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_turn", threading.BoundedSemaphore(1))
    monkeypatch.setattr(module, "WAIT_SECONDS", 0.01)
    with module._turn, pytest.raises(BusyError, match="Try again"):
        take_in(SAMPLES / "tiles02.png", directory, Limits())


@pytest.mark.parametrize(
    ("content", "error", "words"),
    [
        (b"", BrokenFileError, "The file is empty"),
        (b"GIF89a", BrokenFileError, "This GIF file is damaged"),
        (b"BM", UnsupportedFormatError, "a BMP picture"),
        (b"\x89PNG\r\n\x1a\n", BrokenFileError, "This PNG file is damaged"),
    ],
)
def test_a_refusal_leaves_no_file(
    tmp_path: Path, directory: Path, content: bytes, error: type[AppError], words: str
) -> None:
    (tmp_path / "upload").write_bytes(content)
    with pytest.raises(error, match=words):
        take_in(tmp_path / "upload", directory, Limits())
    assert not list(directory.iterdir())


def test_a_picture_that_takes_too_long_is_killed(slow: Path, directory: Path) -> None:
    take_in(SAMPLES / "tiles02.png", directory, Limits())
    with pytest.raises(TooLargeError, match=r"more than the 0\.05 seconds"):
        take_in(slow, directory, Limits(seconds=0.05))
    assert len(list(directory.iterdir())) == 1
    assert not server_process().children()


@pytest.mark.slow
def test_a_bomb_that_takes_too_much_memory_is_refused(
    tmp_path: Path, directory: Path, png_saying: Callable[..., bytes]
) -> None:
    (tmp_path / "bomb").write_bytes(png_saying(6000, 6000, 8, 2, bytes(6000 * 18001)))
    with pytest.raises(TooLargeError, match="more than the 64 MB of memory"):
        take_in(tmp_path / "bomb", directory, Limits(memory=64 << 20))
    assert not list(directory.iterdir())


def test_several_are_taken_in_at_once(tmp_path: Path, directory: Path, noise: Noise) -> None:
    uploads = []
    for number in range(12):
        uploads.append(tmp_path / f"upload{number}")
        Image.fromarray(noise(20 + number, 30, 3)).save(uploads[-1], "png")
    with ThreadPoolExecutor(12) as pool:
        stored = list(pool.map(lambda upload: take_in(upload, directory, Limits()), uploads))
    assert [each.height for each in stored] == list(range(20, 32))
    assert len({each.path for each in stored}) == 12


def test_a_slow_picture_does_not_hold_up_the_others_and_a_crash_is_told(slow: Path, directory: Path) -> None:
    with ThreadPoolExecutor(1) as pool:
        hopeless = pool.submit(take_in, slow, directory, Limits(seconds=60))
        decoder = until(server_process().children)[0]
        decoder.suspend()  # so that it cannot end by itself, however fast the machine
        take_in(SAMPLES / "tiles02.png", directory, Limits())
        assert not hopeless.done()
        decoder.kill()
        with pytest.raises(BrokenFileError, match="decoder failed"):
            hopeless.result()


def test_a_killed_server_is_started_again_and_its_children_die_with_it(slow: Path, directory: Path) -> None:
    with ThreadPoolExecutor(1) as pool:
        hopeless = pool.submit(take_in, slow, directory, Limits(seconds=60))
        first = server_process()
        decoder = until(first.children)[0]
        first.kill()
        until(lambda: not decoder.is_running() or decoder.status() == psutil.STATUS_ZOMBIE)
        # The picture is tried once more, by a new server.
        until(lambda: server_process().children())[0].kill()
        with pytest.raises(BrokenFileError, match="decoder failed"):
            hopeless.result()
    assert server_process().pid != first.pid
    server_process().kill()
    assert take_in(SAMPLES / "tiles02.png", directory, Limits()).width == 256


@pytest.mark.slow
def test_nothing_outlives_a_killed_parent(slow: Path, directory: Path) -> None:
    program = f"""
from pathlib import Path
from app.images.decode import Limits
from app.images.intake.client import take_in
take_in(Path({str(slow)!r}), Path({str(directory)!r}), Limits(seconds=60))
"""
    parent = subprocess.Popen([sys.executable, "-c", program], start_new_session=True)
    try:
        process = psutil.Process(parent.pid)
        family = until(lambda: len(found := process.children(recursive=True)) == 2 and found)
    finally:
        parent.kill()
        parent.wait()
    assert not psutil.wait_procs(family, timeout=PATIENCE)[1]


def test_the_main_module_is_not_run_again(tmp_path: Path, directory: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(f"""
from pathlib import Path
with open({str(tmp_path / "runs")!r}, "a") as runs:
    runs.write("run")
from app.images.decode import Limits
from app.images.intake.client import take_in
for _ in range(3):
    take_in(Path({str(SAMPLES / "tiles02.png")!r}), Path({str(directory)!r}), Limits())
""")
    subprocess.run([sys.executable, program], check=True)
    assert (tmp_path / "runs").read_text() == "run"
    assert len(list(directory.iterdir())) == 3


@pytest.fixture(scope="module")
def files() -> dict[str, bytes]:
    """A small photograph with metadata and a profile in every format."""
    exif = Image.Exif()
    exif[0x0112] = 6
    written = {}
    with Image.open(SAMPLES / "scene_china.jpg") as photograph:
        for file_format in ("png", "jpeg", "webp", "tiff"):
            file = io.BytesIO()
            small = photograph.resize((40, 30))
            small.save(file, file_format, exif=exif, icc_profile=imagecodecs.cms_profile("srgb"))
            written[file_format] = file.getvalue()
    return written


@pytest.mark.slow
@pytest.mark.parametrize("file_format", ["png", "jpeg", "webp", "tiff"])
@settings(max_examples=examples(25), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damaged_files_are_read_or_refused_and_harm_nothing(
    tmp_path: Path, directory: Path, files: dict[str, bytes], file_format: str, data: st.DataObject
) -> None:
    content = bytearray(files[file_format])
    for _ in range(data.draw(st.integers(1, 4))):
        # Headers come first, and are where damage does most.
        at = data.draw(st.one_of(st.integers(0, 200), st.integers(0, len(content) - 1)))
        change = data.draw(st.binary(min_size=1, max_size=6))
        content[at : at + len(change)] = change
    content = content[: data.draw(st.one_of(st.just(len(content)), st.integers(0, len(content))))]
    (tmp_path / "upload").write_bytes(content)
    try:
        stored = take_in(tmp_path / "upload", directory, Limits(pixels=1_000_000, seconds=5, memory=512 << 20))
    except AppError:
        assert not list(directory.iterdir())
    else:
        assert decode(stored.path, Limits()).pixels.shape == (stored.height, stored.width, stored.channels)
        stored.path.unlink()

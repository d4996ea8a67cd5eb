"""Files for the decoders to read, made on the fly."""

import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from app.images.decode import Decoded, Limits, decode
from tests.images.clips import chunk

Picture = NDArray[np.unsignedinteger]


@pytest.fixture
def read(tmp_path: Path) -> Callable[..., Decoded]:
    """Decode bytes that come in a file with a meaningless name."""

    def run(data: bytes, **limits: Any) -> Decoded:
        path = tmp_path / "upload.tmp"
        path.write_bytes(data)
        return decode(path, Limits(**limits))

    return run


@pytest.fixture(scope="session")
def noise() -> Callable[..., Picture]:
    def make(*shape: int, dtype: Any = np.uint8, seed: int = 0) -> Any:
        return np.random.default_rng(seed).integers(0, np.iinfo(dtype).max, shape, dtype=dtype, endpoint=True)

    return make


@pytest.fixture(scope="session")
def photograph() -> NDArray[np.uint8]:
    """A smooth picture whose four corners differ, so that JPEG keeps it well and no orientation looks like another."""
    y, x = np.mgrid[0:48, 0:80]
    return np.stack([x * 3, y * 5, 255 - x - y], axis=-1).astype(np.uint8)


@pytest.fixture(scope="session")
def png_saying() -> Callable[..., bytes]:
    """A PNG file whose header may say anything about its pixels."""

    def make(width: int, height: int, depth: int, colour: int, rows: bytes, interlaced: int = 0) -> bytes:
        header = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlaced)
        chunks = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
        return b"\x89PNG\r\n\x1a\n" + chunks

    return make


@pytest.fixture(scope="session")
def slow_jpeg() -> bytes:
    """A progressive JPEG of 0.2 MB with 5,000 scans over 36 megapixels: some ten seconds in every decoder."""
    side, blocks = 6000, 750 * 750
    zeros = bytes((blocks + 7) // 8)  # one bit a block: its mean is that of the block before
    run = "0" + "1" * 14  # "nothing in the next 32767 blocks"
    bits = run * (blocks // 32767 + 1)
    bits += "1" * (-len(bits) % 8)
    empty = int(bits, 2).to_bytes(len(bits) // 8, "big").replace(b"\xff", b"\xff\0")

    def segment(marker: int, content: bytes) -> bytes:
        return struct.pack(">BBH", 0xFF, marker, len(content) + 2) + content

    def table(kind: int, symbol: int) -> bytes:
        return segment(0xC4, bytes([kind, 1, *[0] * 15, symbol]))

    frame = segment(0xC2, struct.pack(">BHHBBBB", 8, side, side, 1, 1, 0x11, 0))
    scan = segment(0xDA, bytes([1, 1, 0, 1, 1, 0])) + empty
    first = segment(0xDA, bytes([1, 1, 0, 0, 0, 0])) + zeros
    quantisation = segment(0xDB, bytes([0, *[1] * 64]))
    return b"\xff\xd8" + quantisation + frame + table(0x00, 0) + table(0x10, 0xE0) + first + scan * 5000 + b"\xff\xd9"

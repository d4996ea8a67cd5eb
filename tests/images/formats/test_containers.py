"""Containers of videos: recognised by their first bytes, and complete or not by the lengths of their parts."""

import struct
from collections.abc import Callable

import numpy as np
import pytest

from app.errors import BrokenFileError
from app.images.decode import Decoded
from app.images.formats.containers import Container, identify_container
from tests.images.clips import lossless, moving, video

Read = Callable[..., Decoded]


def box(name: bytes, content: bytes = b"", size: int | None = None) -> bytes:
    """A box of an MP4 file; ``size`` is what its header says, if that is not the truth."""
    return struct.pack(">I", 8 + len(content) if size is None else size) + name + content


def long_box(name: bytes, content: bytes = b"", size: int | None = None) -> bytes:
    """A box whose size has 64 bits."""
    return struct.pack(">I4sQ", 1, name, 16 + len(content) if size is None else size) + content


def element(name: str, content: bytes = b"", size: str | None = None) -> bytes:
    """An EBML element; ``size`` is its length as it is coded, in hexadecimal digits."""
    return bytes.fromhex(name) + (bytes([0x80 | len(content)]) if size is None else bytes.fromhex(size)) + content


FTYP = box(b"ftyp", b"isom" + bytes(4))
HEADER = element("1A45DFA3", element("4282", b"webm"))
UNKNOWN_1, UNKNOWN_8 = "FF", "01FFFFFFFFFFFFFF"


@pytest.mark.parametrize(
    ("rest", "whole"),
    [
        (b"", True),
        (box(b"mdat", bytes(5)), True),
        (box(b"mdat", bytes(5)) + bytes(7), True),  # less than a box after the last one
        (box(b"mdat", bytes(5), size=14), False),  # one byte too few
        (box(b"mdat", bytes(5), size=12), True),  # the byte too much is no box
        (box(b"mdat", bytes(5), size=0), True),  # to the end of the file
        (box(b"mdat", bytes(40), size=0), True),
        (box(b"mdat", bytes(40), size=8), True),  # the zeros after it are a last box
        *((box(b"mdat", bytes(40), size=size), False) for size in (2, 4, 7)),
        # What comes after so few bytes would be a box up to the end of the file.
        (box(bytes(4), bytes(8), size=4), False),
        (long_box(bytes(4), bytes(8), size=4), False),
        (long_box(b"mdat", bytes(5)), True),
        (long_box(b"mdat", bytes(5), size=22), False),
        (long_box(b"mdat", bytes(5)) + box(b"moov", bytes(3)), True),
        (long_box(b"mdat", bytes(5)) + box(b"moov", bytes(3), size=12), False),
        (long_box(b"mdat", bytes(5), size=1 << 40), False),
        (long_box(b"mdat", bytes(5), size=7), False),
        (long_box(b"mdat", bytes(5), size=0), True),
    ],
)
def test_an_mp4_is_whole_if_its_boxes_end_where_it_ends(rest: bytes, whole: bool) -> None:
    assert identify_container(FTYP + rest) == Container("mov", "video/mp4", whole)


@pytest.mark.parametrize(
    ("start", "media_type"),
    [
        (box(b"ftyp", b"isom"), "video/mp4"),
        (box(b"ftyp", b"mp42"), "video/mp4"),
        (box(b"ftyp", b"qt  "), "video/quicktime"),
        *((box(name, b"isom"), "video/quicktime") for name in (b"moov", b"mdat", b"wide", b"free", b"skip", b"pnot")),
    ],
)
def test_mp4_and_quicktime_are_told_by_the_first_box(start: bytes, media_type: str) -> None:
    assert identify_container(start) == Container("mov", media_type, True)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x1a\x45\xdf",
        box(b"uuid", b"isom"),
        *(box(b"ftyp", brand) for brand in (b"heic", b"heix", b"heim", b"heis", b"hevc", b"mif1", b"msf1", b"avif")),
        box(b"ftyp", b"avis"),
    ],
)
def test_stills_and_other_files_are_no_videos(data: bytes) -> None:
    assert identify_container(data) is None


@pytest.mark.parametrize(
    ("data", "media_type", "whole"),
    [
        (HEADER + element("18538067", bytes(9)), "video/webm", True),
        (element("1A45DFA3", element("4282", b"matroska")) + element("18538067"), "video/x-matroska", True),
        (element("1A45DFA3", element("4287", b"webm")) + element("18538067"), "video/x-matroska", True),
        (HEADER, "video/webm", False),  # no segment
        (HEADER + element("18538067", bytes(9), size="8A"), "video/webm", False),  # one byte too few
        (HEADER + element("18538067", bytes(9), size=UNKNOWN_1), "video/webm", True),
        (HEADER + element("18538067", bytes(9), size=UNKNOWN_8), "video/webm", True),
        (HEADER + element("18538067", bytes(9), size="4009"), "video/webm", True),  # its length has two bytes
        (HEADER + element("18538067", bytes(9), size="400A"), "video/webm", False),
        (HEADER + bytes.fromhex("18538067"), "video/webm", False),  # cut within the head of the segment
        (HEADER + bytes.fromhex("1853806740"), "video/webm", False),
        (HEADER + bytes.fromhex("1853806700"), "video/webm", False),  # no length
    ],
)
def test_a_matroska_file_is_whole_if_its_segment_is(data: bytes, media_type: str, whole: bool) -> None:
    assert identify_container(data) == Container("matroska", media_type, whole)


def boxes(data: bytes) -> list[tuple[int, bytes]]:
    """Where each box of an MP4 file begins, and its name."""
    found, at = [], 0
    while at < len(data):
        found.append((at, data[at + 4 : at + 8]))
        at += int.from_bytes(data[at : at + 4], "big")
    return found


def test_a_last_box_without_a_size_and_a_size_of_64_bits_are_read(read: Read) -> None:
    data = video(moving(4))
    at, names = [at for at, _ in boxes(data)], [name for _, name in boxes(data)]
    assert names == [b"ftyp", b"free", b"mdat", b"moov"]
    expected = read(data).pixels
    open_ended = data[: at[3]] + bytes(4) + data[at[3] + 4 :]
    np.testing.assert_array_equal(read(open_ended).pixels, expected)
    assert at[2] - at[1] == 8  # the empty box before makes room for the longer head
    wide = data[: at[1]] + struct.pack(">I4sQ", 1, b"mdat", at[3] - at[1]) + data[at[2] + 8 :]
    np.testing.assert_array_equal(read(wide).pixels, expected)


@pytest.mark.parametrize("size", [2, 7])
def test_a_box_shorter_than_its_head_is_refused(read: Read, size: int) -> None:
    """The decoder itself reads such a file: the box that is wrong comes after all that it needs."""
    data = video(moving(4))
    assert read(data + box(b"free", bytes(8))).frames == 4
    with pytest.raises(BrokenFileError, match="This video is damaged"):
        read(data + box(b"free", bytes(8), size=size))


def test_a_webm_that_ends_before_its_segment_does_is_refused(read: Read) -> None:
    data = lossless(moving(4))
    with pytest.raises(BrokenFileError, match="This video is damaged"):
        read(data[:-1])

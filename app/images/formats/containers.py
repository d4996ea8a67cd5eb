"""Containers of videos: recognises MP4, QuickTime, WebM and Matroska by content, and whether a file is complete.

Both kinds are made of parts that begin with their length: ISO base media boxes, and EBML elements.
"""

from collections.abc import Iterator
from dataclasses import dataclass

EBML, SEGMENT, DOCUMENT_TYPE = 0x1A45DFA3, 0x18538067, 0x4282
BOXES = (
    b"ftyp",
    b"moov",
    b"mdat",
    b"wide",
    b"free",
    b"skip",
    b"pnot",
)  # first box; all but ftyp in old QuickTime files only
STILLS = (b"heic", b"heix", b"heim", b"heis", b"hevc", b"mif1", b"msf1", b"avif", b"avis")


@dataclass(frozen=True)
class Container:
    """A container: ``demuxer`` is FFmpeg's name of it, ``whole`` whether the file is as long as its parts say."""

    demuxer: str
    media_type: str
    whole: bool


def identify_container(data: bytes) -> Container | None:
    """Recognise a video's container; None if the file is no video.

    Examples
    --------
    >>> identify_container(bytes.fromhex("00000010 66747970 6d703432 00000000"))
    Container(demuxer='mov', media_type='video/mp4', whole=True)
    >>> identify_container(b"GIF89a")
    """
    if data.startswith(EBML.to_bytes(4, "big")):
        document = next((data[at:end] for name, at, end in _read_elements(data) if name == EBML), b"")
        webm = any(name == DOCUMENT_TYPE and document[at:end] == b"webm" for name, at, end in _read_elements(document))
        whole = any(name == SEGMENT for name, _, _ in _read_elements(data))
        whole = whole and all(end <= len(data) for _, _, end in _read_elements(data))
        return Container("matroska", "video/webm" if webm else "video/x-matroska", whole)
    if data[4:8] in BOXES and data[8:12] not in STILLS:
        quicktime = data[4:8] != b"ftyp" or data[8:12] == b"qt  "
        return Container("mov", "video/quicktime" if quicktime else "video/mp4", _has_all_boxes(data))
    return None


def _has_all_boxes(data: bytes) -> bool:
    at = 0
    while at + 8 <= len(data):
        size = int.from_bytes(data[at : at + 4], "big")
        if size == 1:  # 64 bits follow
            size = int.from_bytes(data[at + 8 : at + 16], "big")
        if size == 0:  # the last box, which extends to the end of the file
            return True
        if size < 8:
            return False
        at += size
    return at <= len(data)


def _read_elements(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield name, start and end of each element's content; one of unknown length extends to the end of the data."""
    at = 0
    while at < len(data):
        name_length, length = _measure_number(data, at), 0
        length = _measure_number(data, at + name_length)
        start = at + name_length + length
        if not name_length or not length or start > len(data):
            return
        name = int.from_bytes(data[at : at + name_length], "big")
        marked = int.from_bytes(data[at + name_length : start], "big")
        size = marked & ((1 << 7 * length) - 1)
        at = len(data) if size == (1 << 7 * length) - 1 else start + size
        yield name, start, at


def _measure_number(data: bytes, at: int) -> int:
    """Return the bytes of a number of variable length, by its leading zeros; 0 if there is none."""
    return 9 - data[at].bit_length() if at < len(data) and data[at] else 0

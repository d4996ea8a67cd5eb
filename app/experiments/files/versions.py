"""Versions of files: the first digits of a digest, and of what is made from a file the converter's version as well.

In an address a version says which bytes are meant: only under one that fits may a cache keep them for ever.
"""

from hashlib import sha256
from importlib.metadata import version

from app.synthesis import __version__

DIGITS = 12
_MAKERS = ("pillow", "tifffile", "isal", "av")  # packages that write renditions and conversions
CONVERTER = sha256(" ".join([__version__, *map(version, _MAKERS)]).encode()).hexdigest()[:6]
"""Names the versions of all that makes files from stored ones: another one may write other bytes."""


def stored_version(digest: str) -> str:
    """Name the version of a file that is given out as it is stored."""
    return digest[:DIGITS]


def made_version(digest: str) -> str:
    """Name the version of all that is made from a stored file."""
    return f"{digest[:DIGITS]}-{CONVERTER}"


def made_tag(digest: str, *what: object) -> str:
    """Name the bytes of one thing that is made from a stored file; what is None is as usual.

    Examples
    --------
    >>> made_tag("3f2a", "webp", 8).removesuffix(CONVERTER)
    '3f2a-webp-8-'
    """
    return "-".join(str(part) for part in (digest, *what, CONVERTER) if part is not None)

"""Numbers as requests bring them: bounded where they are read, and said back in messages."""

import json
import re

FAR = 1_000_000  # pixels or frames: beyond any sample and any texture, and small enough for every database
_WHOLE = re.compile(r"\s*[+-]?[0-9]{1,9}\s*")
_SAID = 60  # characters of a value that a message says back


def whole(text: str) -> int:
    """Read a whole number of at most nine digits.

    Raises
    ------
    ValueError
        If the text is anything else; Python's ``int`` takes ``1_000`` and digits of other scripts besides, and as many
        of them as there are.

    Examples
    --------
    >>> whole(" -12 ")
    -12
    """
    if not _WHOLE.fullmatch(text):
        raise ValueError(f"not a whole number of at most nine digits: {said(text)}")
    return int(text)


def said(value: object) -> str:
    """Write a value as JSON for a message: cut in the middle where it is long, and of lists and objects the kind only.

    Examples
    --------
    >>> said("7"), said(True), said([1, 2]), said(10**400)
    ('"7"', 'true', 'a list', '10000000000000000000…0000 (401 characters)')
    """
    if isinstance(value, list | tuple):
        return "a list"
    if isinstance(value, dict):
        return "an object"
    text = json.dumps(value, ensure_ascii=False, default=str).encode(errors="backslashreplace").decode()
    return text if len(text) <= _SAID else f"{text[:20]}…{text[-4:]} ({len(text)} characters)"

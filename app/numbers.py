"""Numbers in requests: parsing, bounds, and quoting of values in error messages."""

import json
import re
import unicodedata

FAR = 1_000_000  # pixels or frames: beyond any sample and any texture, and small enough for every database
_WHOLE = re.compile(r"\s*[+-]?[0-9]{1,9}\s*")
_WHOLE_WRITTEN = re.compile(r"([+-]?)([0-9]+)(?:[.,](?!000$)0+)?")  # three noughts after a sign may be thousands
_WRITTEN = re.compile(r"([+-]?)([0-9]*)(?:[.,]([0-9]*))?(e[+-]?[0-9]+)?", re.IGNORECASE)
_QUOTED = 60  # characters of a value that a message says back


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
        raise ValueError(f"not a whole number of at most nine digits: {quote(text)}")
    return int(text)


def plain(text: str, *, whole: bool) -> str:
    """Write a number that a person typed as programs do: a decimal comma becomes a point.

    The pages' scripts read numbers in the same way (``static/js/lib/numbers.js``).

    Raises
    ------
    ValueError
        If it is no number, or no whole one where that is asked for, or could be more than one: with marks for
        thousands (``1.234,5``, ``1,2,3``), or ``1,000`` for a whole number.

    Examples
    --------
    >>> plain("0,25", whole=False), plain(" 007 ", whole=True), plain("7,0", whole=True)
    ('0.25', '7', '7')
    """
    written = unicodedata.normalize("NFKC", text).replace("\N{MINUS SIGN}", "-").strip()
    found = (_WHOLE_WRITTEN if whole else _WRITTEN).fullmatch(written)
    sign, digits, *parts = found.groups(default="") if found else ("", "")
    rest, power = parts or ("", "")
    if not digits and not rest:
        raise ValueError(f"not a{' whole' if whole else ''} number: {quote(text)}")
    return ("-" if sign == "-" else "") + (digits.lstrip("0") or "0") + (f".{rest}" if rest else "") + power.lower()


def quote(value: object) -> str:
    """Quote a value in a message, as JSON: cut in the middle where it is long, and of lists and objects the kind only.

    Examples
    --------
    >>> quote("7"), quote(True), quote([1, 2]), quote(10**400)
    ('"7"', 'true', 'a list', '10000000000000000000…0000 (401 characters)')
    """
    if isinstance(value, list | tuple):
        return "a list"
    if isinstance(value, dict):
        return "an object"
    text = json.dumps(value, ensure_ascii=False, default=str).encode(errors="backslashreplace").decode()
    return text if len(text) <= _QUOTED else f"{text[:20]}…{text[-4:]} ({len(text)} characters)"

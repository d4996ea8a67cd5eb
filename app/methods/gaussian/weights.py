"""Weights of several samples: parsing of what a person types."""

import math
import re

from app.numbers import plain

NO_NUMBERS = (
    "must be numbers from 0 on, and not all of them 0, with commas between them, such as 0.3,0.7, "
    "or with semicolons where the commas are decimal, such as 0,3; 0,7"
)


def canonical(text: str) -> str:
    """Write weights with decimal points and commas between them; an empty text stays empty.

    Raises
    ------
    ValueError
        If they are no weights, or could be read in two ways, with the words of `NO_NUMBERS`.

    Examples
    --------
    >>> canonical("0,3; 0,7"), canonical("1 2"), canonical(" ")
    ('0.3,0.7', '1,2', '')
    """
    if not text.strip():
        return ""
    try:
        written = [plain(part, whole=False) for part in _parts(text)]
    except ValueError:
        raise ValueError(NO_NUMBERS) from None
    found = [float(number) for number in written]
    if not all(0 <= weight < math.inf for weight in found) or not 0 < sum(found) < math.inf:
        raise ValueError(NO_NUMBERS)
    return ",".join(written)


def _parts(text: str) -> list[str]:
    """Split a list at its semicolons, or at its spaces if no comma stands beside one, or at its commas.

    Commas of both kinds, ``0,5, 0,5``, could be four numbers or two.
    """
    if ";" in text:
        return text.split(";")
    if not re.search(r"\s,|,\s", text.strip()):
        apart = text.split()
        return apart if len(apart) > 1 else text.split(",")
    if "." not in text and re.search(r"\S,\S", text):
        raise ValueError(text)
    return text.split(",")

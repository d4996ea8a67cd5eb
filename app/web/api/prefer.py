"""The ``Prefer: wait=…`` request header of RFC 7240."""

import re

LONGEST = 60

_WAIT = re.compile(r'(?:^|,)\s*wait\s*=\s*"?(\d{1,9})"?\s*(?=[,;]|$)', re.IGNORECASE)


def wait_seconds(prefer: str | None) -> int | None:
    """Read the seconds a client wants to wait, at most `LONGEST`; None if it says nothing about it.

    Examples
    --------
    >>> wait_seconds("respond-async, wait=30"), wait_seconds("wait=3600"), wait_seconds("return=minimal")
    (30, 60, None)
    """
    found = _WAIT.search(prefer or "")
    return min(int(found[1]), LONGEST) if found else None

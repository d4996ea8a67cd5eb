"""Addresses on pages without the versions of their bytes, which `tests/web/test_caching.py` is about."""

import re


def without_versions(text: str) -> str:
    """Take the versions out of all addresses of a page.

    Examples
    --------
    >>> without_versions('href="/a/video?v=0f1e" src="/a/image?size=256&amp;v=0f1e-2d"')
    'href="/a/video" src="/a/image?size=256"'
    """
    return re.sub(r"(?:\?|&amp;|&)v=[0-9a-f-]+", "", text)

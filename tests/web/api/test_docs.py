"""Stock pages of the API's documents; `tests/acceptance/test_docs.py` opens ours in a browser."""

import pytest


@pytest.mark.parametrize("path", ["/redoc", "/openapi.json", "/docs/oauth2-redirect"])
def test_the_stock_pages_are_off(site, path):
    assert site.client.get(path).status_code == 404

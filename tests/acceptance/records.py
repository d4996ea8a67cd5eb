"""Record of the experiment whose page is shown."""

from typing import Any

from playwright.sync_api import Page


def record_of(site: Any, page: Page) -> dict[str, Any]:
    page.wait_for_url("**/experiments/*")
    return dict(site.client.get("/api/v1/experiments/" + page.url.rsplit("/", 1)[-1]).json())

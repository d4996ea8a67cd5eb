"""A client that has had its share is told so on every page, in words and with when to try again."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.acceptance.conftest import serving

ONE = {f"LIMIT_{kind}": "1/hour" for kind in ("UPLOADS", "EXPERIMENTS", "CONVERSIONS", "DEEP")}
WAIT = re.compile(r"Wait (1 hour|\d+ minutes): this service takes at most 1 [a-z ]+ an hour from one client\.")


@pytest.fixture(scope="module")
def limited(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A service where every visitor has one of each an hour."""
    with serving(tmp_path_factory.mktemp("limited"), LIMITS="true", LIMIT_ADDRESS="1000", **ONE) as served:
        yield served


def visitor(visitors: Any, limited: Any, path: str, **options: Any) -> Page:
    """Open a page as somebody whom the service knows already."""
    visitors.refusals_expected = True
    page: Page = visitors.visit("about:blank", **options)
    page.context.add_cookies(
        [{"name": "microtexture_owner", "value": f"{id(page):032d}", "url": limited.url, "httpOnly": True}]
    )
    page.goto(f"{limited.url}{path}")
    return page


def test_a_second_upload_says_why_where_it_was_chosen(
    visitors: Any, limited: Any, photograph: Path, assert_accessible: Any, screenshot: Any
) -> None:
    page = visitor(visitors, limited, "/")
    page.set_input_files("#file", photograph)
    page.wait_for_url("**/samples/*")
    page.goto(f"{limited.url}/")
    page.set_input_files("#file", photograph)
    message = page.locator("#upload-error")
    expect(message).to_contain_text(WAIT)
    expect(message).to_be_focused()
    assert_accessible(page)
    screenshot(page, "limited-upload")


@pytest.mark.parametrize("width", [390, 1440])
def test_a_second_experiment_says_why_and_keeps_the_form(
    visitors: Any, limited: Any, assert_accessible: Any, screenshot: Any, width: int
) -> None:
    page = visitor(visitors, limited, "/samples/gravel_gray", viewport={"width": width, "height": 900})
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    page.goto(f"{limited.url}/samples/gravel_gray")
    page.fill("#seed", "4711")
    with page.expect_response(re.compile("/experiments$")) as answer:
        page.get_by_role("button", name="Synthesise").click()
    assert answer.value.status == 429
    summary = page.locator(".summary")
    expect(summary).to_contain_text("Too many requests")
    expect(summary).to_contain_text(WAIT)
    expect(summary).to_be_focused()
    expect(page.locator("#seed")).to_have_value("4711")
    assert_accessible(page)
    screenshot(page, f"limited-form-{width}")


def test_a_second_conversion_is_explained_on_a_page(visitors: Any, limited: Any, screenshot: Any) -> None:
    page = visitor(visitors, limited, "/samples/gravel_gray")
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    link = page.get_by_role("link", name="JPEG")
    with page.expect_download():
        link.click()
    page.get_by_role("link", name="WebP").click()
    expect(page.get_by_role("heading", name="Too many requests")).to_be_visible()
    expect(page.locator(".detail")).to_contain_text(WAIT)
    screenshot(page, "limited-conversion")
    page.go_back()
    expect(link).to_be_visible()


def test_without_scripts_both_are_said_too(visitors: Any, limited: Any, photograph: Path) -> None:
    page = visitor(visitors, limited, "/", java_script_enabled=False)
    for expected in ("**/samples/*", "**/samples"):
        page.goto(f"{limited.url}/")
        page.set_input_files("#file", photograph)
        page.get_by_role("button", name=re.compile("Upload|Send|Use")).click()
        page.wait_for_url(expected)
    expect(page.locator("#upload-error")).to_contain_text(WAIT)

"""``/docs`` in a real browser: Swagger UI from our own host, under the strict Content-Security-Policy."""

import pytest
from playwright.sync_api import sync_playwright


@pytest.mark.acceptance
def test_the_docs_show_every_route_and_load_nothing_from_elsewhere(site, chromium):
    paths = site.client.get("/api/v1/openapi.json").json()["paths"]
    requested, complaints = [], []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(**chromium)
        page = browser.new_page()
        page.on("request", lambda request: requested.append(request.url))
        page.on("requestfailed", lambda request: complaints.append(request.url))
        page.on("console", lambda message: complaints.append(message.text))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto(f"{site.url}/docs")
        page.wait_for_selector(".opblock")
        assert page.locator(".opblock").count() == sum(len(item) for item in paths.values())
        page.click("#operations-experiments-read_experiment .opblock-summary-control")
        page.fill("#operations-experiments-read_experiment input", "none")
        page.click("#operations-experiments-read_experiment button.execute")
        page.wait_for_selector(".live-responses-table")
        assert "404" in page.inner_text(".live-responses-table tbody .response-col_status")
        browser.close()
    assert all(url.startswith((site.url, "data:")) for url in requested)
    assert [complaint for complaint in complaints if "404" not in complaint] == []


@pytest.mark.parametrize("path", ["/redoc", "/openapi.json", "/docs/oauth2-redirect"])
def test_the_stock_pages_are_off(site, path):
    assert site.client.get(path).status_code == 404

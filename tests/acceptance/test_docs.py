"""Swagger UI at ``/docs`` in a real browser: from our own host, under the strict Content-Security-Policy."""

from typing import Any

from playwright.sync_api import expect


def test_the_docs_show_every_route_and_load_nothing_from_elsewhere(visitors: Any, site: Any) -> None:
    paths = site.client.get("/api/v1/openapi.json").json()["paths"]
    visitors.refusals_expected = True  # of the experiment that is not there
    page = visitors.visit("about:blank")  # so that all that is asked for is heard
    requested: list[str] = []
    failed: list[str] = []
    page.on("request", lambda request: requested.append(request.url))
    page.on("requestfailed", lambda request: failed.append(request.url))
    page.goto("/docs")
    expect(page.locator(".opblock")).to_have_count(sum(len(item) for item in paths.values()))
    page.click("#operations-experiments-read_experiment .opblock-summary-control")
    page.fill("#operations-experiments-read_experiment input", "none")
    page.click("#operations-experiments-read_experiment button.execute")
    expect(page.locator(".live-responses-table tbody .response-col_status").first).to_contain_text("404")
    assert all(url.startswith((site.url, "data:")) for url in requested)
    assert failed == []

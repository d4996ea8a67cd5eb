"""A waiting room leads to the result whatever becomes of the connection meanwhile."""

import re
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect

FORM = "/samples/gravel_gray?crop=0,0,64,64"
PROXY = "<!doctype html><title>502 Bad Gateway</title><h1>Bad Gateway</h1>"
FAILURES: dict[str, Callable[[Route], None]] = {
    "aborted": lambda route: route.abort(),
    "502 of a proxy": lambda route: route.fulfill(status=502, content_type="text/html", body=PROXY),
    "a page of somebody else": lambda route: route.fulfill(status=200, content_type="text/html", body=PROXY),
}

Waiting = Callable[[], AbstractContextManager[None]]


def waiting_room(page: Page) -> None:
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    expect(page.locator("[data-experiment]")).to_be_visible()
    page.evaluate("window.sameDocument = true")


def forgive(visitors: Any, *words: str) -> None:
    """Let pass what the browser itself says of an answer that was spoilt."""
    visitors.complaints[:] = [said for said in visitors.complaints if not any(word in said for word in words)]


def is_fetch(route: Route) -> bool:
    return route.request.resource_type in {"fetch", "xhr", "eventsource"}


@pytest.mark.parametrize("failure", FAILURES)
def test_whatever_is_fetched_may_fail_once(visitors: Any, busy: Waiting, failure: str) -> None:
    """Events, the record and the page itself: each is asked for again, and the result comes without a reload."""
    page = visitors.visit(FORM)
    failed: list[str] = []

    def once(route: Route) -> None:
        if not is_fetch(route) or route.request.url in failed:
            route.fallback()
            return
        failed.append(route.request.url)
        FAILURES[failure](route)

    page.route("**/experiments/*", once)
    page.route("**/experiments/*/events", once)
    with busy(), page.expect_request(re.compile("/api/v1/experiments/[^/]+$")):  # where the events fail
        waiting_room(page)
    expect(page.locator(".viewer.live")).to_be_visible()
    assert page.evaluate("window.sameDocument")
    identifier = page.url.rsplit("/", 1)[-1]
    assert page.url in failed
    assert page.url.replace(identifier, f"{identifier}/events").replace("/experiments", "/api/v1/experiments") in failed
    forgive(visitors, "Failed to load resource", "EventSource's response")


def test_a_result_that_does_not_come_is_said_to_load_and_then_the_page_is_reloaded(
    visitors: Any, busy: Waiting, screenshot: Callable[..., None]
) -> None:
    """Nobody is left with "Running" once it has ended; who does not like to wait has a link."""
    page = visitors.visit(FORM)
    page.clock.install()
    asked: list[str] = []

    def never(route: Route) -> None:
        if not is_fetch(route):
            route.fallback()
            return
        asked.append(route.request.url)
        FAILURES["502 of a proxy"](route)

    with busy():
        waiting_room(page)
        page.route(page.url, never)
    expect(page.get_by_role("heading", name="Finished")).to_be_visible()
    expect(page.locator("[data-stage]")).to_have_text("Loading the result …")
    expect(page.get_by_role("link", name="Reload the page")).to_be_visible()
    screenshot(page, "experiment-loading")
    while page.locator("[data-experiment]").count():
        page.clock.run_for(1000)
    expect(page.locator(".viewer.live")).to_be_visible()
    assert not page.evaluate("window.sameDocument")
    assert len(asked) >= 4
    forgive(visitors, "Failed to load resource", "EventSource's response")


def test_who_does_not_like_to_wait_reloads_by_the_link(visitors: Any, busy: Waiting) -> None:
    page = visitors.visit(FORM)
    with busy():
        waiting_room(page)
        page.route(page.url, lambda route: route.abort() if is_fetch(route) else route.fallback())
    page.get_by_role("link", name="Reload the page").click()
    expect(page.locator(".viewer.live")).to_be_visible()
    forgive(visitors, "Failed to load resource", "EventSource's response")


def test_events_that_are_held_back_do_not_keep_the_page_waiting(visitors: Any, busy: Waiting) -> None:
    """A proxy that gathers what is streamed gives no sign at all, not even an error."""
    page = visitors.visit(FORM)
    held: list[Route] = []

    def hold(route: Route) -> None:
        held.append(route)

    page.route("**/events", hold)
    with busy():
        waiting_room(page)
    expect(page.locator(".viewer.live")).to_be_visible()
    assert page.evaluate("window.sameDocument")
    for route in held:
        route.abort()


def test_events_that_are_no_events_do_not_keep_the_page_waiting(visitors: Any, busy: Waiting) -> None:
    page = visitors.visit(FORM)
    page.route("**/events", lambda route: route.fulfill(content_type="text/event-stream", body="data: <html>\n\n"))
    with busy():
        waiting_room(page)
    expect(page.locator(".viewer.live")).to_be_visible()
    assert page.evaluate("window.sameDocument")
    forgive(visitors, "JSON")

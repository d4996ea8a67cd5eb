"""The main button: it says at once that something is under way, comes back when that is stopped, and is never dead."""

import re
from typing import Any

import pytest
from playwright.sync_api import Page, Request, Route, expect

FORM = "/samples/gravel_gray?crop=96,96,64,64"
POSTED = re.compile("/experiments$")


class Held:
    """Forms that are kept unanswered until they are let through; as a slow network does."""

    def __init__(self, page: Page) -> None:
        self.routes: list[Route] = []
        self.sent: list[Request] = []
        self.open = False
        page.route(POSTED, self.keep)

    def keep(self, route: Route) -> None:
        self.sent.append(route.request)
        if self.open:
            route.continue_()
        else:
            self.routes.append(route)


def press(page: Page, times: int = 1) -> None:
    """Press, so many times half a second apart, and note how the page looks after each change.

    Playwright waits for a page that is to come before it looks at the one that is there: so the page itself notes.
    """
    page.evaluate(
        """times => {
            const [button, live] = ["button.main", "#sending"].map(name => document.querySelector(name));
            window.seen = [];
            const note = () => window.seen.push({
                busy: button.getAttribute("aria-busy"), text: button.textContent, live: live.textContent,
                disabled: button.disabled,
            });
            const watch = new MutationObserver(note);
            for (const part of [button, live]) watch.observe(part, {attributes: true, childList: true, subtree: true});
            for (let time = 0; time < times; time += 1) setTimeout(() => button.click(), 500 * time);
        }""",
        times,
    )


def stop(page: Page, how: str) -> None:
    """What a browser's Stop button does, or its key; returns when the form's request is given up.

    Until then the page is about to be left, and Playwright would wait for the next one, for ever.
    """
    with page.expect_event("requestfailed", lambda request: POSTED.search(request.url) is not None):
        if how == "Escape":
            page.keyboard.press("Escape")
        else:
            page.context.new_cdp_session(page).send("Page.stopLoading")


def was_sending(page: Page) -> None:
    """What was seen in between, from the press on."""
    first = page.evaluate("window.seen")[0]
    assert first == {"busy": "true", "text": "Sending …", "live": "Sending …", "disabled": False}


def at_rest(page: Page) -> None:
    button = page.locator("button.main")
    expect(button).to_have_text("Synthesise")
    expect(button).not_to_have_attribute("aria-busy", "true")
    expect(button).to_be_enabled()


def made_of(site: Any, seed: int) -> int:
    """How many experiments have this seed."""
    found = site.client.get("/api/v1/experiments", params={"limit": 100}).json()["experiments"]
    return sum(entry["parameters"]["seed"] == seed for entry in found)


def arrive(page: Page) -> None:
    page.wait_for_url("**/experiments/*")
    expect(page.locator(".viewer.live")).to_be_visible()


@pytest.mark.parametrize("how", ["Stop", "Escape"])
@pytest.mark.parametrize("heard", [False, True])
def test_after_stop_the_button_works_again(visitors: Any, site: Any, how: str, heard: bool) -> None:
    """Another request goes out and the page comes; whether or not the service had heard the first: one experiment."""
    seed = 9100 + 2 * heard + (how == "Escape")
    page = visitors.visit(f"{FORM}&seed={seed}")
    at_rest(page)
    held = Held(page)
    with page.expect_request(POSTED) as posted:
        press(page)
    if heard:
        post = posted.value
        site.client.cookies.clear()
        answer = site.client.post("/experiments", content=post.post_data_buffer, headers=dict(post.headers))
        assert answer.status_code == 303, answer.text
        site.client.cookies.clear()
    stop(page, how)
    at_rest(page)
    was_sending(page)
    held.open = True
    with page.expect_request(POSTED):
        page.get_by_role("button", name="Synthesise").click()
    arrive(page)
    assert len(held.sent) == 2
    assert made_of(site, seed) == 1


def test_three_presses_while_nothing_answers_are_one_experiment(visitors: Any, site: Any) -> None:
    """Each goes out, for the one before may be lost."""
    page = visitors.visit(f"{FORM}&seed=9111")
    held = Held(page)
    with page.expect_request(lambda _: len(held.sent) >= 2):
        press(page, 3)
    held.open = True
    with page.expect_request(POSTED):
        stop(page, "Stop")
        page.get_by_role("button", name="Synthesise").click()
    arrive(page)
    assert made_of(site, 9111) == 1


def test_a_double_click_is_one_experiment(visitors: Any, site: Any) -> None:
    page = visitors.visit(f"{FORM}&seed=9112")
    page.get_by_role("button", name="Synthesise").dblclick()
    arrive(page)
    assert made_of(site, 9112) == 1
    before = site.client.get("/api/v1/experiments", params={"limit": 100}).json()["experiments"]
    page.get_by_role("button", name="New seed").dblclick()
    page.wait_for_url(lambda address: address.endswith(tuple("/" + e["id"] for e in before)) is False)
    arrive(page)
    after = site.client.get("/api/v1/experiments", params={"limit": 100}).json()["experiments"]
    assert len(after) == len(before) + 1


def test_who_comes_back_may_press_again_for_another_experiment(visitors: Any, site: Any) -> None:
    page = visitors.visit(f"{FORM}&seed=9113")
    page.get_by_role("button", name="Synthesise").click()
    arrive(page)
    first = page.url
    page.go_back()
    at_rest(page)
    expect(page.locator("#sending")).to_be_empty()
    page.get_by_role("button", name="Synthesise").click()
    arrive(page)
    expect(page).not_to_have_url(first)
    assert made_of(site, 9113) == 2


def test_a_browser_that_does_not_tell_of_its_stop_is_not_believed_for_ever(visitors: Any, site: Any) -> None:
    """Without the Navigation API, as WebKit of today, the sign goes after a while; the button works all the time."""
    page = visitors.visit("about:blank")
    page.clock.install()
    page.add_init_script("delete Window.prototype.navigation; delete window.navigation;")
    page.goto(f"{FORM}&seed=9114")
    assert page.evaluate("'navigation' in window") is False
    held = Held(page)
    with page.expect_request(POSTED):
        press(page)  # the clock is not wound on while the page is about to be left: that would wait for the next one
    stop(page, "Stop")
    page.clock.run_for(10_000)
    at_rest(page)
    was_sending(page)
    expect(page.locator("#sending")).to_contain_text("Press again")
    held.open = True
    with page.expect_request(POSTED):
        page.get_by_role("button", name="Synthesise").click()
    arrive(page)
    assert made_of(site, 9114) == 1

"""What is wrong with a form is said while it is filled in, at the field and at the main button."""

import re
from typing import Any

from playwright.sync_api import Route, expect

CHECK = "/experiments/check"
PATCHWORK = "/samples/gravel_gray?method=patchwork&crop=96,96,320,320"


def test_the_largest_grid_that_fits_a_crop_is_named_and_taken(visitors: Any) -> None:
    """As the crop shrinks under the grid; with the number that is named, all is well."""
    page = visitors.visit(PATCHWORK)
    page.fill("#crop-height", "120")
    problem = page.locator("#run-problem")
    expect(problem).to_contain_text("take a grid of at most")
    expect(page.locator("#patchwork-grid-error")).to_have_text(problem.inner_text())
    expect(page.locator("#patchwork-grid")).to_have_attribute("aria-invalid", "true")
    expect(page.locator("#patchwork-grid")).to_have_attribute(
        "aria-describedby", "patchwork-grid-help patchwork-grid-error"
    )
    named = re.search(r"at most (\d+)", problem.inner_text())
    assert named is not None
    page.fill("#patchwork-grid", named[1])
    expect(problem).to_be_hidden()
    expect(page.locator("#patchwork-grid-error")).to_be_hidden()
    assert page.locator("[aria-invalid]").count() == 0
    page.fill("#patchwork-grid", str(int(named[1]) + 1))
    expect(problem).to_contain_text("take a grid of at most")


def test_sending_is_not_hindered_and_says_the_same(visitors: Any) -> None:
    """And what was said on top of the page goes once it does not hold any more."""
    visitors.refusals_expected = True
    page = visitors.visit(PATCHWORK)
    page.fill("#crop-height", "120")
    problem = page.locator("#run-problem")
    expect(problem).not_to_be_empty()
    words = problem.inner_text()
    page.get_by_role("button", name="Synthesise").click()
    expect(page.locator(".summary li")).to_have_text(words)
    page.fill("#patchwork-grid", "16")
    expect(page.locator(".summary")).to_have_count(0)


def test_who_is_quicker_than_the_script_is_answered_too(visitors: Any, until: Any) -> None:
    """A field that was mended while the page was still loading takes the service's message with it."""
    visitors.refusals_expected = True
    page = visitors.visit(f"{PATCHWORK}&grid=400")
    page.wait_for_load_state("networkidle")
    held: list[Route] = []

    def hold(route: Route) -> None:
        held.append(route)

    page.route("**/check.js*", hold)
    page.get_by_role("button", name="Synthesise").click(no_wait_after=True)
    until(lambda: held or page.wait_for_timeout(20), "the script of the refused form's page")
    page.fill("#patchwork-grid", "16")
    held[0].continue_()
    expect(page.locator(".summary")).to_have_count(0)
    expect(page.locator("#patchwork-grid-error")).to_be_hidden()


def test_a_run_that_would_take_too_much_is_told_from_one_that_takes_much(visitors: Any) -> None:
    """Memory beforehand: nothing of a small run, how much of a large one, a refusal beyond."""
    page = visitors.visit("/samples/sky_pan?method=video-rpn")
    memory, problem = page.locator("#run-memory"), page.locator("#run-problem")
    page.select_option("#size", "3")
    expect(memory).to_contain_text(re.compile(r"Takes about 1\.\d of 1\.5 GB of memory"))
    expect(problem).to_be_hidden()
    page.fill("#frames", "200")
    expect(problem).to_contain_text(re.compile(r"would need about .* MB of memory"))
    expect(memory).to_be_empty()
    page.fill("#frames", "12")
    expect(problem).to_be_hidden()
    expect(memory).to_be_empty()


def test_while_one_types_nothing_is_asked_and_nothing_flickers(visitors: Any) -> None:
    """A burst of changes is one question, and what is said stays until the answer is another."""
    page = visitors.visit(PATCHWORK)
    page.wait_for_load_state("networkidle")
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url) if request.url.endswith(CHECK) else None)
    with page.expect_response(f"**{CHECK}"):
        page.evaluate(
            """() => {
                const field = document.querySelector("#patchwork-grid");
                for (const value of ["9", "99", "999", "400"]) {
                    field.value = value;
                    field.dispatchEvent(new Event("input", { bubbles: true }));
                }
            }"""
        )
    assert len(asked) == 1
    problem = page.locator("#run-problem")
    expect(problem).to_contain_text("grid 400")
    page.evaluate(
        """() => {
            window.emptied = 0;
            const problem = document.querySelector("#run-problem");
            new MutationObserver(() => { if (problem.hidden || !problem.textContent) window.emptied += 1; })
                .observe(problem, { attributes: true, childList: true, characterData: true, subtree: true });
        }"""
    )
    page.fill("#patchwork-grid", "300")
    expect(problem).to_contain_text("grid 300")
    assert page.evaluate("window.emptied") == 0


def test_a_form_without_the_service_is_still_a_form(visitors: Any) -> None:
    """Where the question gets no answer, nothing is said."""
    page = visitors.visit(PATCHWORK)
    page.wait_for_load_state("networkidle")
    page.route(f"**{CHECK}", lambda route: route.fulfill(status=404, body="gone"))
    visitors.refusals_expected = True
    with page.expect_response(f"**{CHECK}"):
        page.fill("#patchwork-grid", "400")
    expect(page.locator("#run-problem")).to_be_hidden()
    expect(page.get_by_role("button", name="Synthesise")).to_be_enabled()

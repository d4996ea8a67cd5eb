"""Numbers are typed with a comma or a point, said back as they were understood, and stepped by the arrow keys."""

import re
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.acceptance.crops import box_of, crop_of, drag

CHINA = "/samples/scene_china?crop=100,100,200,150"


def type_over(page: Page, field: str, text: str) -> None:
    page.locator(field).click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type(text)


@pytest.fixture
def page(visitors: Any) -> Page:
    page: Page = visitors.visit(CHINA)
    page.wait_for_selector("#frame.ready")
    page.locator("#method-rpn ~ .own summary").click()
    return page


@pytest.mark.parametrize(
    ("typed", "said"), [("0,2", "0.2"), ("0.25", "0.25"), (",3", "0.3"), (" 0,40 ", "0.40"), ("００，２", "0.2")]
)
def test_a_decimal_comma_is_said_back_as_a_point(page: Page, site: Any, typed: str, said: str) -> None:
    """When the field is left; the address says it, too, and the experiment is of that number."""
    type_over(page, "#rpn-alpha", typed)
    page.keyboard.press("Tab")
    expect(page.locator("#rpn-alpha")).to_have_value(said)
    expect(page).to_have_url(re.compile(rf"[?&]rpn\.alpha={re.escape(said)}(&|$)"))
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    record = site.client.get("/api/v1" + page.url.removeprefix(site.url)).json()
    assert record["parameters"]["alpha"] == float(said)


@pytest.mark.parametrize(
    ("field", "typed", "message", "words"),
    [
        ("#crop-x", "12,5", "#crop-error", 'whole numbers: x, y, width and height in pixels; got "12,5" for x.'),
        ("#crop-height", "12.5", "#crop-error", 'got "12.5" for height.'),
        ("#crop-y", "1.000", "#crop-error", 'got "1.000" for y.'),
        ("#seed", "12,5", "#seed-error", 'Seed is a whole number from 0 to 9007199254740991; got "12,5".'),
        ("#width", "64,5", "#width-error", 'Width is a whole number from 1 to 1000000; got "64,5".'),
        ("#rpn-alpha", "1.234,5", "#rpn-alpha-error", 'is a number from 0 to 0.5; got "1.234,5".'),
        ("#rpn-alpha", "0,7", "#rpn-alpha-error", "is a number from 0 to 0.5"),
    ],
)  # fmt: skip
def test_what_is_not_such_a_number_stays_and_is_named(
    page: Page, field: str, typed: str, message: str, words: str
) -> None:
    """While it is typed and after the field is left: no digit of it is dropped, and nothing else changes."""
    type_over(page, field, typed)
    for _ in range(2):
        expect(page.locator(message)).to_contain_text(words)
        expect(page.locator(field)).to_have_attribute("aria-invalid", "true")
        page.keyboard.press("Tab")
    expect(page.locator(field)).to_have_value(typed.replace(",", ".") if typed == "0,7" else typed)
    assert box_of(page) == pytest.approx([100, 100, 200, 150], abs=0.1)
    expect(page.locator("#width")).to_have_value("64,5" if field == "#width" else "200")
    expect(page.locator("#height")).to_have_value("150")


def test_another_crop_takes_the_place_of_what_was_no_number(page: Page) -> None:
    """By a drag or by Undo, and the message goes."""
    type_over(page, "#crop-x", "12,5")
    expect(page.locator("#crop-error")).to_contain_text("12,5")
    drag(page, (200, 170), (230, 170))
    assert crop_of(page) == pytest.approx([130, 100, 200, 150], abs=1)
    expect(page.locator("#crop-error")).to_be_hidden()
    moved = crop_of(page)
    type_over(page, "#crop-y", "7,5")
    page.get_by_role("button", name="Undo").click()
    assert crop_of(page) == moved
    page.get_by_role("button", name="Undo").click()
    assert crop_of(page) == [100, 100, 200, 150]


@pytest.mark.parametrize(
    ("field", "keys", "value"),
    [
        ("#rpn-alpha", ["ArrowUp"], "0.11"),
        ("#rpn-alpha", ["ArrowDown"] * 3, "0.07"),
        ("#rpn-alpha", ["PageUp"] * 9, "0.5"),
        ("#rpn-alpha", ["PageDown"] * 9, "0"),
        ("#seed", ["ArrowUp", "ArrowUp", "ArrowDown", "PageUp"], "11"),
        ("#seed", ["ArrowDown"], "0"),
        ("#crop-y", ["ArrowUp", "PageUp"], "111"),
        ("#crop-x", ["PageUp"] * 50, "440"),
        ("#width", ["ArrowUp"], "201"),
    ],
)
def test_arrow_keys_step_within_bounds(page: Page, field: str, keys: list[str], value: str) -> None:
    """As the method declares them; the box, the address and the check follow each step."""
    page.locator(field).focus()
    for key in keys:
        page.keyboard.press(key)
    expect(page.locator(field)).to_have_value(value)
    expect(page.locator(field)).to_have_attribute("aria-valuenow", value)
    assert box_of(page) == pytest.approx(crop_of(page), abs=0.1)
    if field == "#width":
        expect(page.locator("#size")).to_have_value("free")


def test_every_number_is_a_text_that_tells_its_bounds(page: Page) -> None:
    """So no browser drops what it takes for no digit, and phones still show digits first."""
    assert page.locator("input[type=number]").count() == 0
    told = page.locator("input[inputmode]").evaluate_all(
        "all => all.map(({id, type, role, inputMode, ariaValueMin, dataset}) => "
        "[id, type, role, inputMode, ariaValueMin === (dataset.min ?? null)])"
    )
    assert len(told) > 20
    assert {tuple(entry[1:3]) for entry in told} == {("text", "spinbutton")}
    assert all(entry[4] for entry in told)
    modes = {entry[0]: entry[3] for entry in told}
    assert (modes["crop-x"], modes["seed"], modes["rpn-alpha"]) == ("numeric", "numeric", "decimal")


def test_a_size_of_ones_own_is_left_alone(page: Page) -> None:
    """Whatever is typed there, and whatever becomes of the crop meanwhile."""
    type_over(page, "#width", "9")
    type_over(page, "#height", "3000")
    page.keyboard.press("Tab")
    drag(page, (200, 170), (230, 190))
    type_over(page, "#crop-width", "50,5")
    page.keyboard.press("Tab")
    assert [page.input_value("#width"), page.input_value("#height")] == ["9", "3000"]
    expect(page.locator("#size")).to_have_value("free")


def test_without_a_script_the_form_takes_a_decimal_comma(visitors: Any, site: Any) -> None:
    page = visitors.visit(CHINA, java_script_enabled=False)
    page.locator("#method-rpn ~ .own summary").click()
    page.fill("#rpn-alpha", "0,2")
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    assert site.client.get("/api/v1" + page.url.removeprefix(site.url)).json()["parameters"]["alpha"] == 0.2

"""Undo of the crop: every kind of change, by button and by keys, many steps back and forth."""

import itertools
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.acceptance.crops import box_of, crop_of, drag


def change_by(page: Page, change: str) -> None:
    """Change the crop in one of the ways there are."""
    if change == "drag":
        drag(page, (200, 180), (260, 200))
    elif change == "draw":
        drag(page, (500, 400), (350, 300))
    elif change == "handle":
        drag(page, (300, 260), (340, 300))
    elif change == "key":
        page.locator("#frame .box").focus()
        page.keyboard.press("ArrowRight")
    elif change == "key held down":
        page.locator("#frame .box").focus()
        for _ in range(5):
            page.keyboard.down("ArrowRight")
        page.keyboard.up("ArrowRight")
    elif change == "typed":
        page.locator("#crop-width").click()
        page.keyboard.press("ControlOrMeta+a")
        page.keyboard.type("123")
        page.keyboard.press("Tab")
    elif change == "stepped":
        page.locator("#crop-y").focus()
        page.keyboard.press("ArrowUp")
    else:
        page.locator("#crop-tools").get_by_role("button", name=change).click()


CHANGES = ("drag", "draw", "handle", "key", "key held down", "typed", "stepped", "Whole photograph", "Suggested")


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("by", ["button", "Control+z", "Meta+z"])
def test_undo_takes_back_the_last_change(visitors: Any, change: str, by: str) -> None:
    """However the crop was changed: fields, box, readout, output size and address all go back, and forth again."""
    page = visitors.visit("/samples/scene_china?crop=100,100,200,160&size=2")
    page.wait_for_selector("#frame.ready")
    change_by(page, change)
    changed = crop_of(page)
    assert changed != [100, 100, 200, 160]
    undo = page.get_by_role("button", name="Undo")
    if by == "button":
        undo.click()
    else:
        page.locator("#frame .box").focus()
        page.keyboard.press(by)
    assert crop_of(page) == [100, 100, 200, 160]
    assert box_of(page) == pytest.approx([100, 100, 200, 160], abs=0.1)
    expect(page.locator("#crop-size")).to_contain_text("200 × 160 of 640 × 427")
    assert [page.input_value("#width"), page.input_value("#height")] == ["400", "320"]
    page.wait_for_function("() => location.search.includes('crop.x=100&crop.y=100&crop.width=200&crop.height=160')")
    expect(undo).to_have_attribute("aria-disabled", "true")
    if by == "button":
        page.get_by_role("button", name="Redo").click()
    else:
        page.keyboard.press(by.replace("+", "+Shift+"))
    assert crop_of(page) == changed


def test_undo_goes_many_steps_back(visitors: Any) -> None:
    """And a change after it begins a new way forth."""
    page = visitors.visit("/samples/scene_china?crop=100,100,200,160")
    page.wait_for_selector("#frame.ready")
    seen = [crop_of(page)]
    for change in CHANGES:
        change_by(page, change)
        seen.append(crop_of(page))
    for _ in range(30):
        page.locator("#frame .box").press("ArrowDown")
        seen.append(crop_of(page))
    assert all(before != after for before, after in itertools.pairwise(seen))
    for crop in reversed(seen[:-1]):
        page.locator("#frame .box").press("Control+z")
        assert crop_of(page) == crop
    page.locator("#frame .box").press("Control+Shift+z")
    assert crop_of(page) == seen[1]
    page.locator("#frame .box").press("ArrowUp")
    expect(page.get_by_role("button", name="Redo")).to_have_attribute("aria-disabled", "true")


def test_text_fields_keep_their_own_undo(visitors: Any) -> None:
    """While one types, Ctrl+Z is the field's; the crop's is the box's and its buttons'."""
    page = visitors.visit("/samples/scene_china?crop=100,100,200,160")
    page.wait_for_selector("#frame.ready")
    page.locator("#frame .box").press("ArrowRight")
    page.locator("#seed").click()
    page.keyboard.type("5")
    page.keyboard.press("ControlOrMeta+z")
    expect(page.locator("#seed")).to_have_value("0")
    page.locator("#crop-y").click()
    page.keyboard.type("1")
    page.keyboard.press("ControlOrMeta+z")
    expect(page.locator("#crop-y")).to_have_value("100")
    assert crop_of(page) == [101, 100, 200, 160]

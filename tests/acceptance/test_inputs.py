"""Methods of several samples: the others are chosen, uploaded and cropped beside the first, in any order."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page, Route, expect

from tests.acceptance import crops
from tests.acceptance.crops import SIDES
from tests.acceptance.keyboard import tab_to
from tests.acceptance.records import record_of

MIX = "/samples/gravel_gray?method=mix&crop=96,96,160,160"


def crop_of(page: Page, number: int) -> list[int]:
    return crops.crop_of(page, "" if number == 1 else f"input-{number}-")


def drag(page: Page, number: int, start: tuple[float, float], end: tuple[float, float]) -> float:
    """Drag on the photograph of an input, from and to pixels of the original; give the pixels to one of the screen."""
    frame = page.locator(f"#input-{number}-frame.ready")
    frame.scroll_into_view_if_needed()
    bounds = frame.bounding_box()
    assert bounds is not None
    scale = bounds["width"] / float(frame.get_attribute("data-width") or 0)
    page.mouse.move(bounds["x"] + start[0] * scale, bounds["y"] + start[1] * scale)
    page.mouse.down()
    page.mouse.move(bounds["x"] + end[0] * scale, bounds["y"] + end[1] * scale, steps=4)
    page.mouse.up()
    return 1 / scale


def run(page: Page) -> None:
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    expect(page.locator(".viewer.live")).to_be_visible()


def test_a_second_sample_is_chosen_and_its_crop_dragged(
    visitors: Any, site: Any, shown_pixels: Callable[..., np.ndarray], screenshot: Callable[..., None]
) -> None:
    """The page then shows exactly what was cropped of both, and their mixture."""
    page = visitors.visit("/samples/gravel_gray?crop=96,96,160,160")
    expect(page.locator("#input-2")).to_be_hidden()
    page.get_by_text("Mix", exact=True).click()
    expect(page.locator("#input-2")).to_be_visible()
    page.locator(".thumbnails img[data-sample=grass_jungle002] >> visible=true").click()
    expect(page.locator("#input-2-sample")).to_have_value("grass_jungle002")
    assert crop_of(page, 2) == [64, 300, 384, 384]
    page.locator("#input-2").get_by_role("button", name="Whole photograph").click()
    slack = 1.5 * drag(page, 2, (200, 100), (360, 240))
    assert crop_of(page, 2) == pytest.approx([200, 100, 160, 140], abs=slack)
    drag(page, 2, (280, 170), (300, 160))
    x, y, width, height = crop_of(page, 2)
    assert (x, y) == pytest.approx((220, 90), abs=2 * slack)
    assert crop_of(page, 1) == [96, 96, 160, 160]
    screenshot(page, "sample-two")
    run(page)
    grass = Image.open(Path("samples/grass_jungle002.png")).convert("RGB")
    assert np.array_equal(
        shown_pixels(page, ".pane:nth-child(2) img"), np.asarray(grass)[y : y + height, x : x + width]
    )
    assert shown_pixels(page, ".pane:nth-child(3) img").shape == (160, 160, 3)
    expect(page.locator(".textures img")).to_have_count(8)
    expect(page.get_by_role("heading", level=1)).to_contain_text("Mix of gravel")
    screenshot(page, "experiment-mix")


def test_the_whole_way_with_two_samples_by_keyboard(visitors: Any, site: Any) -> None:
    """The method, the other sample, its crop, its weight and the run without a pointer."""
    page = visitors.visit("/samples/gravel_gray?crop=96,96,160,160")
    tab_to(page, "#method-rpn")
    while page.evaluate("document.activeElement.value") != "mix":
        page.keyboard.press("ArrowRight")
    tab_to(page, "#mix-weights")
    page.keyboard.type("1,3")
    tab_to(page, "#input-2-sample", "Shift+Tab")
    page.keyboard.type("Mossy")
    tab_to(page, "#input-2 .box", "Shift+Tab")
    page.keyboard.press("Control+Shift+ArrowLeft")
    page.keyboard.press("ArrowDown")
    assert crop_of(page, 2) == [64, 301, 374, 384]
    tab_to(page, "button.main")
    page.keyboard.press("Enter")
    page.wait_for_url("**/experiments/*")
    expect(page.locator(".viewer.live")).to_be_visible()
    record = record_of(site, page)
    assert record["inputs"][1] == {
        "sample": "grass_jungle002",
        "crop": dict(zip(SIDES, (64, 301, 374, 384), strict=True)),
        "frames": {"first": 0, "count": 1},
    }
    assert record["parameters"]["weights"] == "1,3"


def test_two_samples_without_a_script(visitors: Any, site: Any, photograph: Path) -> None:
    """Choose one and look at it, upload another instead; the crop left empty is the middle."""
    page = visitors.visit("/samples/gravel_gray?crop=96,96,160,160", java_script_enabled=False)
    expect(page.locator("#input-2")).to_be_hidden()
    page.get_by_text("Mix", exact=True).click()
    page.locator("#input-2-sample").select_option(label="Mossy grass")
    page.locator("#input-2").get_by_role("button", name="Show").click()
    expect(page.locator("#method-mix")).to_be_checked()
    expect(page.locator("#input-2 .frame img")).to_have_attribute(
        "src", re.compile(r"^/api/v1/samples/grass_jungle002/image\?size=2048&v=[0-9a-f]{12}-")
    )
    page.get_by_text("Add another sample").first.click()
    page.set_input_files("#input-3-file", photograph)
    page.get_by_role("button", name="Synthesise").click()
    expect(page.get_by_role("heading", name="Time by stage")).to_be_visible()
    expect(page.locator(".pane img")).to_have_count(4)
    boxes = [[source["crop"][side] for side in SIDES] for source in record_of(site, page)["inputs"]]
    assert boxes == [[96, 96, 160, 160], [64, 300, 384, 384], [256, 256, 512, 512]]


def test_enter_in_a_field_runs_the_form_without_a_script(visitors: Any) -> None:
    """And does not press the button that only shows the second sample, which stands before the main one."""
    page = visitors.visit(MIX, java_script_enabled=False)
    page.locator("#seed").press("Enter")
    page.wait_for_url("**/experiments/*")


def test_what_is_chosen_in_any_order_is_what_runs(visitors: Any, site: Any) -> None:
    """Size, method, crop, other method and back, another sample after its crop, a third one taken and left out."""
    page = visitors.visit("/samples/gravel_gray")
    page.select_option("#size", "2")
    page.get_by_text("Mix", exact=True).click()
    page.locator("#input-2").get_by_role("button", name="Whole photograph").click()
    page.get_by_text("RPN", exact=True).click()
    expect(page.locator("#input-2")).to_be_hidden()
    for side, number in zip(SIDES, (20, 30, 64, 48), strict=True):
        page.fill(f"#crop-{side}", str(number))
    page.get_by_text("Mix", exact=True).click()
    page.get_by_text("Add another sample").first.click()
    page.locator("#input-3-sample").select_option(label="Red towel")
    page.get_by_text("Leave the third sample out").click()
    page.get_by_role("button", name="New seed").click()
    page.locator("#input-2-sample").select_option(label="Mossy grass")
    assert crop_of(page, 2) == [64, 300, 384, 384]
    seed = int(page.input_value("#seed"))
    run(page)
    record = record_of(site, page)
    assert [source["sample"] for source in record["inputs"]] == ["gravel_gray", "grass_jungle002"]
    assert [record["parameters"][name] for name in ("width", "height", "seed")] == [128, 96, seed]


def test_another_photograph_is_uploaded_beside_the_first(visitors: Any, site: Any, photograph: Path) -> None:
    visitors.refusals_expected = True
    page = visitors.visit(MIX)
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Upload another").click()
    chooser.value.set_files(photograph)
    expect(page.locator("#input-2-sample")).not_to_have_value("sand_desert009")
    assert crop_of(page, 2) == [256, 256, 512, 512]
    uploaded = page.input_value("#input-2-sample")
    page.set_input_files("#input-2-file", Path("samples/catalogue.json"))
    expect(page.locator("#input-2 .sending")).to_contain_text("PNG")
    assert page.input_value("#input-2-sample") == uploaded
    run(page)
    assert record_of(site, page)["inputs"][1]["sample"] == uploaded


def test_nothing_is_run_while_photographs_are_on_their_way(visitors: Any, photograph: Path) -> None:
    """It would be run without them: the button comes back with the last one, also where that was refused."""
    visitors.refusals_expected = True
    page = visitors.visit("/samples/gravel_gray?method=mix&crop=96,96,160,160&third=sand_desert009")
    held: list[Route] = []

    def hold(route: Route) -> None:
        held.append(route)

    page.route("**/api/v1/samples", hold)
    button = page.get_by_role("button", name="Synthesise")
    for number, path in ((2, photograph), (3, Path("samples/catalogue.json"))):
        page.set_input_files(f"#input-{number}-file", path)
        expect(page.locator(f"#input-{number} .sending")).to_have_text("Sending …")
        expect(button).to_be_disabled()
    held[0].continue_()
    expect(page.locator("#input-2 .sending")).to_have_text("")
    expect(button).to_be_disabled()
    held[1].continue_()
    expect(page.locator("#input-3 .sending")).to_contain_text("PNG")
    expect(button).to_be_enabled()


def test_back_and_reload_find_every_sample_and_crop(visitors: Any) -> None:
    page = visitors.visit(MIX)
    page.locator("#input-2-sample").select_option(label="Mossy grass")
    for side, number in zip(SIDES, (10, 20, 120, 90), strict=True):
        page.fill(f"#input-2-crop-{side}", str(number))
    page.fill("#mix-weights", "2,1")
    run(page)
    page.go_back()
    for _ in range(2):
        expect(page.locator("#method-mix")).to_be_checked()
        expect(page.locator("#input-2-sample")).to_have_value("grass_jungle002")
        expect(page.locator("#input-2-frame img")).to_have_attribute(
            "src", re.compile(r"^/api/v1/samples/grass_jungle002/image\?size=2048&v=[0-9a-f]{12}-")
        )
        assert crop_of(page, 2) == [10, 20, 120, 90]
        expect(page.locator("#mix-weights")).to_have_value("2,1")
        page.goto(page.url)
    page.goto(page.url)
    run(page)
    page.get_by_role("link", name="Change crop, size or parameters").click()
    page.wait_for_url("**/samples/*")
    assert crop_of(page, 2) == [10, 20, 120, 90]
    expect(page.locator("#mix-weights")).to_have_value("2,1")


def test_a_method_finds_the_size_of_its_own_texture(visitors: Any, site: Any) -> None:
    """Where that is not the first crop's, the form leaves it to the method, and says why another one is refused."""
    visitors.refusals_expected = True
    page = visitors.visit("/samples/gravel_gray?method=modulus-phase&crop=0,0,200,100&second=scene_china:0,0,120,300")
    expect(page.locator("#width")).to_have_value("")
    page.select_option("#size", "2")
    expect(page.locator("#width")).to_have_value("400")
    page.get_by_role("button", name="Synthesise").click()
    expect(page.locator("#width-error")).to_contain_text("Choose a width of at most 120 pixels instead of 400")
    page.select_option("#size", "1")
    run(page)
    assert [record_of(site, page)["parameters"][side] for side in ("width", "height")] == [120, 100]

"""The structure meter: it follows the crop, speaks when its word changes, and has a page that explains it."""

import itertools
import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

GROUND, PAVING = "crop=190,60,256,256", "crop=80,80,320,320"
METER = "[data-input='1'] .structure"


def number(page: Page) -> float:
    return float(page.locator(f"{METER} .meter-number").inner_text())


def questions(page: Page, crop: str) -> list[dict[str, Any]]:
    """Every question that the page has asked, in order, once the one about this crop is answered."""
    page.wait_for_function(
        "crop => performance.getEntriesByType('resource').some(entry => entry.name.endsWith('structure?crop=' + crop))",
        arg=crop,
    )
    entries = page.evaluate("performance.getEntriesByType('resource').map(entry => entry.toJSON())")
    return [entry for entry in entries if "/structure?crop=" in entry["name"]]


def test_the_meter_says_what_the_opened_crop_is(visitors: Any, site: Any) -> None:
    for sample, crop, word in [("rockface_pink", GROUND, "Micro-texture"), ("crazy_paving001", PAVING, "Structured")]:
        page = visitors.visit(f"/samples/{sample}?{crop}")
        expect(page.locator(f"{METER} .structure-words")).to_contain_text(word)
        record = site.client.get(f"/api/v1/samples/{sample}/structure?{crop}").json()
        assert number(page) == pytest.approx(record["delta"], abs=0.0051)
        assert page.locator(f"{METER} a").get_attribute("href") == "/structure"


def test_it_follows_the_crop_while_that_is_dragged_with_one_question_at_a_time(visitors: Any) -> None:
    page = visitors.visit("/samples/soil_ground010?crop=16,16,512,512")
    questions(page, "16,16,512,512")
    box = page.locator(".box").first.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, 41):
        page.mouse.move(x + 2 * step, y + step)
    page.mouse.up()
    crop = ",".join(page.locator(f"#crop-{side}").input_value() for side in ("x", "y", "width", "height"))
    asked = questions(page, crop)
    assert crop != "16,16,512,512"
    assert 2 <= len(asked) <= 41
    assert asked[-1]["name"].endswith(crop)
    for before, after in itertools.pairwise(asked):
        assert before["responseEnd"] <= after["startTime"]


def test_its_sentence_is_announced_only_when_it_changes(visitors: Any) -> None:
    page = visitors.visit(f"/samples/crazy_paving001?{PAVING}")
    sentence = page.locator(f"{METER} .structure-words")
    expect(sentence).to_contain_text("Structured")
    assert sentence.get_attribute("aria-live") == "polite"
    sentence.evaluate(
        """sentence => {
            window.announced = 0;
            const watch = new MutationObserver(() => window.announced++);
            watch.observe(sentence, {childList: true, characterData: true, subtree: true});
        }"""
    )
    page.locator("#crop-width").fill("200")
    questions(page, "80,80,200,320")
    page.locator("#crop-width").fill("201")
    questions(page, "80,80,201,320")
    expect(sentence).to_contain_text("Structured")
    assert page.evaluate("window.announced") == 0


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("width", [1440, 390])
def test_its_page_places_every_photograph_and_is_accessible(
    visitors: Any, site: Any, theme: str, width: int, assert_accessible: Callable[[Page], None], screenshot: Any
) -> None:
    page = visitors.visit("/structure", color_scheme=theme, viewport={"width": width, "height": 900})
    page.wait_for_load_state("networkidle")
    samples = site.client.get("/api/v1/samples").json()["samples"]
    textures = [entry for entry in samples if entry["id"] != "scene_china" and entry["frames"] == 1]
    expect(page.locator(".photographs li")).to_have_count(len(textures))
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    shown = [float(text) for text in page.locator(".photographs .meter-number").all_inner_texts()]
    assert shown == sorted(shown)
    assert_accessible(page)
    screenshot(page, f"structure-{'phone-' if width == 390 else ''}{theme}")


def test_without_a_script_the_page_and_its_links_work(visitors: Any) -> None:
    page = visitors.visit("/structure", java_script_enabled=False)
    page.locator(".photographs a", has_text="Soil").click()
    expect(page).to_have_url(
        re.compile(r"/samples/soil_ground010\?(.*&)?crop\.x=416&crop\.y=352&crop\.width=512&crop\.height=512")
    )
    expect(page.locator(METER)).to_contain_text("Structured")


def test_a_crop_of_a_few_pixels_is_too_small_to_tell_and_a_larger_one_is_told_again(visitors: Any) -> None:
    page = visitors.visit("/samples/rockface_pink?crop=190,60,256,256")
    words, shown = page.locator(f"{METER} .structure-words"), page.locator(f"{METER} .meter-number")
    expect(words).to_contain_text("Micro-texture")
    for width, sentence in (("31", "Too small to tell"), ("32", "Micro-texture"), ("3", "Too small to tell")):
        page.locator("#crop-width").fill(width)
        page.locator("#crop-width").press("Tab")
        expect(words).to_contain_text(sentence)
        expect(shown).to_be_visible(visible=sentence == "Micro-texture")

"""An experiment's page: pictures beside and upon each other, the other model, progress, cancelling, snippets."""

import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

CROP = ".pane:nth-child(1) img"
TEXTURE = ".pane:nth-child(2) img"


def scale_of(page: Page, selector: str) -> tuple[float, float]:
    """A picture's scale on the screen, and its centre's place on its stage."""
    return tuple(
        page.evaluate(
            """selector => {
                const image = document.querySelector(selector), box = image.getBoundingClientRect();
                const stage = image.closest(".stage").getBoundingClientRect();
                const centre = box.x + box.width / 2 - stage.x - stage.width / 2;
                return [box.width / image.naturalWidth, centre];
            }""",
            selector,
        )
    )


def test_pictures_are_at_the_same_scale_and_move_together(visitors: Any, experiment: dict[str, Any]) -> None:
    page = visitors.visit(f"/experiments/{experiment['id']}")
    expect(page.locator(".viewer.live")).to_be_visible()
    assert scale_of(page, CROP) == pytest.approx(scale_of(page, TEXTURE), abs=1)
    stage = page.locator(".stage").nth(1).bounding_box()
    assert stage is not None
    page.mouse.move(stage["x"] + 300, stage["y"] + 200)
    page.keyboard.down("Control")
    page.mouse.wheel(0, -800)
    page.keyboard.up("Control")
    page.wait_for_function("() => parseInt(document.querySelector('.scale').textContent) > 200")
    page.mouse.down()
    page.mouse.move(stage["x"] + 240, stage["y"] + 200, steps=3)
    page.mouse.up()
    (scale, centre), (other, other_centre) = scale_of(page, CROP), scale_of(page, TEXTURE)
    assert scale == pytest.approx(other, rel=1e-3)
    assert centre == pytest.approx(other_centre, abs=1)
    assert page.evaluate(f"getComputedStyle(document.querySelector('{TEXTURE}')).imageRendering") == "pixelated"


def test_zoom_stays_between_a_quarter_and_sixteen(visitors: Any, experiment: dict[str, Any]) -> None:
    page = visitors.visit(f"/experiments/{experiment['id']}")
    zoom_in, zoom_out = (page.get_by_role("button", name=f"Zoom {way}") for way in ("in", "out"))
    for _ in range(12):
        zoom_in.click()
    assert page.locator(".scale").inner_text() == "1600 %"
    for _ in range(14):
        zoom_out.click()
    assert page.locator(".scale").inner_text() == "25 %"
    page.get_by_role("button", name="1 : 1").click()
    assert page.locator(".scale").inner_text() == "100 %"


def test_flip_shows_one_picture_in_the_place_of_the_other(visitors: Any, experiment: dict[str, Any]) -> None:
    page = visitors.visit(f"/experiments/{experiment['id']}")
    page.get_by_role("link", name="Flip").click()
    expect(page).to_have_url(re.compile(r"\?view=flip$"))
    images = page.locator(".over .stage img")
    expect(images.nth(0)).to_be_hidden()
    expect(images.nth(1)).to_be_visible()
    hold = page.get_by_role("button", name="Hold for the sample")
    hold.hover()
    page.mouse.down()
    expect(images.nth(0)).to_be_visible()
    expect(images.nth(1)).to_be_hidden()
    page.mouse.up()
    expect(images.nth(1)).to_be_visible()
    page.locator(".panes").press("f")
    expect(images.nth(0)).to_be_visible()


def test_the_slider_divides_the_pictures(visitors: Any, experiment: dict[str, Any]) -> None:
    page = visitors.visit(f"/experiments/{experiment['id']}?view=slider")
    divider = page.get_by_role("slider")
    expect(divider).to_have_attribute("aria-valuenow", "50")
    divider.press("PageUp")
    expect(divider).to_have_attribute("aria-valuenow", "60")
    grip, stage = divider.bounding_box(), page.locator(".pane:not([hidden]) .stage").bounding_box()
    assert grip is not None
    assert stage is not None
    page.mouse.move(grip["x"] + 16, grip["y"] + 40)
    page.mouse.down()
    page.mouse.move(stage["x"] + stage["width"] / 4, grip["y"] + 40, steps=3)
    page.mouse.up()
    expect(divider).to_have_attribute("aria-valuenow", "25")
    assert "inset" in page.evaluate("document.querySelector('.stage img').style.clipPath")


def test_tiled_repeats_the_texture_without_a_seam(
    visitors: Any, experiment: dict[str, Any], shown_pixels: Callable[..., np.ndarray], screenshot: Callable[..., None]
) -> None:
    """The background repeats at a whole number of pixels a tile, and the texture's edges go on where they end."""
    page = visitors.visit(f"/experiments/{experiment['id']}?view=tiled")
    page.get_by_role("button", name="3 × 3").click()
    tile = page.locator(".pane:nth-child(2) .tile")
    expect(tile).to_be_visible()
    page.get_by_role("button", name="1 : 1").click()
    width, height = experiment["outputs"][0]["width"], experiment["outputs"][0]["height"]
    assert tile.evaluate("element => element.style.backgroundSize") == f"{width}px {height}px"
    texture = shown_pixels(page, TEXTURE).astype(float)
    sample = shown_pixels(page, CROP).astype(float)
    for axis in (0, 1):
        inside = np.abs(np.diff(texture, axis=axis)).mean(axis=(1 - axis, 2))
        over = np.abs(texture.take(0, axis) - texture.take(-1, axis)).mean()
        assert over < inside.mean() + 4 * inside.std()
    # The sample itself does not tile: that is what the view shows beside it.
    inside = np.abs(np.diff(sample, axis=0)).mean(axis=(1, 2))
    assert np.abs(sample[0] - sample[-1]).mean() > inside.mean() + 4 * inside.std()
    screenshot(page, "experiment-tiled", full_page=False)


def test_steps_are_pictures(visitors: Any, experiment: dict[str, Any]) -> None:
    page = visitors.visit(f"/experiments/{experiment['id']}")
    page.get_by_role("link", name="Steps").click()
    expect(page.locator(".steps img")).to_have_count(7)
    page.get_by_role("link", name="Side by side").click()
    expect(page.locator(".steps")).to_be_hidden()
    expect(page.locator(TEXTURE)).to_be_visible()


def test_the_other_model_at_the_same_phase_stands_beside_it(
    visitors: Any, experiment: dict[str, Any], shown_pixels: Callable[..., np.ndarray], screenshot: Callable[..., None]
) -> None:
    """One button leads to sample, RPN and ADSN in one gallery; at one phase both are light in the same places."""
    page = visitors.visit(f"/experiments/{experiment['id']}")
    page.get_by_role("button", name="ADSN with the same phase").click()
    page.wait_for_url("**/compare/*/*")
    expect(page.locator(".viewer.live")).to_be_visible()
    expect(page.get_by_text("Same crop, same seed, same phase")).to_be_visible()
    names = page.locator(".pane:not([hidden]) figcaption")
    expect(names).to_contain_text(["Sample", "RPN", "ADSN"])
    rpn, adsn = (shown_pixels(page, f".pane:nth-child({place}) img").astype(float) for place in (2, 3))
    # The modulus differs by Rayleigh factors r: the correlation is E[r] / sqrt(E[r²]) = sqrt(π) / 2 = 0.886 but for few
    # strong frequencies; with another phase it would be about 0.
    assert np.corrcoef(rpn.mean(2).ravel(), adsn.mean(2).ravel())[0, 1] > 0.6
    screenshot(page, "compare")


def test_a_running_experiment_shows_progress_and_can_be_cancelled(
    visitors: Any, site: Any, screenshot: Callable[..., None], until: Callable[..., Any]
) -> None:
    page = visitors.visit("/samples/grass_jungle002?crop=0,0,1024,1024&width=8192&height=8192")
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    bar = page.get_by_role("progressbar")
    expect(bar).to_be_visible()
    page.wait_for_function("() => document.querySelector('[role=progressbar]')?.getAttribute('aria-valuenow') > 0")
    expect(page.locator("[data-live]")).not_to_be_empty()
    screenshot(page, "experiment-running")
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_role("heading", name="Cancelled")).to_be_visible()
    identifier = page.url.rsplit("/", 1)[-1]
    assert site.client.get(f"/api/v1/experiments/{identifier}").json()["status"] == "cancelled"
    screenshot(page, "experiment-cancelled")


def test_the_finished_page_replaces_the_waiting_room_without_a_reload(visitors: Any, site: Any) -> None:
    page = visitors.visit("/samples/gravel_gray?crop=0,0,256,256&width=2048&height=2048")
    page.evaluate("sessionStorage.clear()")
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    waited = page.locator("[data-experiment]").count() > 0
    page.evaluate("window.sameDocument = true")
    expect(page.locator(".viewer.live")).to_be_visible()
    assert page.evaluate("window.sameDocument") or not waited
    expect(page.get_by_role("heading", name="Time by stage")).to_be_visible()


def test_polling_takes_over_where_events_fail(visitors: Any) -> None:
    """A proxy that swallows server-sent events does not keep the page waiting."""
    visitors.refusals_expected = True
    page = visitors.visit("/samples/gravel_gray?crop=0,0,256,256&width=1200&height=1200")
    page.route("**/events", lambda route: route.fulfill(status=404, body=""))
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    expect(page.locator(".viewer.live")).to_be_visible()


@pytest.fixture(scope="session")
def mixture(site: Any) -> dict[str, Any]:
    """A finished mixture of three crops of two samples."""
    crops = {"x": 40, "y": 30, "width": 96, "height": 80}, {"x": 200, "y": 160, "width": 80, "height": 96}
    samples = ("gravel_gray", "sand_desert009", "gravel_gray")
    inputs = [{"sample": sample, "crop": crops[place % 2]} for place, sample in enumerate(samples)]
    body = {"method": "mix", "inputs": inputs, "parameters": {"weights": "1,2,1", "width": 128, "seed": 5}}
    answer = site.client.post("/api/v1/experiments", json=body, headers={"Prefer": "wait=30"})
    assert answer.status_code == 201, answer.text
    return dict(answer.json())


@pytest.mark.parametrize("language", ["curl", "Command line", "Python"])
@pytest.mark.parametrize("kind", ["experiment", "mixture"])
def test_the_same_run_elsewhere_gives_the_same_bytes(
    visitors: Any, site: Any, request: pytest.FixtureRequest, kind: str, language: str, tmp_path: Path
) -> None:
    """What the page shows is copied by its button, pasted and run: the picture is the page's, byte for byte."""
    experiment = request.getfixturevalue(kind)
    page = visitors.visit(f"/experiments/{experiment['id']}", permissions=["clipboard-read", "clipboard-write"])
    snippet = page.locator(".snippet").filter(has=page.get_by_role("heading", name=language, exact=True))
    snippet.get_by_role("button", name="Copy").click()
    expect(snippet.get_by_text("Copied")).to_be_visible()
    text = page.evaluate("navigator.clipboard.readText()")
    command = [sys.executable, "-c", text] if language == "Python" else ["sh", "-c", text]
    installed = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    subprocess.run(command, cwd=tmp_path, check=True, timeout=60, env={**os.environ, "PATH": installed})
    original = site.client.get(f"/api/v1/experiments/{experiment['id']}/outputs/texture").content
    assert (tmp_path / "texture.png").read_bytes() == original


def test_its_owner_unlists_and_deletes_it(visitors: Any, site: Any) -> None:
    visitors.refusals_expected = True
    page = visitors.visit("/samples/gravel_gray?crop=0,0,64,64")
    page.get_by_role("button", name="Synthesise").click()
    page.wait_for_url("**/experiments/*")
    expect(page.locator(".viewer.live")).to_be_visible()
    address = page.url
    page.get_by_role("button", name="Remove from the archive").click()
    expect(page.get_by_text("unlisted")).to_be_visible()
    page.get_by_text("Delete …").click()
    page.get_by_role("button", name="Delete it").click()
    page.wait_for_url("**/archive")
    answer = page.goto(address)
    assert answer is not None
    assert answer.status == 410
    expect(page.get_by_role("heading", name="Deleted")).to_be_visible()

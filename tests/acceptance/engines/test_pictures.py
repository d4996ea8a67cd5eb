"""The whole way of a photograph in Chromium, Firefox and WebKit: from its file to the archive, and out again."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.acceptance.engines.walk import CROP, TEXTURE, crop_of, on_sample, run, scale_of, upload
from tests.acceptance.engines.window import Window, difference, pixels

WIDTH, HEIGHT = 320, 256  # of the texture: two by two fit on the screen
GRIP = 24  # pixels beside a divider that its handle may cover


def test_the_whole_way_of_a_photograph(window: Window, photograph: Path, busy: Callable[..., Any]) -> None:
    upload(window, photograph)
    original = np.asarray(Image.open(photograph).convert("RGB"))
    x, y, width, height = cut(window, original)
    choose_method_and_size(window)
    path = run(window, window.click, busy)
    sample = original[y : y + height, x : x + width]
    texture = assert_result(window, sample)
    window.open(path)
    assert np.array_equal(assert_result(window, sample), texture)
    flip(window, sample, texture)
    slide(window, sample, texture)
    tile(window, texture)
    steps(window)
    zoom(window)
    download(window, texture)
    again, other = run_again(window, path, texture)
    compare(window, other)
    delete_from_archive(window, again)


def cut(window: Window, original: np.ndarray) -> list[int]:
    """Draw a crop, pull its corner, move it, and nudge it by keys; what the fields say in the end."""
    scale = scale_of(window)
    slack = 1.5 / scale  # where a pixel of the screen ends
    window.drag([on_sample(window, *point) for point in ((40, 60), (200, 150), (240, 220))])
    assert crop_of(window) == pytest.approx([40, 60, 200, 160], abs=slack)
    x, y = window.place(".handle[data-edge=se]")
    window.drag([(x, y), (x + 30 * scale, y + 50 * scale), (x + 60 * scale, y + 40 * scale)])
    assert crop_of(window) == pytest.approx([40, 60, 260, 200], abs=slack)
    window.drag([on_sample(window, 140, 140), on_sample(window, 200, 200), on_sample(window, 240, 190)])
    x, y, width, height = crop_of(window)
    assert [x, y, width, height] == pytest.approx([140, 110, 260, 200], abs=slack)
    for keys in ("ArrowLeft", "Control+ArrowDown", "Shift+ArrowRight", "Control+Shift+ArrowUp"):
        window.press(keys)
    assert crop_of(window) == [x - 1, y + 10, width + 1, height - 10]
    x, y, width, height = crop_of(window)
    window.has("#crop-size", f"{width} × {height} of 1024 × 1024")
    seen = window.seen(".box")
    upper = slice(8, seen.shape[0] // 2)  # without handles and readout
    kept = Image.fromarray(original[y : y + height, x : x + width]).resize(seen.shape[1::-1], Image.Resampling.BOX)
    both = [coarse(picture[upper, 8:-8]) for picture in (seen, np.asarray(kept))]
    assert np.corrcoef(both[0], both[1])[0, 1] > 0.8
    return [x, y, width, height]


def coarse(picture: np.ndarray) -> np.ndarray:
    """Means of parts of a picture, which all ways of resizing it have in common."""
    return np.asarray(Image.fromarray(picture).convert("F").resize((16, 12), Image.Resampling.BOX)).ravel()


def choose_method_and_size(window: Window) -> None:
    window.until(
        "() => /^\\d\\.\\d\\d$/.test(document.querySelector('.structure:not(.unknown) .meter-number')?.textContent)"
    )
    window.click("label", "ADSN")
    window.has("#run-size", "ADSN, ")
    window.fill("#width", str(WIDTH))
    window.fill("#height", str(HEIGHT))
    window.has("#run-size", f"ADSN, {WIDTH} × {HEIGHT} pixels")


def assert_result(window: Window, sample: np.ndarray) -> np.ndarray:
    """Sample and texture are on the screen, pixel for pixel; the texture."""
    window.has("h1", "ADSN")
    window.has(".viewer.live")
    assert np.array_equal(window.decoded(CROP), sample)
    texture = window.decoded(TEXTURE)
    assert texture.shape == (HEIGHT, WIDTH, 3)
    # The mean of all pixels is kept but for rounding; their spread but for the smooth component.
    assert np.abs(texture.mean((0, 1)) - sample.mean((0, 1))).max() < 1
    assert 0.6 < texture.std() / sample.std() < 1.2
    window.click("[data-zoom=one]")
    window.shows(CROP, sample)
    window.shows(TEXTURE, texture)
    return texture


def flip(window: Window, sample: np.ndarray, texture: np.ndarray) -> None:
    window.click(".views a", "Flip")
    window.click("[data-zoom=one]")
    window.shows(".over .stage img:nth-of-type(2)", texture)
    window.click("[data-flip='0']")
    window.shows(".over .stage img:nth-of-type(1)", sample)


def slide(window: Window, sample: np.ndarray, texture: np.ndarray) -> None:
    """Left of the divider is the sample, right of it the texture, wherever it is drawn to."""
    window.click(".views a", "Slider")
    window.click("[data-zoom=one]")
    stage = ".over .stage"
    left, _, width, _ = window.bounds(stage)
    for part in (0.45, 0.53):
        grip = window.place(".divider")
        window.drag([grip, (left + width / 2, grip[1]), (left + part * width, grip[1])])
        window.until(
            "(part) => document.querySelector('.divider').getAttribute('aria-valuenow') === part",
            str(round(100 * part)),
        )
        shown = pixels(window.capture())
        border = left + part * width
        for number, picture in enumerate((sample, texture), 1):
            x, y, wide, high = (round(side) for side in window.bounds(f"{stage} img:nth-of-type({number})"))
            first, end = (x, round(border) - GRIP) if number == 1 else (round(border) + GRIP, x + wide)
            assert end - first > GRIP
            assert difference(shown[y : y + high, first:end], picture[:, first - x : end - x]) < 1


def tile(window: Window, texture: np.ndarray) -> None:
    window.click(".views a", "Tiled")
    window.click("[data-tiles='2']")
    window.click("[data-zoom=one]")
    window.shows(".pane:nth-child(2) .tile", np.tile(texture, (2, 2, 1)))


def steps(window: Window) -> None:
    """All pictures on the way are there."""
    window.click(".views a", "Steps")
    window.has(".steps")
    count = window.look("() => document.querySelectorAll('.steps img').length")
    assert count == 7
    for place in range(1, count + 1):
        window.place(f".steps li:nth-child({place}) img")
        assert window.decoded(f".steps li:nth-child({place}) img").std() > 0


def zoom(window: Window) -> None:
    """By keys, by the wheel and back; both pictures at the same scale."""
    window.click(".views a", "Side by side")
    window.click(CROP)
    fitted = window.has(".scale")
    window.press("1")
    window.has(".scale", "100 %")
    window.write("+")
    window.has(".scale", "141 %")
    window.wheel(window.place(TEXTURE), -240)
    window.until("() => parseInt(document.querySelector('.scale').textContent) > 200")
    scale = "(each) => each.getBoundingClientRect().width / each.width"
    scales = [window.look(f"(picture) => ({scale})(document.querySelector(picture))", each) for each in (CROP, TEXTURE)]
    assert scales[0] == pytest.approx(scales[1], rel=1e-3)
    assert scales[0] > 2
    window.press("0")
    window.has(".scale", fitted)


def download(window: Window, texture: np.ndarray) -> None:
    """The file that is kept is the picture that is shown."""
    path = window.download(lambda: window.click(".downloads a"))
    with Image.open(path) as kept:
        assert kept.format == "PNG"
        assert np.array_equal(np.asarray(kept.convert("RGB")), texture)


def run_again(window: Window, before: str, texture: np.ndarray) -> tuple[str, np.ndarray]:
    """With another seed: another texture at another address."""
    window.click(".again button", "New seed")
    window.until("(before) => location.pathname.startsWith('/experiments/') && location.pathname !== before", before)
    path = window.at("/experiments/")
    window.has(".downloads")
    other = window.decoded(TEXTURE)
    assert other.shape == texture.shape
    assert difference(other, texture) > 1
    return path, other


def compare(window: Window, texture: np.ndarray) -> None:
    """Sample, this texture and that of the other model beside each other."""
    window.click(".again button", "RPN with the same phase")
    window.at("/compare/")
    window.has("table.both")
    rpn, adsn = (window.decoded(f".pane:nth-child({place}) .stage img") for place in (2, 3))
    if window.has(".pane:nth-child(2) figcaption").startswith("ADSN"):
        rpn, adsn = adsn, rpn
    assert np.array_equal(adsn, texture)
    assert rpn.shape == texture.shape
    assert np.corrcoef(rpn.mean(2).ravel(), adsn.mean(2).ravel())[0, 1] > 0.6  # one phase: see test_experiment.py
    window.click("[data-zoom=one]")
    window.shows(".pane:nth-child(3) .stage img", window.decoded(".pane:nth-child(3) .stage img"))


def delete_from_archive(window: Window, path: str) -> None:
    """It is found in the archive, opened, and deleted for good."""
    window.click("header a", "Archive")
    window.at("/archive")
    entry = f".pair[href='{path}']"
    for picture in (1, 2):
        window.place(f"{entry} img:nth-of-type({picture})")
        assert window.decoded(f"{entry} img:nth-of-type({picture})").std() > 0
    window.click(entry)
    window.at(path)
    window.click(".confirm summary")
    window.click(".confirm button", "Delete it")
    window.at("/archive")
    window.has("h1", "Archive")
    window.lacks(entry)
    window.open(path)
    window.has("h1", "Deleted")

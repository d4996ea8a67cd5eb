"""The way of a photograph by fingers alone, on a phone: they scroll, draw, move, take back, pinch and run."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.acceptance.engines.walk import CROP, TEXTURE, crop_of, on_sample, run, scale_of, upload
from tests.acceptance.engines.window import PATIENCE, Window
from tests.acceptance.waiting import until

SCROLLED = "() => scrollY"


def test_the_way_of_a_photograph_by_fingers(phone: Window, photograph: Path, busy: Callable[..., Any]) -> None:
    upload(phone, photograph)
    scroll_over_photograph(phone)
    x, y, width, height = cut(phone)
    phone.tap("label", "ADSN")
    phone.has("#run-size", f"ADSN, {width} × {height} pixels")
    path = run(phone, phone.tap, busy)
    phone.has(".viewer.live")
    original = np.asarray(Image.open(photograph).convert("RGB"))
    assert np.array_equal(phone.decoded(CROP), original[y : y + height, x : x + width])
    assert phone.decoded(TEXTURE).shape == (height, width, 3)
    pinch_pictures(phone)
    slide(phone)
    phone.tap(".confirm summary")
    phone.tap(".confirm button", "Delete it")
    phone.at("/archive")
    phone.open(path)
    phone.has("h1", "Deleted")


def scroll_over_photograph(phone: Window) -> None:
    """A swipe over the photograph, beside the crop, scrolls the page and leaves the crop alone."""
    before = crop_of(phone)
    phone.place("#frame")
    start, end = on_sample(phone, 60, 900), on_sample(phone, 100, 120)
    scrolled = phone.look(SCROLLED)
    phone.fingers([[start, end]])
    if phone.fingers_scroll:
        phone.until("(before) => scrollY > before + 100", scrolled)
    assert crop_of(phone) == before


def cut(phone: Window) -> list[int]:
    """Draw a crop after asking to, pull its corner, move it, take that back, and look closer; the crop."""
    whole = crop_of(phone)
    phone.place("#frame")
    phone.tap("[data-tool=draw]")
    phone.has("[data-tool=draw][aria-pressed=true]")
    phone.place("#frame")
    slack = 1.5 / scale_of(phone)
    phone.fingers([[on_sample(phone, 200, 300), on_sample(phone, 700, 700)]])
    drawn = crop_of(phone)
    assert drawn != whole
    assert drawn == pytest.approx([200, 300, 500, 400], abs=slack)
    x, y = phone.place(".handle[data-edge=se]")
    scale = scale_of(phone)
    phone.fingers([[(x, y), (x - 100 * scale, y - 60 * scale)]])
    resized = crop_of(phone)
    assert resized == pytest.approx([200, 300, 400, 340], abs=slack)
    phone.place(".box")
    phone.fingers([[on_sample(phone, 400, 470), on_sample(phone, 460, 500)]])
    assert crop_of(phone) == pytest.approx([260, 330, 400, 340], abs=slack)
    phone.tap("[data-tool=undo]")
    until(lambda: crop_of(phone) == resized, "the crop as it was before it was moved", PATIENCE)
    phone.place("#frame")
    pinch(phone, on_sample(phone, 400, 470))
    phone.has("#frame.zoomed")
    assert crop_of(phone) == resized
    phone.tap("[data-tool=fit]")
    phone.lacks("#frame.zoomed")
    return resized


def pinch(phone: Window, middle: tuple[float, float]) -> None:
    """Two fingers go apart from a point."""
    x, y = middle
    phone.fingers([[(x - 20, y - 20), (x - 70, y - 70)], [(x + 20, y + 20), (x + 70, y + 70)]])


def pinch_pictures(phone: Window) -> None:
    """Two fingers apart on one picture bring both nearer; at rest one finger scrolls the page."""
    fitted = phone.has(".scale")
    place = phone.place(TEXTURE)
    scrolled = phone.look(SCROLLED)
    phone.fingers([[place, (place[0], place[1] - 150)]])
    if phone.fingers_scroll:
        phone.until("(before) => scrollY > before + 50", scrolled)
    pinch(phone, phone.place(TEXTURE))
    phone.until("(fitted) => parseInt(document.querySelector('.scale').textContent) > 1.5 * parseInt(fitted)", fitted)
    phone.tap("[data-zoom=fit]")
    phone.has(".scale", fitted)


def slide(phone: Window) -> None:
    phone.tap(".views a", "Slider")
    left, _, width, _ = phone.bounds(".over .stage", scroll=True)
    grip = phone.place(".divider")
    phone.fingers([[grip, (left + 0.75 * width, grip[1])]])
    phone.until("() => document.querySelector('.divider').getAttribute('aria-valuenow') === '75'")

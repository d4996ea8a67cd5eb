"""Parts of the way through the pages that pictures and clips, pointer and fingers, have in common."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

from tests.acceptance.engines.window import Point, Window

CROP, TEXTURE = (f".pane:nth-child({place}) .stage :is(img, video)" for place in (1, 2))

# Keeps what the waiting room says from now on, and marks the document, which a reload would replace.
LISTEN = """() => {
    window.sameDocument = true;
    window.said = [];
    const card = document.querySelector("[data-experiment]");
    const listen = () => {
        const part = card.querySelector("[role=progressbar]").getAttribute("aria-valuenow");
        window.said.push([card.querySelector("[data-status]").textContent, Number(part)]);
    };
    listen();
    const all = { subtree: true, childList: true, characterData: true, attributes: true };
    new MutationObserver(listen).observe(card, all);
}"""


def upload(window: Window, path: Path) -> None:
    """Choose a file on the home page; its own page comes by itself."""
    window.has("#choose")
    window.choose("#file", path)
    window.at("/samples/")
    window.has("#frame.ready")


def crop_of(window: Window) -> list[int]:
    """What the fields of the crop say: x, y, width, height."""
    return list(
        window.look(
            "() => ['x', 'y', 'width', 'height'].map((side) => Number(document.querySelector(`#crop-${side}`).value))"
        )
    )


def scale_of(window: Window) -> float:
    """How many pixels of the screen a pixel of the sample takes."""
    return float(
        window.look("() => { const f = document.querySelector('#frame'); return f.clientWidth / f.dataset.width; }")
    )


def on_sample(window: Window, x: float, y: float) -> Point:
    """Where a pixel of the sample is on the screen."""
    left, top, _, _ = window.bounds("#frame")
    scale = scale_of(window)
    return left + x * scale, top + y * scale


def run(window: Window, press: Callable[[str], None], busy: Callable[[], AbstractContextManager[None]]) -> str:
    """Press the main button and see the waiting room turn into the result, without a reload; the experiment's path."""
    with busy():
        press("button.main")
        path = window.at("/experiments/")
        window.has("[data-stage]", "Place ")
        assert window.has("[data-status]") == "Waiting"
        window.look(LISTEN)
    window.has(".downloads")
    assert window.look("() => window.sameDocument"), "the page was loaded anew"
    said = window.look("() => window.said")
    assert said[0] == ["Waiting", 0]
    parts = [part for _, part in said]
    assert parts == sorted(parts)
    return path

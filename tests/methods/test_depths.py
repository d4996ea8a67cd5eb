"""Sixteen bits are the engine's own numbers, rounded once: of every method, every still texture, every picture."""

import io
import threading
from pathlib import Path
from typing import Any

import imagecodecs
import numpy as np
import pytest
import tifffile

from app.images.convert import convert, read_depth
from app.images.png_writer import encode_png
from app.methods.model import Source
from app.methods.registry import METHODS
from app.synthesis.sinks import Levels
from tests.methods.runs import run_small, sources_for

STILL = {name: method for name, method in METHODS.items() if not method.moving}
MORE = {"dsn": {"convergence": True}, "mix": {"strip": 3}}
WHITE = 65535


class Recorded:
    """What the engine hands over to be rounded: for every picture the values, as parts of white."""

    def __init__(self, patch: pytest.MonkeyPatch) -> None:
        self._rows: dict[int, dict[int, np.ndarray]] = {}
        self._kept: list[Levels] = []  # else another one might be at the same address
        self._lock = threading.Lock()
        original, recorded = Levels.__call__, self

        def call(levels: Levels, first: int, planes: Any) -> None:
            values = [np.array(plane, np.float64) for plane in planes]
            scale, shift = float(levels._scale), float(levels._shift)
            with recorded._lock:
                recorded._kept.append(levels)
                parts = [(plane * scale + shift - 0.5) / WHITE for plane in values]
                recorded._rows.setdefault(id(levels), {})[first] = np.stack(parts, axis=2)
            original(levels, first, [np.array(plane, np.float32) for plane in values])

        patch.setattr(Levels, "__call__", call)

    def pictures(self) -> list[np.ndarray]:
        """Those that were handed over since the last call, in order."""
        found = [np.concatenate([rows[first] for first in sorted(rows)]) for rows in self._rows.values()]
        self._rows.clear()
        return found


@pytest.mark.parametrize("name", STILL)
@pytest.mark.parametrize("channels", [1, 3])
def test_every_texture_at_sixteen_bits_is_the_rounding_of_the_engines_numbers(
    name: str, channels: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As read by two decoders that are not ours, from PNG and from TIFF."""
    recorded = Recorded(monkeypatch)
    sources = sources_for(STILL[name], channels=channels, peak=WHITE)
    textures = 0
    for picture in run_small(STILL[name], sources, depth=16, **MORE.get(name, {})):
        values = recorded.pictures()
        if picture.kind != "texture":
            continue
        textures += 1
        assert isinstance(picture.data, bytes)
        fine = imagecodecs.png_decode(picture.data)
        assert fine.dtype == np.uint16
        assert len(np.unique(fine)) > 256
        assert (fine % 257 != 0).mean() > 0.9, "8-bit values made wider"
        (expected,) = [np.rint(WHITE * np.clip(part, 0, 1)) for part in values if part.shape[:2] == fine.shape[:2]]
        assert np.abs(fine.reshape(expected.shape) - expected).max() <= 1  # single precision where it is halfway
        tiff, _ = convert(picture.data, "tiff")
        assert np.array_equal(tifffile.imread(io.BytesIO(tiff)), fine)
    announced = [output for output in STILL[name].outputs if output.kind == "texture"]
    assert textures == {"dsn": 7, "mix": 4}.get(name, len(announced))


@pytest.mark.parametrize("name", STILL)
def test_a_crop_of_sixteen_bits_keeps_each_of_them(name: str) -> None:
    rng = np.random.default_rng(3)
    sources = [
        Source(rng.integers(0, WHITE, source.pixels.shape).astype(np.float32), WHITE)
        for source in sources_for(STILL[name])
    ]
    shown = next(picture for picture in run_small(STILL[name], sources, depth=16) if picture.name == "crop")
    assert isinstance(shown.data, bytes)
    assert np.array_equal(imagecodecs.png_decode(shown.data), sources[0].pixels)


@pytest.mark.parametrize("first", [255, WHITE])
def test_of_samples_of_different_depth_the_deeper_one_keeps_its_bits(first: int) -> None:
    """The range is the first one's; what counts is that nothing of the second is rounded before the engine."""
    fine = np.arange(48 * 64 * 3, dtype=np.float32).reshape(48, 64, 3) * 7
    coarse = sources_for(METHODS["mix"])[0]
    sources = [coarse, Source(fine, WHITE)] if first == 255 else [Source(fine, WHITE), coarse]
    weights = "0,1" if first == 255 else "1,0"
    texture = next(run_small(METHODS["mix"], sources, depth=16, weights=weights))
    assert isinstance(texture.data, bytes)
    alone = next(run_small(METHODS["adsn"], [Source(fine, WHITE)], depth=16))
    assert isinstance(alone.data, bytes)
    made, expected = (imagecodecs.png_decode(data).astype(float) for data in (texture.data, alone.data))
    assert made.mean() == pytest.approx(expected.mean(), abs=1.0)
    assert (made % 257 != 0).mean() > 0.9


def test_a_file_says_its_depth(tmp_path: Path) -> None:
    for kind, depth in ((np.uint8, 8), (np.uint16, 16)):
        (tmp_path / "picture.png").write_bytes(encode_png(np.ones((3, 4, 3), kind)))
        assert read_depth(tmp_path / "picture.png") == depth

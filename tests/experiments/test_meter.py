"""The meter measures what a crop holds, whether its photograph is kept decoded or only its strips are read."""

from datetime import UTC, datetime

import numpy as np
import pytest

from app.errors import InvalidInputError
from app.experiments import meter
from app.experiments.meter import Index, Meter, interpret
from app.experiments.model import Sample
from app.images.crop import Rectangle
from app.images.png_writer import encode_png
from app.synthesis.structure import CENTRE, structure_index


class Files:
    """A blob store that notes what is opened."""

    def __init__(self, directory):
        self.directory, self.opened = directory, 0

    def path(self, digest):
        self.opened += 1
        return self.directory / digest


@pytest.fixture
def files(tmp_path):
    return Files(tmp_path)


def kept(files, pixels):
    (files.directory / "photograph").write_bytes(encode_png(pixels))
    height, width, channels = pixels.shape
    return Sample(
        id="photograph",
        digest="photograph",
        width=width,
        height=height,
        channels=3,
        depth=8,
        transparent=channels == 4,
        created_at=datetime.now(UTC),
    )


def noise(height, width, channels=3):
    return np.random.default_rng(0).integers(0, 256, (height, width, channels), np.uint8)


@pytest.mark.parametrize("small", [0, 1 << 20])
@pytest.mark.parametrize("area", [None, Rectangle(30, 10, 64, 50), Rectangle(0, 40, 32, 32)])
def test_a_crop_has_the_index_of_its_pixels_however_it_is_read(files, monkeypatch, small, area):
    monkeypatch.setattr(meter, "SMALL", small)
    pixels = noise(80, 100)
    found = Meter(files).structure(kept(files, pixels), area, 1.5)
    area = area or Rectangle(0, 0, 100, 80)
    cut = structure_index(pixels[area.y : area.y + area.height, area.x : area.x + area.width].astype(np.float32), 1.5)
    assert found == Index(cut.delta, cut.z)


@pytest.mark.parametrize("size", [(1, 1), (3, 1), (31, 32), (32, 31), (100, 31)])
@pytest.mark.parametrize("sigma", [0, 2])
def test_a_crop_of_less_than_32_pixels_along_a_side_is_too_small_to_tell(files, size, sigma):
    found = Meter(files).structure(kept(files, noise(80, 100)), Rectangle(0, 40, *size), sigma)
    assert found == Index(None, None)
    assert interpret(found.delta).verdict == "unknown"
    assert "Too small to tell" in interpret(found.delta).words


def test_a_crop_of_32_pixels_is_large_enough(files):
    """Also where a side is longer, and where that of the photograph is no longer."""
    for pixels, crop in ((noise(80, 100), Rectangle(3, 4, 32, 32)), (noise(32, 2000), None)):
        assert Meter(files).structure(kept(files, pixels), crop, 2).delta is not None


def test_dragging_over_a_small_photograph_decodes_it_once_and_asking_again_costs_nothing(files):
    sample, measuring = kept(files, noise(64, 64)), Meter(files)
    for x in range(20):
        measuring.structure(sample, Rectangle(x, 0, 40, 40), 2)
    assert files.opened == 1


def test_of_a_large_crop_only_its_middle_is_read(files):
    pixels = noise(40, CENTRE + 200)
    found = Meter(files).structure(kept(files, pixels), None, 2)
    assert found.delta == pytest.approx(structure_index(pixels[:, 100:-100].astype(np.float32)).delta)


def test_a_crop_is_refused_that_reaches_outside_even_if_its_middle_does_not(files):
    sample = kept(files, noise(16, CENTRE))
    with pytest.raises(InvalidInputError, match="outside"):
        Meter(files).structure(sample, Rectangle(0, 0, CENTRE + 2, 16), 2)


def test_transparent_pixels_are_refused_only_where_the_crop_holds_them(files):
    pixels = noise(40, 80, 4)
    pixels[:, :40, 3], pixels[:, 40:, 3] = 255, 0
    sample, measuring = kept(files, pixels), Meter(files)
    assert measuring.structure(sample, Rectangle(0, 0, 40, 40), 2).delta is not None
    for crop in (Rectangle(10, 0, 40, 40), Rectangle(39, 0, 2, 2)):
        with pytest.raises(InvalidInputError, match="transparent"):
            measuring.structure(sample, crop, 2)

"""The Rayleigh experiment as the registry declares it: refusals and pictures."""

import numpy as np
import pytest
from imagecodecs import png_decode

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.gaussian.rayleigh import RAYLEIGH
from app.methods.model import Size, Source
from app.methods.registry import METHODS


def run(name, seed=3, **size):
    rng = np.random.default_rng(0)
    pixels = (rng.integers(0, 80, (60, 70, 1)) + rng.integers(40, 120, (60, 70, 3))).astype(np.float32)
    context = Context(8, 2, lambda stage, fraction: None)
    method = METHODS[name]
    return {
        made.name: made for made in method.pictures([Source(pixels, 255)], method.params(seed=seed, **size), context)
    }


def test_it_gives_every_step_as_a_picture():
    made = run("rayleigh")
    assert list(made) == [
        "texture", "crop", "periodic", "rpn", "adsn", "input-spectrum", "output-spectrum",
    ]  # fmt: skip
    assert [name for name, picture in made.items() if picture.kind == "texture"] == ["texture", "rpn", "adsn"]
    assert png_decode(made["texture"].data).shape == (60, 70, 3)
    assert png_decode(made["output-spectrum"].data).shape == (60, 70)


@pytest.mark.parametrize("name", ["rpn", "adsn"])
def test_the_textures_to_compare_with_are_those_of_rpn_and_adsn_at_the_same_seed(name):
    expected, seen = png_decode(run(name)["texture"].data), png_decode(run("rayleigh")[name].data)
    assert np.abs(expected.astype(int) - seen).max() <= 1


def test_it_measures_the_correlation_which_is_near_half_the_root_of_pi():
    """Σ |p̂|² R / Σ |p̂|² tends to E R; over 2100 frequencies of like energy with √(1 − π/4) / √2100 = 0.01."""
    (fact,) = run("rayleigh")["texture"].facts
    assert fact.value == pytest.approx(np.sqrt(np.pi) / 2, abs=0.05)


def test_a_constant_crop_has_nothing_that_the_noise_could_damage():
    constant = Source(np.full((8, 9, 3), [0, 77, 255], np.float32), 255)
    texture = next(iter(RAYLEIGH.pictures([constant], RAYLEIGH.params(), Context(8, 1, lambda stage, fraction: None))))
    assert (png_decode(texture.data) == [0, 77, 255]).all()
    assert texture.facts[0].value == 1


@pytest.mark.parametrize(
    ("asked", "field", "words"),
    [
        ({"width": 71}, "width", "^Choose a width of at most 70 pixels, the crop's own, instead of 71"),
        ({"height": 61, "width": 20}, "height", "^Choose a height of at most 60 pixels, the crop's own, instead of 61"),
    ],
)
def test_a_size_beyond_the_crops_is_refused_with_words_that_help(asked, field, words):
    with pytest.raises(InvalidInputError, match=words) as refusal:
        RAYLEIGH.resolve([Size(70, 60, 3)], RAYLEIGH.params(**asked))
    assert refusal.value.field == f"parameters.{field}"


def test_a_smaller_size_takes_the_centre():
    RAYLEIGH.resolve([Size(70, 60, 3)], RAYLEIGH.params(width=40, height=30))
    made = run("rayleigh", width=40, height=31)
    assert png_decode(made["texture"].data).shape == png_decode(made["periodic"].data).shape == (31, 40, 3)
    assert png_decode(made["crop"].data).shape == (60, 70, 3)

"""The texton as the registry declares it: pictures, their grey mapping, and what is measured."""

import numpy as np
import pytest
from imagecodecs import png_decode
from pydantic import ValidationError

from app.methods.context import Context
from app.methods.gaussian.texton import TEXTON
from app.methods.model import Source
from app.methods.registry import METHODS
from app.synthesis.gaussian.cut_texton import cut_texton, lag_error
from app.synthesis.gaussian.texton import extend_texton, texton

RNG = np.random.default_rng(0)
PIXELS = (RNG.integers(0, 80, (60, 70, 1)) + RNG.integers(40, 120, (60, 70, 3))).astype(np.float32)


def run(name="texton", *, source=PIXELS, seed=3, **parameters):
    method, context = METHODS[name], Context(8, 2, lambda stage, fraction: None)
    params = method.params(seed=seed, **parameters)
    return {made.name: made for made in method.pictures([Source(source, 255)], params, context)}


def pixels(picture):
    return png_decode(picture.data).astype(float)


@pytest.mark.parametrize("wrong", [{"cut": 0}, {"cut": -3}, {"alpha": 0.1}])
def test_values_outside_what_is_declared_are_refused(wrong):
    with pytest.raises(ValidationError, match=rf"1 validation error for TextonParams\n{next(iter(wrong))}\n"):
        TEXTON.params(**wrong)


@pytest.mark.parametrize("cut", [None, 7, 1000])
@pytest.mark.parametrize("size", [{}, {"width": 100, "height": 91}, {"width": 40}])
def test_it_gives_the_texture_the_crop_and_the_texton(size, cut):
    made = run(cut=cut, **size)
    noises = ["noises"] if cut else []
    assert list(made) == ["texture", "crop", "texton", "texton-log", "spot", *noises]
    assert [name for name, picture in made.items() if picture.kind == "texture"] == ["texture"]
    for name in ("texture", "spot"):
        assert (made[name].width, made[name].height) == (size.get("width", 70), size.get("height", 60))
    assert (made["texton"].width, made["texton"].height) == (min(70, size.get("width", 70)), 60)


@pytest.mark.parametrize("source", [PIXELS, PIXELS[:, :, :1]])
@pytest.mark.parametrize("size", [{}, {"width": 40, "height": 33}])
def test_uncut_and_not_extended_its_texture_is_that_of_adsn(source, size):
    """The methods share one phase, as `Method.phase` says; here the Rayleigh noise and the modulus are one, too."""
    assert TEXTON.phase
    expected = pixels(run("adsn", source=source, **size)["texture"])
    assert np.abs(pixels(run(source=source, **size)["texture"]) - expected).max() <= 1


def test_a_larger_texture_goes_up_and_down_where_that_of_adsn_does():
    textures = [pixels(run(name, width=150, height=140)["texture"]).mean(2) for name in ("texton", "adsn")]
    other = pixels(run("adsn", width=150, height=140, seed=4)["texture"]).mean(2)
    assert np.corrcoef(*(texture.ravel() for texture in textures))[0, 1] > 0.5
    # white noise of 21 000 pixels: a correlation by chance has deviation 0.007
    assert abs(np.corrcoef(textures[0].ravel(), other.ravel())[0, 1]) < 0.04


def test_the_radii_rise_and_the_factor_is_the_root_of_the_areas():
    made = run(width=140, height=120)
    assert [fact.name for fact in made["texton"].facts] == ["radius-50", "radius-90", "radius-99"]
    values = [fact.value for fact in made["texton"].facts]
    assert 0 <= values[0] < values[1] < values[2] < np.hypot(30, 35)
    gain, *_ = made["spot"].facts
    assert (gain.name, gain.value) == ("gain", pytest.approx(2, rel=1e-5))
    assert run(width=140, height=120, cut=9)["spot"].facts[0].value > 2.05


@pytest.mark.parametrize(("size", "cut"), [({}, 9), ({"width": 140, "height": 120}, 9), ({"width": 140}, None)])
def test_what_is_less_than_the_sample_says_how_far_its_covariance_is_off(size, cut):
    """In percent of that at one place, and at which distance; the numbers are those of the numerics."""
    spot = run(cut=cut, **size)["spot"]
    facts = {fact.name: fact for fact in spot.facts}
    assert list(facts) == ["gain", "lag-error", "lag"]
    height, width = size.get("height", 60), size.get("width", 70)
    mean = PIXELS.mean((0, 1), dtype=np.float64)
    spots = (
        cut_texton(PIXELS, mean, height, width, cut).spots if cut else [extend_texton(texton(PIXELS), mean, 60, 140)]
    )
    error, lag = lag_error(PIXELS, spots)
    assert facts["lag-error"].value == pytest.approx(100 * error, rel=1e-3)
    assert 0 < facts["lag-error"].value < 100
    assert (facts["lag"].value, facts["lag"].unit) == (pytest.approx(lag), "pixels")


@pytest.mark.parametrize("cut", [None, 70, 1000])
def test_a_whole_texton_of_the_crops_size_has_nothing_to_say_of_it(cut):
    assert [fact.name for fact in run(cut=cut)["spot"].facts] == ["gain"]


@pytest.mark.parametrize(("source", "count"), [(PIXELS, 3), (PIXELS[:, :, :1], 1), (PIXELS[:, :, [0, 0, 0]], 1)])
def test_every_noise_of_a_cut_has_its_square_and_its_factor(source, count):
    """Side by side, the first as in the extended texton, each with black or white where it is greatest."""
    made = run(source=source, cut=9, width=140, height=120)
    image, extended = pixels(made["noises"]), pixels(made["spot"])
    assert image.shape[:2] == (9, 9 * count)
    assert (image[:, :9] == extended[55:64, 65:74]).all()
    assert all(square.max() == 255 or square.min() == 0 for square in np.split(image, count, axis=1))
    assert [fact.name for fact in made["noises"].facts] == [f"gain-{n}" for n in range(1, count + 1)]
    assert made["noises"].facts[0].value == made["spot"].facts[0].value > 2


def test_in_the_linear_picture_zero_is_mid_grey_and_one_value_in_a_thousand_is_cut_off():
    image, t = pixels(run()["texton"]), texton(PIXELS)
    assert np.median(image[np.abs(t) < 1e-3 * np.abs(t).max()]) == pytest.approx(127.5, abs=4)
    assert (image[30, 35] == 255).all()
    assert np.isin(image, (0, 255)).mean() == pytest.approx(0.001, abs=0.001)
    assert (np.sign(image - 127.5) == np.sign(t))[np.abs(image - 127.5) > 1].all()


def test_in_the_logarithmic_picture_a_power_of_ten_is_a_third_of_the_range():
    image = pixels(run()["texton-log"])
    modulus = np.sqrt((texton(PIXELS) ** 2).sum(2))
    expected = (255 * (1 + np.log10(modulus / modulus.max()) / 3)).clip(0, 255)
    assert image[30, 35] == 255
    assert np.abs(image - expected).max() <= 1


def test_a_cut_shows_the_square_alone():
    image = pixels(run(cut=9, width=100, height=91)["spot"])
    outside = np.ones(image.shape[:2], bool)
    outside[41:50, 45:54] = False
    assert len(np.unique(image[outside])) == 1
    assert image[45, 49].max() == 255


def test_a_constant_crop_gives_itself_back_and_an_even_texton():
    made = run(source=np.full((8, 9, 3), [0, 77, 255], np.float32), width=20, height=21, cut=3)
    assert (pixels(made["texture"]) == [0, 77, 255]).all()
    assert np.unique(pixels(made["texton"])).size == 1
    assert [fact.value for fact in made["texton"].facts] == [0, 0, 0]

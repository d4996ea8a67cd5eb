"""Discrete spot noise as the registry declares it: refusals, gallery, pictures."""

import numpy as np
import pytest
from imagecodecs import png_decode
from pydantic import ValidationError

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.gaussian.dsn import DSN, ORDERS
from app.methods.model import Size, Source
from app.methods.registry import METHODS

GALLERY = [f"dsn-{order}" for order in ORDERS]


def run(name="dsn", *, channels=3, depth=8, **parameters):
    rng = np.random.default_rng(0)
    pixels = rng.integers(0, 80, (60, 70, 1)) + rng.integers(40, 120, (60, 70, channels))
    method, context = METHODS[name], Context(depth, 2, lambda stage, fraction: None)
    params = method.params(seed=3, **parameters)
    return {made.name: made for made in method.pictures([Source(pixels.astype(np.float32), 255)], params, context)}


def pixels(picture):
    return png_decode(picture.data).astype(float)


@pytest.mark.parametrize("wrong", [{"order": 0}, {"order": 10**9 + 1}, {"order": 2.5}, {"spot": "star"}, {"radius": 0}])
def test_values_outside_what_is_declared_are_refused(wrong):
    with pytest.raises(ValidationError, match="1 validation error for DsnParams"):
        DSN.params(**wrong)


@pytest.mark.parametrize("spot", ["disc", "gaussian"])
def test_a_shape_that_does_not_fit_is_refused_with_words_that_help(spot):
    with pytest.raises(InvalidInputError, match="at least 61 pixels") as refusal:
        DSN.resolve([Size(200, 60, 3)], DSN.params(spot=spot, radius=30))
    assert refusal.value.field == "parameters.radius"
    DSN.resolve([Size(200, 60, 3)], DSN.params(spot=spot, radius=30, height=61))


def test_the_radius_is_not_looked_at_when_the_crop_is_the_spot():
    DSN.resolve([Size(10, 10, 3)], DSN.params(radius=30))


@pytest.mark.parametrize("size", [{}, {"width": 100, "height": 91}, {"width": 40}])
def test_it_gives_the_texture_the_crop_the_spot_and_the_points(size):
    made = run(**size)
    assert list(made) == ["texture", "crop", "spot", "points"]
    for name in ("texture", "spot", "points"):
        assert (made[name].width, made[name].height) == (size.get("width", 70), size.get("height", 60))


def test_convergence_gives_every_order_and_the_limit_as_textures():
    made = run(convergence=True)
    assert list(made) == ["texture", *GALLERY, "adsn", "crop", "spot", "points"]
    assert [name for name, picture in made.items() if picture.kind == "texture"] == ["texture", *GALLERY, "adsn"]
    assert made["dsn-100"].data == made["texture"].data  # 100 is the default order
    assert made["dsn-10000"].title == "n = 10\u00a0000"


@pytest.mark.parametrize("parameters", [{}, {"width": 120, "height": 99, "alpha": 0.2, "window": "gaussian"}])
def test_the_limit_is_the_texture_of_adsn_with_the_same_parameters(parameters):
    expected = pixels(run("adsn", **parameters)["texture"])
    assert np.abs(pixels(run(convergence=True, **parameters)["adsn"]) - expected).max() <= 1


def test_the_excess_kurtosis_is_given_and_falls_as_one_over_n_to_zero():
    made = run(convergence=True, spot="disc", radius=5)
    values = [made[name].facts[0].value for name in GALLERY]
    assert [fact.name for fact in made["adsn"].facts] == ["excess-kurtosis"]
    assert made["adsn"].facts[0].value == 0
    # of a binary variable of mean p: (1 − 6 p (1 − p)) / (p (1 − p))
    p = (pixels(made["spot"]) > 0).mean()
    expected = (1 - 6 * p * (1 - p)) / (p * (1 - p)) / np.array(ORDERS)
    np.testing.assert_allclose(values, expected, rtol=1e-3)


@pytest.mark.parametrize(("spot", "levels"), [("disc", 2), ("gaussian", 30)])
@pytest.mark.parametrize("depth", [8, 16])
def test_a_shape_and_its_noise_are_grey(spot, levels, depth):
    made = run(spot=spot, radius=9, depth=depth)
    assert pixels(made["spot"]).ndim == pixels(made["texture"]).ndim == 2
    shown = np.unique(pixels(made["spot"]))
    assert len(shown) == levels if spot == "disc" else len(shown) > levels
    assert shown[-1] == 2**depth - 1


def test_every_picture_of_a_shapes_gallery_has_one_scale():
    """Mid-grey is the mean; black and white are three deviations off, so one deviation is a sixth of the range.

    1300 areas of the disc fit into the texture: the deviation is known to about 1 / √(2 · 1300) = 2 %, and its mean to
    a 36th of it, 1.2 levels.
    """
    made = run(convergence=True, spot="disc", radius=4, width=256, height=256)
    for name in ("dsn-10000", "dsn-100000", "adsn"):
        assert pixels(made[name]).mean() == pytest.approx(127.5, abs=3)
        assert pixels(made[name]).std() == pytest.approx(255 / 6, rel=0.1)


def test_the_points_are_counted():
    made = run(order=5)
    least, most = (fact.value for fact in made["points"].facts)
    image = pixels(made["points"])
    assert least == 0
    assert (image * most / 255).sum() == 5


def test_one_copy_of_the_crop_is_a_translation_of_its_spot():
    made = run(order=1)
    texture, spot = pixels(made["texture"]), pixels(made["spot"])
    place = np.unravel_index(pixels(made["points"]).argmax(), spot.shape[:2])
    assert np.abs(np.roll(spot, place, (0, 1)) - texture).max() <= 1

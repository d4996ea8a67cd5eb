"""Heeger–Bergen as the registry declares it: refusals, pictures, facts."""

import numpy as np
import pytest
from imagecodecs import png_decode
from pydantic import ValidationError

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.model import Size, Source
from app.methods.pyramid.heeger_bergen import HEEGER_BERGEN, HeegerBergenParams
from app.synthesis.pyramid.heeger_bergen import Decomposition, heeger_bergen


def crop(height=40, width=50, channels=3, seed=0):
    rng = np.random.default_rng(seed)
    grain = rng.uniform(80, 160, (height, width, 1)) * np.linspace(1, 0.7, channels)
    slope = np.linspace(0, 60, width)[None, :, None]
    return Source(np.round(grain + rng.uniform(0, 20, grain.shape) + slope).astype(np.float32), 255)


def pictures(source, **parameters):
    run = HEEGER_BERGEN.pictures(
        [source], HeegerBergenParams(**parameters), Context(8, 2, lambda stage, fraction: None)
    )
    return {picture.name: picture for picture in run}


def refusal(size, **parameters):
    with pytest.raises(InvalidInputError) as refused:  # noqa: PT011 -- who calls this compares the words
        HEEGER_BERGEN.resolve([size], HeegerBergenParams(**parameters))
    return refused.value


def test_the_defaults_are_those_of_the_literature():
    params = HeegerBergenParams()
    assert (params.scales, params.orientations, params.iterations, params.edges) == (4, 4, 5, "periodic")
    assert params.add_smooth is False


@pytest.mark.parametrize(
    "wrong",
    [{"scales": 0}, {"scales": 9}, {"orientations": 0}, {"orientations": 9}, {"iterations": 0}, {"iterations": 21},
     {"edges": "zero"}, {"seed": -1}, {"alpha": 0.1}],
)  # fmt: skip
def test_values_outside_what_is_declared_are_refused(wrong):
    with pytest.raises(ValidationError, match="1 validation error for HeegerBergenParams"):
        HeegerBergenParams(**wrong)


def test_more_scales_than_fit_are_refused_with_how_many_do():
    assert "the crop has 50 × 40" in str(refusal(Size(50, 40, 3), scales=6))
    assert "at most 5 scales" in str(refusal(Size(50, 40, 3), scales=6))
    assert "the texture has 500 × 15" in str(refusal(Size(50, 40, 3), width=500, height=15))
    assert "take a larger crop" in str(refusal(Size(1, 40, 3)))
    assert refusal(Size(50, 40, 3), scales=6).field == "parameters.scales"
    HEEGER_BERGEN.resolve([Size(16, 40, 3)], HeegerBergenParams(width=16, height=16))


@pytest.mark.parametrize("wrong", [{"width": 51}, {"height": 80}, {"edges": "mirror"}])
def test_a_smooth_component_that_does_not_fit_or_does_not_exist_is_refused(wrong):
    assert refusal(Size(50, 40, 3), add_smooth=True, **wrong).field == "parameters.add_smooth"


def test_the_smooth_component_makes_the_texture_one_that_does_not_tile():
    HEEGER_BERGEN.resolve([Size(50, 40, 3)], HeegerBergenParams(add_smooth=True))
    assert not HEEGER_BERGEN.toroidal(HeegerBergenParams(add_smooth=True))
    assert HEEGER_BERGEN.toroidal(HeegerBergenParams())


@pytest.mark.parametrize(
    "parameters",
    [{}, {"width": 71, "height": 67, "edges": "mirror"}, {"add_smooth": True, "scales": 2, "orientations": 3}],
)
def test_the_texture_is_the_rounded_synthesis(parameters):
    source, options = crop(), dict(parameters)
    decomposition = Decomposition(
        **{key: options.pop(key) for key in ("scales", "orientations", "edges") & options.keys()}
    )
    expected = heeger_bergen(source.pixels, seed=4, decomposition=decomposition, **options)
    texture = png_decode(pictures(source, seed=4, **parameters)["texture"].data)
    assert (texture == np.floor(expected.clip(0, 255) + 0.5)).mean() > 0.999


@pytest.mark.parametrize(
    ("iterations", "views"),
    [(1, ["noise"]), (5, ["noise", "iteration-1", "iteration-2", "iteration-4"])],
)
def test_the_way_from_noise_to_texture_is_shown(iterations, views):
    made = pictures(crop(), iterations=iterations)
    assert list(made) == ["texture", "crop", *views, "crop-bands", "texture-bands"]
    assert [name for name, picture in made.items() if picture.kind == "texture"] == ["texture"]
    fewer = pictures(crop(), iterations=iterations, seed=1)
    assert fewer["noise"].data != made["noise"].data
    if iterations > 1:
        assert (
            png_decode(made["iteration-1"].data).tolist()
            == png_decode(pictures(crop(), iterations=1)["texture"].data).tolist()
        )


def test_views_of_large_textures_are_cut():
    made = pictures(crop(), width=600, height=30, iterations=1)
    assert (made["noise"].width, made["noise"].height) == (512, 30)
    assert made["texture"].width == 600


@pytest.mark.parametrize(("scales", "orientations"), [(1, 1), (3, 5)])
def test_the_sub_bands_are_laid_out_by_scale_and_orientation(scales, orientations):
    made = pictures(crop(), scales=scales, orientations=orientations, width=60, height=43, iterations=1)
    columns = max(2, orientations)
    for name, (height, width) in {"crop-bands": (40, 50), "texture-bands": (43, 60)}.items():
        assert made[name].height == (scales + 1) * (height + 4) - 4
        assert made[name].width == columns * (width + 4) - 4
        picture = png_decode(made[name].data)
        assert picture.ndim == 2
        # a band has mean 0 and a deviation of a sixth of the range, but for what is cut off
        cell = picture[:height, :width]
        assert abs(cell.mean() - 127.5) < 4
        assert 30 < cell.std() < 50


def test_the_facts_tell_the_shares_of_the_components_and_the_distance_that_is_left():
    made = pictures(crop())
    shares = [fact.value for fact in made["crop-bands"].facts]
    assert shares == sorted(shares, reverse=True)
    assert sum(shares) == pytest.approx(100)
    (distance,) = made["texture-bands"].facts
    assert 0 < distance.value < 15
    assert len(pictures(crop(channels=1))["crop-bands"].facts) == 1


@pytest.mark.parametrize(
    ("size", "parameters", "fits"),
    [
        ((512, 512, 3), {"width": 3584, "height": 3584}, True),
        ((512, 512, 3), {"width": 4096, "height": 4096}, False),
        ((512, 512, 1), {"width": 4096, "height": 4096}, True),
        ((3500, 3500, 3), {"width": 512, "height": 512}, True),
        ((3500, 3500, 3), {"width": 512, "height": 512, "edges": "mirror"}, False),
    ],
)
def test_what_would_not_fit_into_a_workers_memory_is_refused_beforehand(size, parameters, fits):
    """A worker that is killed for its memory tells nobody why."""
    if fits:
        HEEGER_BERGEN.resolve([Size(*size)], HeegerBergenParams(**parameters))
    else:
        with pytest.raises(InvalidInputError, match="smaller crop"):
            HEEGER_BERGEN.resolve([Size(*size)], HeegerBergenParams(**parameters))

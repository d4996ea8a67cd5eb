"""Mixtures as the registry declares them: weights, refusals, the path and its strip."""

import numpy as np
import pytest
from imagecodecs import png_decode
from pydantic import ValidationError

from app.errors import InvalidInputError
from app.methods.context import Context
from app.methods.gaussian.mix import MIX, MixParams
from app.methods.model import Size, Source
from app.methods.registry import METHODS
from app.synthesis.gaussian.mixing import mix


def crop(height=40, width=50, channels=3, peak=255, seed=0):
    rng = np.random.default_rng(seed)
    values = np.cumsum(rng.uniform(-1, 1, (height, width, channels)), axis=seed % 2)
    return Source(np.round((0.5 + values / 30).clip(0, 1) * peak).astype(np.float32), peak)


def run(sources, name="mix", depth=8, **parameters):
    method = METHODS[name]
    pictures = method.pictures(sources, method.params(**parameters), Context(depth, 2, lambda stage, fraction: None))
    return {picture.name: picture for picture in pictures}


def pixels(picture):
    return png_decode(picture.data).astype(int)


def sizes(count):
    return [Size(50, 40, 3)] * count


@pytest.mark.parametrize(
    ("weights", "shares"),
    [
        ("", [0.5, 0.5]), (" ", [0.5, 0.5]), ("2,2", [0.5, 0.5]), ("0.3, 0.7", [0.3, 0.7]), ("0,8", [0, 1]),
        ("0,3; 0,7", [0.3, 0.7]), ("0,3;0,7", [0.3, 0.7]), ("0.3;0.7", [0.3, 0.7]), ("0,3 0,7", [0.3, 0.7]),
        ("0.3 0.7", [0.3, 0.7]), ("1 3", [0.25, 0.75]), ("1;3", [0.25, 0.75]), ("1, 3", [0.25, 0.75]),
        ("1 ,3", [0.25, 0.75]), ("0.5,  0.5", [0.5, 0.5]),
    ],
)  # fmt: skip
def test_only_the_proportions_of_the_weights_count(weights, shares):
    params = MixParams(weights=weights)
    MIX.resolve(sizes(2), params)
    assert params.shares(2) == pytest.approx(shares)


@pytest.mark.parametrize(("weights", "said"), [("0,3; 0,7", "0.3,0.7"), ("1 ,3", "1,3"), ("0.30,0.70", "0.30,0.70")])
def test_weights_are_said_back_as_they_were_understood(weights, said):
    assert MixParams(weights=weights).weights == said


@pytest.mark.parametrize(
    "weights",
    ["a", "1,", "1;", "1;;2", "-1,2", "0,0", "nan,1", "inf,1", "1e308,1e308", "1," * 60,
     "0,5, 0,5", "1.000,5; 2", "1, 2 3"],
)  # fmt: skip
def test_weights_that_are_none_are_refused(weights):
    with pytest.raises(ValidationError, match=r"must be numbers from 0 on|at most 100 characters"):
        MixParams(weights=weights)


@pytest.mark.parametrize(("count", "weights"), [(2, "1"), (2, "1,2,3"), (3, "1,2"), (4, "1,1,1")])
def test_another_number_of_weights_than_of_samples_is_refused_with_words_that_help(count, weights):
    with pytest.raises(
        InvalidInputError, match=f"^Give one weight for each of the {count} samples, or none"
    ) as refusal:
        MIX.resolve(sizes(count), MixParams(weights=weights))
    assert refusal.value.field == "parameters.weights"


def test_a_path_of_one_step_is_refused():
    with pytest.raises(InvalidInputError, match=r"^Choose 2 steps or more, or 0 to make no path") as refusal:
        MIX.resolve(sizes(2), MixParams(strip=1))
    assert refusal.value.field == "parameters.strip"


def test_it_gives_the_mixture_the_crops_the_path_and_its_strip():
    made = run([crop(), crop(seed=1)], strip=5)
    assert list(made) == ["texture", "crop", "crop-2", "mix-1", "mix-2", "mix-3", "mix-4", "mix-5", "strip"]
    assert [name for name in made if made[name].kind == "view"] == ["crop", "crop-2", "strip"]
    assert [made[f"mix-{step}"].title for step in range(1, 6)] == [
        "ρ = 0.00", "ρ = 0.25", "ρ = 0.50", "ρ = 0.75", "ρ = 1.00",
    ]  # fmt: skip


def test_the_strip_holds_the_steps_side_by_side_and_the_middle_is_the_even_mixture():
    made = run([crop(), crop(seed=1)], strip=5, width=60, height=130)
    steps = [pixels(made[f"mix-{step}"]) for step in range(1, 6)]
    assert (pixels(made["strip"]) == np.concatenate(steps, axis=1)).all()
    assert (steps[2] == pixels(made["texture"])).all()


def test_of_large_textures_the_strip_shows_a_corner():
    made = run([crop(), crop(seed=1)], strip=2, width=530, height=520)
    strip = pixels(made["strip"])
    assert strip.shape == (512, 1024, 3)
    assert (strip[:, 512:] == pixels(made["mix-2"])[:512, :512]).all()


def test_a_path_begins_with_the_adsn_of_its_first_sample():
    first = crop()
    made = run([first, crop(seed=1)], weights="1,0", strip=2, seed=3)
    expected = run([first], "adsn", seed=3)["texture"]
    assert made["mix-1"].data == made["texture"].data == expected.data


@pytest.mark.parametrize("count", [2, 3, 4])
def test_the_texture_is_the_rounded_barycentre(count):
    sources = [crop(seed=number) for number in range(count)]
    weights = [1, 2, 3, 4][:count]
    texture = pixels(run(sources, weights=",".join(map(str, weights)), seed=2, width=70)["texture"])
    expected = np.floor(mix([source.pixels for source in sources], weights, 40, 70, seed=2).clip(0, 255) + 0.5)
    assert np.abs(texture - expected).max() <= 1
    assert (texture == expected).mean() > 0.999


def test_with_more_than_two_samples_each_ones_own_texture_takes_the_place_of_the_path():
    sources = [crop(), crop(seed=1), crop(seed=2)]
    made = run(sources, seed=3)
    assert list(made) == ["texture", "crop", "crop-2", "crop-3", "sample-1", "sample-2", "sample-3"]
    assert made["sample-1"].data == run(sources[:1], "adsn", seed=3)["texture"].data


def test_no_path_is_made_where_none_is_asked_for():
    assert list(run([crop(), crop(seed=1)], strip=0)) == ["texture", "crop", "crop-2"]


def test_a_grey_sample_counts_as_three_equal_channels():
    grey, colour = crop(channels=1), crop(seed=1)
    equal = Source(np.repeat(grey.pixels, 3, axis=2), 255)
    for sources, others in (([grey, colour], [equal, colour]), ([colour, grey], [colour, equal])):
        mixed, expected = run(sources), run(others)
        assert mixed["texture"] == expected["texture"]
        assert mixed["strip"] == expected["strip"]


def test_samples_of_8_and_of_16_bits_are_brought_to_one_range():
    coarse, other = crop(), crop(seed=1)
    deep = Source(other.pixels * 257, 65535)
    texture, expected = (pixels(run([coarse, second])["texture"]) for second in (deep, other))
    assert np.abs(texture - expected).max() <= 1


def test_samples_of_different_sizes_give_a_texture_of_the_first_ones_size():
    assert pixels(run([crop(30, 70), crop(90, 20, seed=1)])["texture"]).shape == (30, 70, 3)


def test_a_path_of_16_bits_is_the_same_more_finely():
    fine, coarse = (run([crop(), crop(seed=1)], depth=depth, strip=3) for depth in (16, 8))
    for name in ("mix-2", "strip"):
        assert np.abs(pixels(fine[name]) / 257 - pixels(coarse[name])).max() <= 0.51

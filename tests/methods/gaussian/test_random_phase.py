"""RPN and ADSN as the registry declares them: parameters, refusals, pictures."""

import io
from typing import Any

import numpy as np
import pytest
from imagecodecs import png_decode
from PIL import Image
from pydantic import ValidationError

from app.errors import CancelledError, InvalidInputError
from app.methods.context import Context
from app.methods.gaussian.random_phase import RandomPhaseParams
from app.methods.model import Size, Source
from app.methods.params import MAX_SEED
from app.methods.registry import METHODS, method
from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.gaussian import adsn as adsn_module
from app.synthesis.gaussian import rpn as rpn_module
from app.synthesis.gaussian.rpn import rpn

NAMES = ["texture", "crop", "periodic", "smooth", "spot", "input-spectrum", "output-spectrum"]
BOTH = pytest.mark.parametrize("name", ["rpn", "adsn"])


def crop(height=40, width=50, channels=3, peak=255, seed=0):
    """A crop whose left and right borders differ."""
    rng = np.random.default_rng(seed)
    values = rng.uniform(0.3, 0.6, (height, width, channels)) + np.linspace(0, 0.2, width)[None, :, None]
    return Source(np.round(values * peak).astype(np.float32), peak)


def pictures(name, source, *, depth=8, threads=2, progress=lambda stage, fraction: None, **parameters):
    entry = method(name)
    run = entry.pictures([source], entry.params(**parameters), Context(depth, threads, progress))
    return {picture.name: picture for picture in run}


def pixels(picture):
    return png_decode(picture.data)


@BOTH
def test_every_parameter_has_a_title_a_description_and_a_default(name):
    schema = METHODS[name].params.model_json_schema()
    assert list(schema["properties"]) == [
        "width", "height", "seed", "alpha", "window", "phase", "range", "periodic", "add_smooth",
    ]  # fmt: skip
    for parameter, field in schema["properties"].items():
        assert field["title"]
        assert field["description"].endswith(".") or parameter in ("width", "height")
        assert "default" in field
        assert field.get("advanced", False) == (parameter not in ("width", "height", "seed"))


@pytest.mark.parametrize(
    "wrong",
    [
        {"alpha": -0.01}, {"alpha": 0.51}, {"alpha": float("nan")}, {"window": "hann"}, {"phase": "shift"},
        {"range": "wrap"}, {"seed": -1}, {"seed": MAX_SEED + 1}, {"width": 0}, {"height": 0}, {"beta": 1},
    ],
)  # fmt: skip
def test_values_outside_what_is_declared_are_refused(wrong):
    with pytest.raises(ValidationError, match=rf"1 validation error for RandomPhaseParams\n{next(iter(wrong))}\n"):
        RandomPhaseParams(**wrong)


@BOTH
@pytest.mark.parametrize("size", [{"width": 51}, {"height": 80}, {"width": 80, "height": 40}])
def test_the_smooth_component_at_another_size_is_refused_with_words_that_help(name, size):
    entry = METHODS[name]
    with pytest.raises(InvalidInputError, match="own size, 50 × 40") as refusal:
        entry.resolve([Size(50, 40, 3)], entry.params(add_smooth=True, **size))
    assert refusal.value.field == "parameters.add_smooth"


@BOTH
def test_the_smooth_component_that_was_not_taken_out_cannot_be_added(name):
    entry = METHODS[name]
    with pytest.raises(InvalidInputError, match="turn “Periodic component” on") as refusal:
        entry.resolve([Size(50, 40, 3)], entry.params(add_smooth=True, periodic=False))
    assert refusal.value.field == "parameters.add_smooth"


@BOTH
@pytest.mark.parametrize("size", [{}, {"width": 50, "height": 40}, {"width": 50}])
def test_the_smooth_component_at_the_crops_size_is_fine(name, size):
    METHODS[name].resolve([Size(50, 40, 3)], METHODS[name].params(add_smooth=True, **size))


@BOTH
@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize(("height", "width"), [(None, None), (81, 120), (20, 70), (17, 13)])
def test_it_gives_every_step_as_a_picture(name, channels, height, width):
    made = pictures(name, crop(channels=channels), width=width, height=height)
    assert list(made) == NAMES
    height, width = height or 40, width or 50
    used = min(height, 40), min(width, 50)
    sizes = {
        "texture": (height, width), "crop": (40, 50), "periodic": used, "smooth": used, "spot": (height, width),
        "input-spectrum": used, "output-spectrum": (height, width),
    }  # fmt: skip
    for picture in made.values():
        assert picture.title
        assert (picture.height, picture.width) == sizes[picture.name]
        image = pixels(picture)
        assert image.dtype == np.uint8
        assert image.shape[:2] == sizes[picture.name]
        assert image.ndim == (2 if channels == 1 or "spectrum" in picture.name else 3)


def test_the_pictures_are_made_one_by_one_the_texture_first():
    entry, stages = method("rpn"), []
    run: Any = entry.pictures([crop()], entry.params(), Context(8, 1, lambda stage, fraction: stages.append(stage)))
    assert stages == []
    assert next(run).name == "texture"
    assert "output-spectrum" not in stages
    run.close()


def test_the_texture_is_the_rounded_noise_and_the_crop_is_the_crop():
    source = crop()
    made = pictures("rpn", source, width=90, height=70, seed=3)
    expected = np.floor(rpn(source.pixels, 70, 90, seed=3).clip(0, 255) + 0.5)
    assert np.abs(pixels(made["texture"]) - expected).max() <= 1
    assert (pixels(made["texture"]) == expected).mean() > 0.999
    assert (pixels(made["crop"]) == source.pixels).all()


def test_periodic_and_smooth_component_add_up_to_the_crop():
    source = crop()
    made = pictures("rpn", source)
    total = pixels(made["periodic"]).astype(float) + pixels(made["smooth"]) - source.pixels.mean((0, 1))
    assert np.abs(total - source.pixels).max() <= 1


@BOTH
@pytest.mark.parametrize(
    "parameters", [{}, {"width": 130, "height": 99}, {"range": "stretch", "phase": "replace", "periodic": False}]
)
def test_the_same_seed_gives_the_same_bytes_on_any_number_of_threads(name, parameters):
    one = pictures(name, crop(), threads=1, seed=5, **parameters)
    two = pictures(name, crop(), threads=2, seed=5, **parameters)
    assert one == two
    assert pictures(name, crop(), seed=6, **parameters)["texture"] != one["texture"]


@BOTH
def test_16_bits_hold_the_same_texture_more_finely(name):
    fine = pictures(name, crop(), depth=16, width=64, height=64)
    coarse = pictures(name, crop(), depth=8, width=64, height=64)
    image = pixels(fine["texture"])
    assert image.dtype == np.uint16
    assert np.abs(image / 257 - pixels(coarse["texture"])).max() <= 0.51
    assert len(np.unique(image)) > 256


def test_a_16_bit_sample_gives_the_8_bit_texture_of_its_own_values():
    source = crop(peak=65535)
    coarse, fine = pictures("rpn", source), pictures("rpn", source, depth=16)
    assert (pixels(fine["crop"]) == source.pixels).all()
    assert np.abs(pixels(fine["texture"]) / 257 - pixels(coarse["texture"])).max() <= 0.51


@BOTH
@pytest.mark.parametrize("range_", ["clip", "stretch"])
@pytest.mark.parametrize("size", [(8, 8), (30, 7)])
def test_a_constant_crop_gives_itself_back(name, range_, size):
    source = Source(np.full((8, 9, 3), [0, 77, 255], np.float32), 255)
    made = pictures(name, source, height=size[0], width=size[1], range=range_)
    for picture in ("texture", "periodic", "smooth", "spot"):
        assert (pixels(made[picture]) == [0, 77, 255]).all()


def test_stretching_leaves_nothing_cut_off():
    black_and_white = np.random.default_rng(0).integers(0, 2, (64, 64, 1)).astype(np.float32) * 255
    ends = {}
    for range_ in ("clip", "stretch"):
        image = pixels(pictures("rpn", Source(black_and_white, 255), range=range_)["texture"])
        ends[range_] = int(np.isin(image, (0, 255)).sum())
    assert ends["clip"] > 100
    assert 2 <= ends["stretch"] < 20


def test_the_spot_lies_in_the_middle_of_the_mean():
    source = crop()
    spot = pixels(pictures("rpn", source, width=100, height=80)["spot"]).astype(float)
    outside = np.ones((80, 100), bool)
    outside[20:60, 25:75] = False
    assert np.abs(spot[outside] - source.pixels.mean((0, 1))).max() <= 0.51
    assert spot[20:60, 25:75].std() > 10


@BOTH
@pytest.mark.parametrize("size", [{}, {"width": 100, "height": 80}, {"width": 30}])
def test_without_the_periodic_component_the_spot_is_the_crops_and_the_other_steps_stay(name, size):
    source = crop()
    made, usual = pictures(name, source, periodic=False, **size), pictures(name, source, **size)
    for step in ("crop", "periodic", "smooth"):
        assert made[step] == usual[step]
    for step in ("texture", "spot", "input-spectrum", "output-spectrum"):
        assert made[step].data != usual[step].data
    if not size:
        assert (pixels(made["spot"]) == source.pixels).all()
        # the slope along x jumps at the border, which is all in row 0 of the spectrum: the middle one of its picture
        spectra = [pixels(steps["input-spectrum"]).astype(float) for steps in (made, usual)]
        brightness = [spectrum[20].mean() - spectrum.mean() for spectrum in spectra]
        assert brightness[0] > brightness[1] + 20


@BOTH
def test_a_value_that_is_not_finite_is_refused(name):
    source = crop()
    source.pixels[1, 2, 0] = np.nan
    with pytest.raises(InvalidInputError, match="not finite"):
        pictures(name, source)


@pytest.mark.parametrize("stop_at", [0.0, 0.3, 0.7, 0.9])
def test_a_run_that_is_cancelled_stops(stop_at):
    fractions = []

    def progress(stage, fraction):
        fractions.append(fraction)
        if fraction >= stop_at:
            raise CancelledError("Stopped.")

    with pytest.raises(CancelledError, match="Stopped"):
        pictures("rpn", crop(), width=200, height=200, progress=progress)
    assert [fraction for fraction in fractions if fraction >= stop_at] == fractions[-1:]


@BOTH
@pytest.mark.parametrize("parameters", [{}, {"range": "stretch", "width": 200, "height": 150}])
def test_the_progress_never_goes_back_and_ends_at_one(name, parameters):
    fractions = []
    pictures(name, crop(), progress=lambda stage, fraction: fractions.append(fraction), **parameters)
    assert fractions == sorted(fractions)
    assert fractions[0] == 0
    assert fractions[-1] == pytest.approx(1)


def test_pillow_reads_the_texture():
    texture = pictures("adsn", crop(), width=60, height=61)["texture"]
    assert Image.open(io.BytesIO(texture.data)).convert("RGB").size == (60, 61)


@pytest.mark.parametrize(
    ("name", "module", "draw"), [("rpn", rpn_module, "random_phase"), ("adsn", adsn_module, "white_noise")]
)
def test_the_phase_is_drawn_in_the_numerics_file_of_the_methods_name(monkeypatch, name, module, draw):
    """With the phase that the file draws held at 0, the texture is the crop's periodic component."""
    source = crop()
    drawn = pixels(pictures(name, source)["texture"])
    monkeypatch.setattr(module, draw, lambda height, width, block, source: np.ones((height, block[1] - block[0]), "c8"))
    held = pixels(pictures(name, source)["texture"])
    expected = periodic_component(source.pixels)
    np.testing.assert_allclose(held, expected.clip(0, 255), atol=0.51)
    assert np.abs(drawn - expected).mean() > 5


@BOTH
def test_the_service_runs_the_function_that_the_file_is_named_after(monkeypatch, name):
    """A change to `rpn_field` or `adsn_field`, through which `rpn` and `adsn` go too, changes the service's texture."""
    module = {"rpn": rpn_module, "adsn": adsn_module}[name]
    source = crop()
    with_seed = pixels(pictures(name, source, seed=1)["texture"])
    noise = module.Noise
    monkeypatch.setattr(module, "Noise", lambda draw, *size, seed, **options: noise(draw, *size, seed=1, **options))
    assert (pixels(pictures(name, source, seed=0)["texture"]) == with_seed).all()
    assert (getattr(module, name)(source.pixels, seed=0) == getattr(module, name)(source.pixels, seed=1)).all()

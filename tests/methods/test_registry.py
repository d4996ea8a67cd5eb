"""What every method of the registry promises, whatever it computes."""

import io

import numpy as np
import pytest
from imagecodecs import png_decode
from latex2mathml.converter import convert
from PIL import Image

from app.experiments.preparation import NewExperiment, NewInput, prepare
from app.images.crop import Rectangle
from app.methods.allowed import Allowed
from app.methods.fields import fields
from app.methods.model import Method, Source
from app.methods.params import StillParams
from app.methods.registry import METHODS
from app.samples import read_catalogue
from app.settings import ROOT
from tests.bundled_samples import sample_of
from tests.methods.runs import run_small, sources_for

WITHOUT_CHANCE = {"modulus-phase"}  # nothing is drawn: the seed changes nothing
EVERY = pytest.mark.parametrize("method", METHODS.values(), ids=list(METHODS))
STILL = {name: method for name, method in METHODS.items() if not method.moving}
EVERY_STILL = pytest.mark.parametrize("method", STILL.values(), ids=list(STILL))


@EVERY
def test_every_parameter_has_a_title_a_description_and_a_default(method: Method) -> None:
    properties = method.params.model_json_schema()["properties"]
    assert list(properties)[:3] == list(StillParams.model_fields)
    for declared in properties.values():
        assert declared["title"]
        assert declared["description"].endswith(".")
        assert "default" in declared


@EVERY
def test_every_number_has_a_least_and_a_greatest_value(method: Method) -> None:
    """So that nothing downstream meets one that no float holds."""
    numbers = [entry for entry in fields(method.params) if entry.kind in ("integer", "number")]
    assert [entry.name for entry in numbers if not (entry.minimum and entry.maximum)] == []


@EVERY
def test_a_method_explains_itself(method: Method) -> None:
    """With prose, formulas that become MathML, what it fails at, figures and references of distinct keys."""
    explanation = method.explanation
    assert explanation.what
    assert explanation.fails
    assert len(explanation.figures) >= 2
    for formula in explanation.formulas:
        made = convert(formula.latex)
        assert made.startswith("<math")
        assert "\\" not in made, "a command that was not understood"
    keys = [reference.key for reference in method.references]
    assert len(set(keys)) == len(keys) > 0


@EVERY
def test_every_figure_is_an_experiment_on_bundled_samples_that_shows_its_outputs(method: Method) -> None:
    known = {entry.id: entry for entry in read_catalogue(ROOT / "samples")}
    for figure in method.explanation.figures:
        for exhibit in figure.exhibits:
            inputs = tuple(NewInput(sample, Rectangle.parse(crop)) for sample, crop in exhibit.inputs)
            assert {item.sample for item in inputs} <= known.keys()
            request = NewExperiment(exhibit.method, inputs, exhibit.parameters)
            prepared = prepare(
                request,
                "",
                sample=sample_of,
                transparent=lambda sample, crop, frames: False,
                allowed=Allowed(1 << 20, 1 << 24, 1 << 30),
            )
            assert prepared.method == exhibit.method
            assert exhibit.show


@EVERY_STILL
def test_the_texture_comes_first_and_every_crop_is_shown(method: Method) -> None:
    sources = sources_for(method)
    pictures = list(run_small(method, sources))
    names = [picture.name for picture in pictures]
    assert (names[0], pictures[0].kind) == ("texture", "texture")
    assert len(set(names)) == len(names)
    for number, source in enumerate(sources, 1):
        shown = pictures[names.index("crop" if number == 1 else f"crop-{number}")]
        assert (png_decode(shown.data) == source.pixels).all()
    for picture in pictures:
        with Image.open(io.BytesIO(picture.data)) as decoded:
            assert decoded.size == (picture.width, picture.height)


@EVERY_STILL
@pytest.mark.parametrize("shape", [(47, 53, 3), (48, 61, 1)], ids=["odd, colour", "even and prime, grey"])
def test_any_size_grey_or_colour_gives_a_texture_of_that_kind(method: Method, shape: tuple[int, int, int]) -> None:
    height, width, channels = shape
    texture = next(run_small(method, sources_for(method, height=height, width=width, channels=channels)))
    assert (texture.width, texture.height) == (width, height)
    pixels = png_decode(texture.data)
    assert pixels.shape == ((height, width, 3) if channels == 3 else (height, width))
    assert pixels.std() > 0


@EVERY_STILL
def test_sixteen_bits_are_the_same_texture_more_finely(method: Method) -> None:
    """Both depths are roundings of the same floats; a crop of 16 bits gives the texture of its 8-bit one, scaled.

    Heeger–Bergen goes on from its roundings, which are others at another scale: two bands' values change places.
    """
    sources = sources_for(method)
    coarse = png_decode(next(run_small(method, sources, depth=8)).data).astype(float)
    fine = png_decode(next(run_small(method, sources, depth=16)).data)
    assert fine.dtype == np.uint16
    assert np.abs(fine / 257 - coarse).max() <= 0.51
    deep = [Source(source.pixels * 257, 65535) for source in sources]
    assert np.abs(png_decode(next(run_small(method, deep, depth=8)).data) - coarse).max() <= (
        3 if method.name == "heeger-bergen" else 1
    )


@EVERY_STILL
def test_the_seed_alone_decides_and_not_the_threads(method: Method) -> None:
    sources = sources_for(method)
    first, again, other = (
        [picture.data for picture in run_small(method, sources, threads=threads, seed=seed)]
        for threads, seed in ((1, 5), (2, 5), (2, 6))
    )
    assert first == again
    assert (first[0] != other[0]) == (method.name not in WITHOUT_CHANCE)


@EVERY_STILL
def test_a_constant_crop_gives_that_constant(method: Method) -> None:
    constant = Source(np.full((48, 64, 3), (40, 120, 200), np.float32), 255)
    pixels = png_decode(next(run_small(method, [constant] * len(method.inputs))).data)
    assert np.abs(pixels.astype(int) - (40, 120, 200)).max() <= 1

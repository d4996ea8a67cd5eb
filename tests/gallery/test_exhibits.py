"""Exhibits are small experiments that can run, and are found by what they compute."""

import pytest

from app.experiments import exhibition
from app.experiments.preparation import NewExperiment, NewInput, prepare
from app.gallery.exhibits import exhibits
from app.gallery.groups import groups
from app.gallery.identity import identifier
from app.images.crop import Rectangle
from app.methods.allowed import Allowed
from app.methods.explanations.model import Exhibit
from app.methods.registry import METHODS
from tests.bundled_samples import sample_of

# Of a crop and of a texture: all exhibits together are made in a minute or two.
MOST_PIXELS, MOST_VIDEO_PIXELS = 640 * 512, 640 * 512 * 72
WAVES = Exhibit("rpn", (("two_sinusoids", "0,0,64,64"),), {"seed": 1})


@pytest.mark.parametrize("exhibit", exhibits().values(), ids=exhibits().keys())
def test_every_exhibit_is_a_small_experiment_that_can_run(exhibit: Exhibit) -> None:
    inputs = tuple(NewInput(sample, Rectangle.parse(crop)) for sample, crop in exhibit.inputs)
    experiment = prepare(
        NewExperiment(exhibit.method, inputs, exhibit.parameters),
        exhibition.OWNER,
        sample=sample_of,
        transparent=lambda sample, crop, frames: False,
        allowed=Allowed(MOST_PIXELS, MOST_VIDEO_PIXELS, 1 << 31),
    )
    assert max(source.crop.width * source.crop.height for source in experiment.inputs) <= MOST_PIXELS


def test_the_identifier_is_a_function_of_what_is_computed() -> None:
    same = Exhibit("rpn", WAVES.inputs, {"seed": 1, "alpha": 0.1}, ("texture",), "other words")
    assert identifier(same) == identifier(WAVES)
    others = [
        Exhibit("adsn", WAVES.inputs, WAVES.parameters),
        Exhibit("rpn", (("two_sinusoids", "0,0,64,63"),), WAVES.parameters),
        Exhibit("rpn", WAVES.inputs, {"seed": 2}),
    ]
    assert len({identifier(exhibit) for exhibit in (WAVES, *others)}) == 4


def test_every_method_is_told_of_once_also_one_that_stands_in_no_group(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(METHODS, "new", METHODS["rpn"])
    found = groups()
    assert sorted(name for group in found for name in group.names) == sorted(METHODS)
    assert found[-1].names == ("new",)

"""How many patches count: one parameter of all methods that join patches, with its refusals and its memory."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from imagecodecs import png_decode

from app.errors import InvalidInputError
from app.images.video.reader import read_video
from app.methods.model import Method, Picture, Size
from app.methods.patchwork.limits import summed
from app.methods.patchwork.patchwork import PATCHWORK
from app.methods.patchwork.transfer import TRANSFER
from app.methods.patchwork.video_patchwork import VIDEO_PATCHWORK
from app.methods.patchwork.video_transfer import VIDEO_TRANSFER
from app.methods.registry import METHODS
from tests.methods.runs import SMALL, a_clip, a_crop, run_small, sources_for

JOINING = [PATCHWORK, TRANSFER, VIDEO_PATCHWORK, VIDEO_TRANSFER]
MOSAIC = {"arrangement": "mosaic"}


def texture(method: Method, scratch, **parameters) -> np.ndarray:
    made: Picture = next(run_small(method, sources_for(method, height=60, width=70), scratch=scratch, **parameters))
    if isinstance(made.data, bytes):
        return png_decode(made.data).astype(float)
    return np.stack(list(read_video(made.data))).astype(float)


def test_every_method_that_has_a_sharpness_says_how_many_patches_count_in_the_same_words():
    assert [method for method in METHODS.values() if "sharpness" in method.params.model_fields] == JOINING
    fields = [method.params.model_fields["reach"] for method in JOINING]
    assert len({(field.title, field.description, field.annotation) for field in fields}) == 1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "more"),
    [*((method, {}) for method in JOINING), (VIDEO_PATCHWORK, MOSAIC)],
    ids=lambda value: value.name if isinstance(value, Method) else "-".join(value.values()),
)
def test_it_changes_the_texture_below_a_sharpness_of_six_and_nothing_from_there_on(method, more, tmp_path):
    for sharpness, same in ((2, False), (6, True)):
        one, other = (texture(method, tmp_path, sharpness=sharpness, reach=reach, **more) for reach in ("near", "all"))
        assert (one == other).all() == same
        assert one.shape == other.shape


@pytest.mark.parametrize(
    ("method", "sizes", "parameters"),
    [
        (PATCHWORK, [Size(512, 512, 3)], {"width": 4096, "height": 4096, "sharpness": 2}),
        (TRANSFER, [Size(512, 512, 3), Size(4000, 4000, 3)], {"candidates": 1}),
        (VIDEO_PATCHWORK, [Size(640, 480, 3, 96)], {"grid": 16, "sharpness": 2}),
        (VIDEO_PATCHWORK, [Size(640, 480, 3, 96)], {"grid": 16, "interval": 6, "sharpness": 2, **MOSAIC}),
        (VIDEO_PATCHWORK, [Size(1280, 960, 3, 2)], {"grid": 16, "interval": 1, "sharpness": 2}),
        (VIDEO_TRANSFER, [Size(320, 320, 3, 96), Size(1000, 800, 3)], {"candidates": 1}),
    ],
)
def test_a_sum_that_would_take_too_long_is_refused_with_what_helps(method, sizes, parameters):
    with pytest.raises(InvalidInputError, match="too long") as refusal:
        method.resolve(sizes, method.params(**parameters, reach="all"))
    assert refusal.value.field == "parameters.reach"
    assert "reach: near" in refusal.value.message
    method.resolve(sizes, method.params(**parameters, reach="near"))
    method.resolve(sizes, method.params(**parameters | {"sharpness": 6}, reach="all"))


@pytest.mark.parametrize(
    ("method", "sizes"),
    [
        (PATCHWORK, [Size(512, 512, 3)]),
        (TRANSFER, [Size(512, 512, 3), Size(512, 512, 3)]),
        (VIDEO_PATCHWORK, [Size(320, 320, 3, 72)]),
        (VIDEO_TRANSFER, [Size(320, 320, 3, 72), Size(320, 320, 3)]),
    ],
    ids=[method.name for method in JOINING],
)
@pytest.mark.parametrize("sharpness", [2, 3, 6])
def test_usual_sizes_are_not_refused(method, sizes, sharpness):
    method.resolve(sizes, method.params(sharpness=sharpness, reach="all"))


def test_a_sharp_join_needs_the_nearest_patch_alone():
    sizes = [Size(512, 512, 3)]
    PATCHWORK.resolve(sizes, PATCHWORK.params(width=4096, height=4096, sharpness=2, blend="sharp"))


@pytest.mark.slow
@pytest.mark.parametrize("method", [PATCHWORK, TRANSFER], ids=lambda method: method.name)
@pytest.mark.parametrize("tileable", [True, False])
def test_the_memory_it_asks_for_covers_what_all_patches_take(method, tileable, tmp_path):
    """Measured without the interpreter's own; inputs are there before."""
    sources = sources_for(method, height=200, width=220)
    parameters = {**SMALL[method.name], "sharpness": 1, "reach": "all", "width": 220, "height": 200}
    if method is PATCHWORK:
        parameters["tileable"] = tileable
    asked = method.memory_of([source.size for source in sources], method.params(**parameters))
    tracemalloc.start()
    try:
        for _ in run_small(method, sources, scratch=tmp_path, **parameters):
            pass
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < asked


@pytest.mark.parametrize("method", JOINING, ids=lambda method: method.name)
def test_the_memory_grows_with_what_is_held_around_the_sample(method):
    moving = method in (VIDEO_PATCHWORK, VIDEO_TRANSFER)
    size = Size(320, 320, 3, 72 if moving else 1)
    sizes = [size, replace(size, frames=1)][: len(method.inputs)]
    near, every = (method.memory_of(sizes, method.params(sharpness=2, reach=reach)) for reach in ("near", "all"))
    assert every != near
    assert every > 0


def test_pictures_of_one_pixel_and_clips_of_few_frames_can_be_summed(tmp_path):
    for width, height in ((1, 1), (1, 40), (40, 1)):
        made = next(run_small(PATCHWORK, [a_crop(60, 60)], width=width, height=height, sharpness=1, reach="all"))
        assert png_decode(made.data).shape[:2] == (height, width)
    film = next(
        run_small(
            VIDEO_PATCHWORK,
            [a_clip(60, 60)],
            scratch=tmp_path,
            frames=3,
            interval=2,
            sharpness=1,
            reach="all",
            **MOSAIC,
        )
    )
    assert len(list(read_video(film.data))) == 3


@pytest.mark.parametrize("method", JOINING, ids=lambda method: method.name)
def test_a_reach_that_changes_nothing_is_idle_and_sums_nothing(method):
    """From a sharpness of 6 on, and beside sharp joins; below it counts."""
    sizes = [source.size for source in sources_for(method)]
    assert not method.idle(sizes, method.fill(sizes, method.params(sharpness=5.9)))
    cases = [{"sharpness": 6}, *([{"sharpness": 2, "blend": "sharp"}] if method is PATCHWORK else [])]
    for parameters in cases:
        params = method.params(**parameters, reach="all")
        assert list(method.idle(sizes, method.fill(sizes, params))) == ["reach"]
        assert not summed(params)
    assert summed(method.params(sharpness=5.9, reach="all"))

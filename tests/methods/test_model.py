"""A method's parameters are resolved in one place, and it runs with nothing else."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app.errors import InvalidInputError, TooLargeError
from app.methods.allowed import Allowed
from app.methods.context import Context
from app.methods.model import Method, Picture, Size, Source
from app.methods.params import Resolved
from app.methods.registry import METHODS
from tests.methods.runs import a_crop, run_small, small, sources_for

EVERY = pytest.mark.parametrize("method", METHODS.values(), ids=list(METHODS))
QUIET = Context(8, 1, lambda stage, fraction: None)


@EVERY
def test_what_is_left_empty_is_the_methods_own_size_and_resolving_again_changes_nothing(method: Method) -> None:
    sizes = [source.size for source in sources_for(method)]
    resolved = method.resolve(sizes, small(method))
    assert (resolved.width, resolved.height) == method.size(sizes)
    assert resolved.frames == max(size.frames for size in sizes)
    assert resolved.shape == (resolved.frames, resolved.height, resolved.width)
    own = resolved.params.model_dump()
    assert (own["width"], own["height"]) == (resolved.width, resolved.height)
    assert own.get("frames", 1) == resolved.frames
    assert method.resolve(sizes, resolved.params) == resolved


@EVERY
def test_what_was_typed_stays(method: Method) -> None:
    sizes = [source.size for source in sources_for(method)]
    asked = {"width": 53, "height": 41} | ({"frames": 9} if method.moving else {})
    resolved = method.fill(sizes, small(method, **asked, seed=3))
    assert resolved.shape == (asked.get("frames", 1), 41, 53)
    assert resolved.params.seed == 3


@EVERY
def test_a_run_starts_with_resolved_parameters(method: Method) -> None:
    """So that a new method has no width that is None to think of."""
    seen: list[Resolved[Any]] = []

    def run(sources: Sequence[Source], resolved: Resolved[Any], context: Context) -> Iterator[Picture]:
        seen.append(resolved)
        return iter(())

    sources, params = sources_for(method), small(method)
    assert list(replace(method, run=run).pictures(sources, params, QUIET)) == []
    assert seen == [method.resolve([source.size for source in sources], params)]


def test_what_check_refuses_is_refused_before_anything_is_computed() -> None:
    def refuse(sizes: Sequence[Size], resolved: Resolved[Any]) -> None:
        raise InvalidInputError(f"{resolved.width} × {resolved.height}", "parameters.width")

    refusing = replace(METHODS["rpn"], check=refuse)
    with pytest.raises(InvalidInputError, match="64 × 48"):
        refusing.resolve([Size(64, 48, 3)], refusing.params())
    with pytest.raises(InvalidInputError, match="64 × 48"):
        refusing.pictures([a_crop()], refusing.params(), QUIET)


@EVERY
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_inputs_that_are_not_finite_are_refused_at_once(method: Method, value: float) -> None:
    for index in range(len(method.inputs)):
        sources = sources_for(method)
        sources[index].pixels[3, 5, 0] = value
        with pytest.raises(InvalidInputError, match="not finite numbers") as refused:
            run_small(method, sources)
        assert refused.value.field == f"inputs.{index}"


@pytest.mark.parametrize(
    ("name", "asked", "allowed", "words"),
    [
        ("rpn", {"width": 101, "height": 100}, Allowed(10_000, 10**9, 1), "this service makes at most 0"),
        ("dsn", {"width": 5000, "height": 5000}, Allowed(10**9, 10**9, 1), "the method dsn makes at most 17"),
        ("video-rpn", {"width": 64, "height": 48, "frames": 100}, Allowed(10**9, 300_000, 1), "100 frames of 64 × 48"),
        ("video-rpn", {"width": 64, "height": 48}, Allowed(3000, 10**9, 1), "A texture of 64 × 48"),
    ],
)
def test_more_pixels_than_are_allowed_are_refused_and_one_fewer_is_not(
    name: str, asked: dict[str, int], allowed: Allowed, words: str
) -> None:
    method = METHODS[name]
    sizes = [source.size for source in sources_for(method)]
    with pytest.raises(TooLargeError, match=words):
        method.resolve(sizes, method.params(**asked), allowed)
    method.resolve(sizes, method.params(**asked))
    fewer = {key: value * 3 // 5 for key, value in asked.items()}
    assert method.resolve(sizes, method.params(**fewer), allowed).width == fewer["width"]


def test_exactly_as_many_pixels_as_are_allowed_are_made() -> None:
    rpn, video = METHODS["rpn"], METHODS["video-rpn"]
    rpn.resolve([Size(100, 100, 3)], rpn.params(), Allowed(10_000, 1, 1))
    video.resolve([Size(10, 10, 3, 100)], video.params(), Allowed(100, 10_000, 1))


def test_memory_is_refused_above_what_is_allowed_with_what_makes_it_less() -> None:
    allowed = Allowed(1, 1, 10 * 2**20)
    allowed.refuse_memory(10 * 2**20, moving=True)
    with pytest.raises(TooLargeError, match=r"about 12 MB .* has 10 MB .* fewer frames"):
        allowed.refuse_memory(12 * 2**20, moving=True)
    with pytest.raises(TooLargeError, match=r"take a smaller crop, or a smaller width and height\."):
        allowed.refuse_memory(12 * 2**20, moving=False)


def test_a_still_picture_in_the_place_of_a_clip_is_a_fault_of_the_caller() -> None:
    with pytest.raises(TypeError, match="takes a video"):
        _ = a_crop().require_clip()

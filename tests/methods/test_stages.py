"""Progress: methods declare their stages with weights, reach all of them, and stop where the progress raises."""

from collections.abc import Mapping, Sequence
from itertools import groupby, pairwise
from pathlib import Path
from typing import Any

import pytest

from app.errors import CancelledError
from app.methods.registry import METHODS
from app.methods.stages import Stages
from tests.methods.runs import VARIANTS, inputs_of, run_small, small

Calls = list[tuple[str, float]]
# Large enough for several blocks of work; what is searched pixel by pixel stays small.
SHAPE: Mapping[str, Mapping[str, int]] = {
    "efros-leung": {"height": 32, "width": 40},
    "patchwork": {"height": 400, "width": 80},
}
USUAL = {"height": 160, "width": 176}
LARGEST_STEP, MOST_CALLS = 0.3, 2000
MORE: Sequence[tuple[str, Mapping[str, Any], int]] = (
    ("rpn", {"range": "stretch"}, 1),
    ("adsn", {"width": 200, "height": 190}, 1),
    ("texton", {"cut": 5}, 1),
    ("video-rpn", {"width": 190, "frames": 14}, 1),
    ("transfer", {"candidates": 0}, 2),
)
EVERY = pytest.mark.parametrize(("name", "parameters", "count"), [*VARIANTS, *MORE], ids=str)


def calls_of(name: str, parameters: Mapping[str, Any], count: int, scratch: Path, stop_at: int = 10**9) -> Calls:
    """Run a method, and raise at a call of the progress, counted from 0."""
    method, calls = METHODS[name], Calls()

    def progress(stage: str, fraction: float) -> None:
        calls.append((stage, fraction))
        if len(calls) > stop_at:
            raise CancelledError("enough")

    sources = inputs_of(method, count, **SHAPE.get(name, USUAL))
    try:
        list(run_small(method, sources, scratch=scratch, progress=progress, **parameters))
    except CancelledError:
        assert len(calls) == stop_at + 1
    else:
        assert len(calls) <= stop_at
    return calls


def in_order(names: Sequence[str]) -> list[str]:
    return [name for name, _ in groupby(names)]


@EVERY
def test_a_run_goes_through_the_stages_that_are_declared_and_moves(
    name: str, parameters: Mapping[str, Any], count: int, tmp_path: Path
) -> None:
    """All of them in their order; the fraction never falls, ends at 1, and makes no great leap."""
    method = METHODS[name]
    sizes = [source.size for source in inputs_of(method, count, **SHAPE.get(name, USUAL))]
    plan = method.stages(sizes, method.fill(sizes, small(method, **parameters)))
    calls = calls_of(name, parameters, count, tmp_path)
    names, fractions = zip(*calls, strict=True)
    assert in_order(names) == in_order([stage for stage, _ in plan])
    assert all(stage == stage.lower() for stage in names)
    assert all(weight > 0 for _, weight in plan)
    assert all(before <= after for before, after in pairwise((0.0, *fractions)))
    assert fractions[-1] == 1
    assert max(after - before for before, after in pairwise((0.0, *fractions))) <= LARGEST_STEP
    assert len(plan) <= len(calls) <= MOST_CALLS


@EVERY
def test_a_stage_that_is_reported_again_and_again_moves_on(
    name: str, parameters: Mapping[str, Any], count: int, tmp_path: Path
) -> None:
    calls = calls_of(name, parameters, count, tmp_path)
    for _, group in groupby(calls, lambda call: call[0]):
        fractions = [fraction for _, fraction in group]
        assert len(fractions) < 4 or len(set(fractions)) > len(fractions) / 2


@EVERY
@pytest.mark.parametrize("part", [0.0, 0.3, 0.6, 0.9])
def test_what_the_progress_raises_ends_the_run_before_it_is_called_again(
    name: str, parameters: Mapping[str, Any], count: int, part: float, tmp_path: Path
) -> None:
    total = len(calls_of(name, parameters, count, tmp_path))
    stop_at = int(part * total)
    assert len(calls_of(name, parameters, count, tmp_path, stop_at)) == stop_at + 1


def reported(plan: Sequence[tuple[str, float]], *calls: tuple[str, float]) -> Calls:
    found = Calls()
    stages = Stages(plan, lambda stage, fraction: found.append((stage, fraction)))
    for call in calls:
        stages(*call)
    return found


def test_the_part_of_a_stage_is_weighed_against_the_others() -> None:
    plan = (("one", 1), ("two", 3), ("three", 4))
    assert reported(plan, ("one", 0), ("one", 1), ("two", 1 / 3), ("three", 0.5), ("three", 1)) == [
        ("one", 0), ("one", 0.125), ("two", 0.25), ("three", 0.75), ("three", 1)
    ]  # fmt: skip


def test_a_name_may_come_again_as_that_of_a_later_stage() -> None:
    """After another stage, or, right behind itself, when its part begins anew."""
    plan = (("one", 1), ("two", 1), ("one", 1), ("one", 1))
    assert [fraction for _, fraction in reported(plan, ("one", 1), ("two", 0), ("one", 0.5), ("one", 0))] == [
        0.25, 0.25, 0.625, 0.75
    ]  # fmt: skip


@pytest.mark.parametrize("calls", [[("four", 0)], [("two", 0), ("one", 0)], [("two", 0.5), ("two", 0.4)]])
def test_a_stage_that_is_not_declared_or_not_in_this_place_is_a_fault(calls: Calls) -> None:
    with pytest.raises(LookupError, match="the stages are: one, two"):
        reported((("one", 1), ("two", 1)), *calls)


def test_what_is_one_stage_here_may_have_stages_of_its_own() -> None:
    found = Calls()
    whole = Stages((("method", 4), ("writing", 1)), lambda stage, fraction: found.append((stage, fraction)))
    inner = Stages((("spot", 1), ("texture", 1)), whole.within("method"))
    inner("spot", 0.5)
    inner.finish()
    whole.finish()
    assert found == [("spot", 0.2), ("texture", 0.8), ("writing", 1)]

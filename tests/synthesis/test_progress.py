"""Progress as one kind: of everything that reports, how often, how evenly, and that it ends there when told to."""

import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest

import app.synthesis
from app.synthesis.arrays import Progress
from app.synthesis.fourier.field import Noise, NoiseField
from app.synthesis.fourier.spot_noise import convolve, sample_spot
from app.synthesis.gaussian.adsn import adsn, adsn_field, adsn_of_spot, white_noise
from app.synthesis.gaussian.cut_texton import cut_texton
from app.synthesis.gaussian.dsn import dsn
from app.synthesis.gaussian.mixing import Mixture, mix
from app.synthesis.gaussian.modulus_phase import swap
from app.synthesis.gaussian.rayleigh import rayleigh
from app.synthesis.gaussian.rpn import random_phase, rpn, rpn_field
from app.synthesis.gaussian.texton import extend_texton, texton, texton_noise
from app.synthesis.gaussian.video_rpn import VideoNoiseField, video_rpn
from app.synthesis.parallel import Team, Work
from app.synthesis.patchwork.cell_match import match_cells
from app.synthesis.patchwork.jittered_cells import jittered_cells
from app.synthesis.patchwork.patchwork import patchwork
from app.synthesis.patchwork.transfer import transfer
from app.synthesis.patchwork.video_patchwork import frames_in_order
from app.synthesis.pyramid.heeger_bergen import heeger_bergen
from app.synthesis.sampling.efros_leung import efros_leung
from app.synthesis.sampling.window_search import WindowSearch
from tests.synthesis.stopping import stops_at

RNG = np.random.default_rng(0)
H = RNG.uniform(0, 255, (48, 52, 3)).astype(np.float32)
TALL = RNG.uniform(0, 255, (320, 52, 3)).astype(np.float32)
LARGE = RNG.uniform(0, 255, (100, 96, 3)).astype(np.float32)
VIDEO = RNG.uniform(0, 255, (6, 24, 20, 3)).astype(np.float32)
MEAN = H.mean((0, 1), dtype=np.float64)


def in_team(work: Callable[[Team, Progress], object]) -> Callable[[Progress], object]:
    def run(progress: Progress) -> None:
        with Team(2) as team:
            work(team, progress)

    return run


def field(draw: Callable[..., object], team: Team, progress: Progress) -> None:
    NoiseField(TALL, Noise(draw, 600, 640), team, progress).array()  # type: ignore[arg-type]


def mixture(team: Team, progress: Progress) -> None:
    Mixture([TALL, TALL[::-1]], [0.5, 0.5], Noise(white_noise, 400, 640), team, progress).emit(
        [1, 0], lambda y, planes: None
    )


def matching(team: Team, progress: Progress) -> None:
    cells = jittered_cells(520, 60, grid=12, sharpness=6, tileable=False, seed=1)
    match_cells(LARGE, pattern(), cells, peak=255, candidates=5, seed=1, work=Work(team, progress))


def transferring(team: Team, progress: Progress) -> None:
    cells = jittered_cells(520, 60, grid=12, sharpness=6, tileable=False, seed=1)
    transfer(LARGE, pattern(), cells, peak=255, candidates=5, seed=1, work=Work(team, progress))


def pattern() -> np.ndarray:
    return np.tile(LARGE, (6, 1, 1))[:520, :60]


def extended() -> list[object]:
    return [extend_texton(texton(H), MEAN, 60, 64)]


class Reports(NamedTuple):
    """What a piece of work must report: its stages in their order, calls at least, and the largest step of a stage."""

    work: Callable[[Progress], object]
    stages: tuple[str, ...]
    calls: int
    step: float


NOISE = ("spot", "random phase", "texture")
WORK = {
    "rpn": Reports(lambda p: rpn(TALL, 600, 640, progress=p), NOISE, 24, 0.201),
    "adsn": Reports(lambda p: adsn(TALL, 600, 640, progress=p), NOISE, 24, 0.201),
    "rpn_field": Reports(in_team(lambda t, p: rpn_field(TALL, 600, 640, team=t, progress=p).array()), NOISE, 24, 0.201),
    "adsn_field": Reports(
        in_team(lambda t, p: adsn_field(TALL, 600, 640, team=t, progress=p).array()), NOISE, 24, 0.201
    ),
    "NoiseField": Reports(in_team(lambda t, p: field(random_phase, t, p)), NOISE, 24, 0.201),
    "adsn_of_spot": Reports(lambda p: adsn_of_spot(sample_spot(H, 60, 64), 1, progress=p), ("texture",), 4, 0.34),
    "convolve": Reports(
        lambda p: convolve([sample_spot(H, 60, 64)], [np.ones((60, 33), np.complex64)], progress=p),
        ("texture",), 4, 0.34,
    ),
    "dsn": Reports(lambda p: dsn(sample_spot(H, 60, 64), 10, progress=p), ("points", "texture"), 6, 0.51),
    "mix": Reports(lambda p: mix([TALL, TALL[::-1]], None, 400, 640, progress=p), NOISE, 24, 0.201),
    "Mixture": Reports(in_team(mixture), NOISE, 24, 0.201),
    "rayleigh": Reports(lambda p: rayleigh(H, progress=p), ("rayleigh noise",), 10, 0.14),
    "swap": Reports(lambda p: swap(H, H[::-1], progress=p), ("swap",), 10, 0.14),
    "texton": Reports(lambda p: texton(H, progress=p), ("texton",), 3, 0.25),
    "texton_noise": Reports(
        lambda p: texton_noise(H, extended(), progress=p), ("random phase", "texture"), 7, 0.41  # type: ignore[arg-type]
    ),
    "cut_texton": Reports(lambda p: cut_texton(H, MEAN, 60, 64, 5, progress=p), ("texton",), 40, 0.11),
    "video_rpn": Reports(
        lambda p: video_rpn(VIDEO, 8, 30, 32, progress=p), ("periodic", "spot", "random phase"), 40, 0.17
    ),
    "VideoNoiseField": Reports(
        in_team(
            lambda t, p: VideoNoiseField(VIDEO, (6, 24, 20), seed=0, alpha=0.1, profile="bump", team=t, progress=p)
        ),
        ("periodic", "random phase"), 15, 0.17,
    ),
    "heeger_bergen": Reports(
        lambda p: heeger_bergen(H, iterations=2, progress=p),
        ("sample", "noise", "iteration 1", "iteration 2"), 100, 0.34,
    ),
    "efros_leung": Reports(
        lambda p: efros_leung(LARGE, 110, 100, half_patch=1, progress=p), ("order", "patches", "growth"), 228, 0.45
    ),
    "WindowSearch": Reports(
        in_team(lambda t, p: WindowSearch(LARGE, 1, t, lambda part: p("patches", part))), ("patches",), 4, 0.45
    ),
    "patchwork": Reports(lambda p: patchwork(LARGE, 800, 100, grid=16, progress=p), ("texture",), 5, 0.26),
    "match_cells": Reports(in_team(matching), ("matching",), 15, 0.1),
    "best_matches": Reports(in_team(matching), ("matching",), 15, 0.1),
    "transfer": Reports(in_team(transferring), ("matching", "averages", "texture"), 25, 0.26),
    "frames_in_order": Reports(
        lambda p: list(frames_in_order(lambda n: H, 7, 2, lambda part: p("frames", part))), ("frames",), 7, 0.15
    ),
    "Work": Reports(
        in_team(lambda t, p: Work(t, p).run("items", lambda item: None, range(7))), ("items",), 8, 0.15
    ),
}  # fmt: skip
# The statistics of Heeger–Bergen report within `heeger_bergen`.
WITHIN = {"SampleStatistics": "heeger_bergen", "Synthesis": "heeger_bergen"}
EACH = pytest.mark.parametrize("name", WORK)


def reporters() -> Iterator[str]:
    """Names of all functions and classes of the numerics that take a progress, or the work that has one."""
    for module in pkgutil.walk_packages(app.synthesis.__path__, "app.synthesis."):
        for name, value in vars(importlib.import_module(module.name)).items():
            defined = getattr(value, "__module__", None) == module.name and not name.startswith("_")
            if defined and (inspect.isfunction(value) or (inspect.isclass(value) and "__init__" in vars(value))):
                parameters = inspect.signature(value).parameters
                if {"progress", "work", "report"} & parameters.keys():
                    yield name


def reported(name: str) -> list[tuple[str, float]]:
    calls: list[tuple[str, float]] = []
    WORK[name].work(lambda stage, part: calls.append((stage, part)))
    return calls


def test_everything_that_reports_is_looked_at_here() -> None:
    assert sorted(reporters()) == sorted({*WORK, *WITHIN})
    assert set(WITHIN.values()) <= WORK.keys()


@EACH
def test_stages_come_in_their_order_and_rise_to_one(name: str) -> None:
    calls = reported(name)
    stages = [stage for stage, _ in calls]
    assert list(dict.fromkeys(stages)) == list(WORK[name].stages)
    assert stages == sorted(stages, key=WORK[name].stages.index)
    for stage in WORK[name].stages:
        parts = [part for each, part in calls if each == stage]
        assert parts == sorted(parts)
        assert 0 <= parts[0] <= parts[-1] <= 1
    assert calls[-1][1] == 1


@EACH
def test_it_moves_often_and_in_small_steps(name: str) -> None:
    """No stage stands at its beginning and then jumps to its end: a step is a small part of it."""
    calls = reported(name)
    assert len(calls) >= WORK[name].calls
    steps = [here - before for (was, before), (stage, here) in pairwise(calls) if was == stage]
    assert max(steps, default=0) <= WORK[name].step


@EACH
@pytest.mark.parametrize("place", [0, 0.3, 0.6, 0.9, 1])
def test_it_ends_at_any_call_that_raises(name: str, place: float) -> None:
    """At the first, at the last, and between: nothing more is reported, and the error comes out."""
    count = len(reported(name))
    stops_at(1 + round(place * (count - 1)), WORK[name].work)

"""The search for patches against the plain definition of the sum of squared differences."""

from itertools import pairwise

import numpy as np
import pytest

from app.synthesis.parallel import Team, Work
from app.synthesis.patchwork.best_places import PatternPatches, best_matches
from tests.synthesis.images import image
from tests.synthesis.stopping import stops_at


def patches_of(height, width, texture_shape, count=12, seed=0):
    """Rectangles of several sizes about random centres, and every place where they lie within the texture."""
    rng = np.random.default_rng(seed)
    size, shape = np.array((height, width)), np.array(texture_shape[:2])
    centres = rng.integers(0, size, (count, 2))
    tops = np.maximum(centres - rng.integers(0, 9, (count, 2)), 0)
    bottoms = np.minimum(centres + rng.integers(1, 9, (count, 2)), size)
    boxes = np.stack([tops[:, 0], bottoms[:, 0], tops[:, 1], bottoms[:, 1]], axis=1)
    return PatternPatches(centres, boxes, centres - tops, shape - (bottoms - centres))


def matches(texture, pattern, patches, candidates, *, seed=0, threads=1, peak=255, progress=lambda stage, part: None):
    with Team(threads) as team:
        work = Work(team, progress)
        return best_matches(texture, pattern, patches, peak=peak, candidates=candidates, seed=seed, work=work)


def distance(texture, pattern, patches, number, place):
    """The sum of squared differences as it is defined."""
    top, bottom, left, right = patches.boxes[number]
    y, x = place - patches.centres[number]
    there = texture[top + y : bottom + y, left + x : right + x].astype(float)
    return np.square(there - pattern[top:bottom, left:right]).sum()


@pytest.mark.parametrize("channels", [1, 3])
def test_among_all_places_the_best_one_is_found(channels):
    """As by trying them one by one. The texture is larger than a tile in one direction."""
    texture, pattern = image(140, 26, channels).round(), image(20, 24, channels, seed=1).round()
    patches = patches_of(20, 24, texture.shape)
    found = matches(texture, pattern, patches, 0)
    for number in range(len(patches)):
        rows, columns = (np.arange(a, b + 1) for a, b in zip(patches.first[number], patches.last[number], strict=True))
        tried = {(y, x): distance(texture, pattern, patches, number, (y, x)) for y in rows for x in columns}
        assert found.errors[number] == min(tried.values()) == tried[tuple(found.places[number])]


def test_a_few_candidates_are_compared_exactly_and_within_their_bounds():
    texture, pattern = image(60, 70).round(), image(24, 30, seed=1).round()
    patches = patches_of(24, 30, texture.shape)
    found = matches(texture, pattern, patches, 7)
    assert (found.places >= patches.first).all()
    assert (found.places <= patches.last).all()
    expected = [distance(texture, pattern, patches, number, place) for number, place in enumerate(found.places)]
    assert found.errors.tolist() == expected
    assert (found.sizes == (patches.boxes[:, 1::2] - patches.boxes[:, ::2]).prod(1)).all()


def test_more_candidates_of_the_same_seed_never_match_worse():
    """Each set includes the smaller ones, and the last one is of all places."""
    texture, pattern = image(60, 70), image(40, 50, seed=1)
    patches = patches_of(40, 50, texture.shape, 40)
    errors = [matches(texture, pattern, patches, count, seed=5).errors for count in (1, 2, 20, 200, 2000, 10**6, 0)]
    for fewer, more in pairwise(errors):
        assert (more <= fewer).all()
    assert (errors[1] < errors[0]).any()
    assert (errors[-1] == errors[-2]).all()


def test_another_seed_draws_other_candidates():
    texture, pattern = image(60, 70), image(24, 30, seed=1)
    patches = patches_of(24, 30, texture.shape)
    one, again, other = (matches(texture, pattern, patches, 3, seed=seed).places for seed in (1, 1, 2))
    assert (one == again).all()
    assert (one != other).any()


@pytest.mark.parametrize("candidates", [0, 30])
def test_neither_threads_nor_the_range_of_values_change_what_is_found(candidates):
    texture, pattern = image(60, 70).round(), image(40, 50, seed=1).round()
    patches = patches_of(40, 50, texture.shape, 40)
    one = matches(texture, pattern, patches, candidates)
    many = matches(texture, pattern, patches, candidates, threads=3)
    deep = matches(texture * 257, pattern * 257, patches, candidates, peak=65535)
    assert (one.places == many.places).all()
    assert (one.errors == many.errors).all()
    assert (one.places == deep.places).all()
    assert deep.errors == pytest.approx(one.errors * 257**2, rel=1e-12)


def test_what_is_in_the_texture_is_found_there():
    texture = image(90, 80)
    patches = patches_of(40, 50, texture.shape)
    found = matches(texture, texture[20:60, 10:60], patches, 0)
    assert (found.places == patches.centres + np.array((20, 10))).all()
    assert (found.errors == 0).all()


def test_equal_places_are_all_the_same_to_it():
    """On a constant texture every place is right, and the errors are exact."""
    texture, pattern = np.full((40, 40, 1), 100, np.float32), np.full((20, 20, 1), 90, np.float32)
    patches = patches_of(20, 20, texture.shape)
    for candidates in (0, 5):
        found = matches(texture, pattern, patches, candidates)
        assert (found.errors == 100 * found.sizes).all()


@pytest.mark.parametrize("candidates", [0, 5])
def test_it_stops_when_the_progress_raises(candidates):
    texture, pattern = image(60, 70), image(40, 50, seed=1)
    patches = patches_of(40, 50, texture.shape, 40)
    stops_at(2, lambda progress: matches(texture, pattern, patches, candidates, progress=progress))

"""Sequences rearranged in time: inside the clip, circular, of the clip's mean and deviation."""

import numpy as np
import pytest

from app.synthesis.patchwork.transitions import Transitions, longest_interval

LOOP = pytest.mark.parametrize("loop", [True, False], ids=["loop", "no loop"])


def drawn(sequences, clip, frames, interval, loop, seed=0):
    return Transitions(sequences, clip, frames, interval, loop=loop, rng=np.random.default_rng(seed))


@LOOP
@pytest.mark.parametrize("frames", [1, 2, 3, 8, 72, 73, 150])
@pytest.mark.parametrize("clip", [1, 2, 5, 24, 72])
def test_every_frame_asked_for_lies_inside_the_clip_up_to_the_longest_interval(frames, clip, loop):
    longest = longest_interval(clip, frames, loop)
    for interval in {1, max(1, longest // 2), longest}:
        transitions = drawn(40, clip, frames, interval, loop)
        for frame in range(frames):
            mix = transitions.mix(frame)
            assert min(mix.first.min(), mix.second.min()) >= 0
            assert max(mix.first.max(), mix.second.max()) < clip


def test_beyond_the_longest_interval_some_draw_asks_for_a_frame_that_there_is_not():
    longest = longest_interval(24, 200, loop=True)
    with pytest.raises(ValueError, match="low >= high"):
        drawn(1000, 24, 200, longest + 3, loop=True)


@LOOP
def test_transition_points_are_about_an_interval_apart_and_jittered(loop):
    """Equal parts of at most 18 frames: points in their middle halves are 9 to 27 frames apart, 18 on average."""
    transitions = drawn(400, 72, 72, 18, loop)
    whole = np.array([transitions.mix(frame).beta == 0 for frame in range(72)])
    assert (whole.sum(0) == 4).all()
    gaps = np.concatenate([np.diff(np.flatnonzero(of_one)) for of_one in whole.T])
    assert gaps.min() >= 9
    assert gaps.max() <= 27
    assert len(np.unique(gaps)) > 10


@LOOP
def test_every_part_plays_on_frame_by_frame_until_it_counts_for_nothing(loop):
    """A step keeps both parts of a transition, or drops the first when the second has replaced it.

    In a loop that is so for the step from the last frame to the first too.
    """
    frames = 60
    transitions = drawn(300, 48, frames, 12, loop)
    for frame in range(frames if loop else frames - 1):
        now, then = transitions.mix(frame), transitions.mix((frame + 1) % frames)
        goes_on = (then.first == now.first + 1) & ((then.second == now.second + 1) | (now.beta == 0))
        replaced = (then.first == now.second + 1) & (then.beta == 0)
        assert (goes_on | replaced).all()
        assert (then.beta >= now.beta)[goes_on & (then.beta > 0)].all()


def test_without_loop_the_last_frame_does_not_continue_in_the_first():
    transitions = drawn(300, 48, 60, 12, loop=False)
    last, first = transitions.mix(59), transitions.mix(0)
    assert (first.first != last.first + 1).mean() > 0.5


@LOOP
def test_mean_and_deviation_are_the_clips_in_every_frame_also_amid_transitions(loop):
    """White noise of deviation 1 in 4000 pixels, 60 sequences: of a frame's deviation over all of them 1 % is chance.

    Both parts of a transition show the same frame once in about 30 draws, which adds less than 2 %. A plain cross-fade
    would have the deviation 0.71 amid a transition.
    """
    rng = np.random.default_rng(1)
    video = rng.standard_normal((72, 4000))
    average = video.mean(0)
    transitions = drawn(60, 72, 72, 18, loop)
    amid = []
    for frame in range(0, 72, 5):
        mix = transitions.mix(frame)
        first, second = video[mix.first] - average, video[mix.second] - average
        made = mix.alpha[:, None] * first + mix.beta[:, None] * second
        assert abs(made.mean()) < 0.02
        assert made.std() == pytest.approx(1, abs=0.04)
        amid.append(made[mix.beta > 0.6])
    values = np.concatenate(amid)
    assert len(values) > 100
    assert values.std() == pytest.approx(1, abs=0.05)
    np.testing.assert_allclose(mix.alpha**2 + mix.beta**2, 1, rtol=1e-6)


def test_the_weights_are_the_cosines_of_the_report():
    """w₁ + w₂ = 1, so α / (α + β) is w₁ = ½ + ½ cos(πu) with u = (t − p_i) / (p_{i+1} − p_i)."""
    transitions = drawn(1, 72, 72, 18, loop=True)
    mixes = [transitions.mix(frame) for frame in range(72)]
    begin, end = [frame for frame in range(72) if mixes[frame].beta[0] == 0][:2]
    for frame in range(begin, end):
        u = (frame - begin) / (end - begin)
        alpha, beta = float(mixes[frame].alpha[0]), float(mixes[frame].beta[0])
        assert alpha / (alpha + beta) == pytest.approx(0.5 + 0.5 * np.cos(np.pi * u), abs=1e-6)

"""The random phase in three dimensions is odd, uniform, and at rest that of RPN."""

import itertools

import numpy as np
import pytest

from app.synthesis.fourier.spectral import half_spectrum
from app.synthesis.gaussian.rpn import random_phase
from app.synthesis.gaussian.video_phase import conjugate_rows, random_phase_rows

SHAPES = [(1, 1, 1), (2, 1, 5), (4, 6, 8), (5, 7, 11), (8, 9, 6), (7, 16, 13), (12, 17, 16)]


def whole_phase(shape, seed):
    frames, height, width = shape
    flat = half_spectrum(random_phase, height, width, seed)
    phase = np.empty((frames, height, width // 2 + 1), np.complex64)
    for row in range(height // 2 + 1):
        phase[:, conjugate_rows(row, height)] = random_phase_rows(shape, row, flat, seed)
    return phase


@pytest.mark.parametrize("shape", [*SHAPES, (6, 8, 2), (2, 2, 2), (9, 4, 1)])
def test_the_phase_is_odd_and_zero_at_the_origin(shape):
    """Then its inverse transform is real: the transform of that is the phase again, and not its odd part."""
    phase = whole_phase(shape, 3)
    np.testing.assert_allclose(np.abs(phase), 1, atol=1e-6)
    assert phase[0, 0, 0] == 1
    again = np.fft.rfftn(np.fft.irfftn(phase, s=shape, axes=(0, 1, 2)), axes=(0, 1, 2))
    np.testing.assert_allclose(again, phase, atol=1e-5)
    sides = [{0, side // 2} if side % 2 == 0 else {0} for side in shape]
    for k in itertools.product(*sides):
        assert phase[k] in (1, -1)


def test_the_phase_is_uniform_and_independent_of_the_next_one():
    """Sums of n independent exp(iθ), exp(2iθ) and exp(i(θ − θ')) have a modulus² of mean n: 16 n has chance e^−16."""
    phase = whole_phase((24, 31, 40), 7)[1:, 1:16, 1:20]  # no frequency together with its opposite
    for terms in (phase, phase**2, phase[1:] * phase[:-1].conj(), phase[:, 1:] * phase[:, :-1].conj()):
        assert abs(terms.sum()) ** 2 < 16 * terms.size


def test_a_phase_that_must_be_its_own_opposite_is_0_or_pi_with_equal_chances():
    """4 standard deviations of 200 coins, at each of the seven places."""
    signs = np.array([whole_phase((2, 2, 2), seed).real for seed in range(200)]).reshape(200, -1)[:, 1:]
    assert (np.abs(signs.sum(0)) < 4 * np.sqrt(200)).all()


@pytest.mark.parametrize("shape", SHAPES)
def test_at_frequency_0_in_time_it_is_the_phase_of_rpn(shape):
    assert (whole_phase(shape, 3)[0] == half_spectrum(random_phase, *shape[1:], 3)).all()


@pytest.mark.parametrize("height", [1, 2, 5, 6])
def test_every_row_is_drawn_once_with_its_opposite(height):
    rows = [conjugate_rows(row, height) for row in range(height // 2 + 1)]
    assert sorted(itertools.chain(*rows)) == list(range(height))
    assert all(sum(pair) % height == 0 for pair in rows if len(pair) == 2)

"""Random phase in three dimensions, on the half spectrum of a video.

The transform of a real video of T frames is kept as `scipy.fft.rfftn` over (t, y, x) gives it: k₀ = 0 … T − 1 in time,
k₁ = 0 … H − 1 down and k₂ = 0 … W // 2 across; the other half follows from ĥ(−k) = conj ĥ(k). Column 0, and for
an even W column W / 2, hold both k and −k, in the rows k₁ and −k₁. So these two rows are drawn together, each pair from
a stream of its own.
"""

import numpy as np
from numpy.random import SFC64, SeedSequence

from ..arrays import Complex
from ..fourier.spectral import STATES, symmetrise
from .rpn import phase_table


def conjugate_rows(row: int, height: int) -> list[int]:
    """List the rows k₁ and −k₁, which may be one.

    Examples
    --------
    >>> conjugate_rows(1, 6), conjugate_rows(0, 6), conjugate_rows(3, 6)
    ([1, 5], [0], [3])
    """
    return [row] if (2 * row) % height == 0 else [row, height - row]


def random_phase_rows(shape: tuple[int, int, int], row: int, flat: Complex, seed: int) -> Complex:
    """Draw ``exp(iθ)`` at the rows k₁ and −k₁ of the half spectrum of a video, which depend on no other row.

    Parameters
    ----------
    shape : tuple of int
        Frames, height and width of the video.
    row : int
        k₁, 0 to height // 2.
    flat : ndarray of complex64, shape (height, width // 2 + 1)
        The phase at frequency 0 in time: that of `microtexture.gaussian.rpn` at this seed, so that a video
        that stands still has the phase of its RPN.
    seed : int
        Not negative.

    Returns
    -------
    ndarray of complex64, shape (frames, 2, width // 2 + 1), or (frames, 1, …) where the two rows are the same
    """
    frames, height, width = shape
    rows = conjugate_rows(row, height)
    size = (frames, len(rows), width // 2 + 1)
    count = int(np.prod(size))
    words = SFC64(SeedSequence(seed, spawn_key=(row, 1))).random_raw(-(-count // 4)).view(np.uint16)[:count]
    words = words.reshape(size)
    values: Complex = np.take(phase_table(), words, mode="clip")
    for column in {0, width // 2} if width % 2 == 0 else {0}:
        if len(rows) == 2:
            values[0, 1, column] = values[0, 0, column].conj()
            values[1:, 1, column] = values[:0:-1, 0, column].conj()
        else:
            symmetrise(values[:, 0, column])
            if frames % 2 == 0:
                values[frames // 2, 0, column] = 1 if words[frames // 2, 0, column] < STATES // 2 else -1
    values[0] = flat[rows]
    return values

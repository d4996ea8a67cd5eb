"""Random phases and Rayleigh moduli on the half spectrum of a real transform.

The discrete Fourier transform of a real image of height H and width W is kept as `scipy.fft.rfft2` gives it: H rows
(frequency k₁ = 0 … H − 1) and W // 2 + 1 columns (k₂ = 0 … W // 2); the other half follows from ĥ(−k) = conj ĥ(k).
Inside column 0, and for an even W inside column W / 2, both k and −k are present, so symmetry has to be seen to
there.
"""

from functools import cache

import numpy as np
from numpy.random import SFC64, SeedSequence
from numpy.typing import NDArray
from scipy.special import erfcinv

from app.synthesis.arrays import Complex, Real
from app.synthesis.elementary import log, log1p, log10

STATES = 1 << 16  # values that a 16-bit word takes, and so phases that are drawn from
COLUMNS = 32  # width of a block of columns; part of what a seed means, since every block has its own stream


@cache
def phase_table() -> Complex:
    """``exp(iθ)`` for the 65536 equidistant θ = π(1 − 2j / 65536) of ]−π, π]."""
    theta = np.pi * (1 - 2 * np.arange(STATES) / STATES)
    table: Complex = np.exp(1j * theta).astype(np.complex64)
    return table


@cache
def _rayleigh_table() -> Real:
    """Rayleigh moduli: R² = −ln U, averaged over each of the 65536 intervals of U, so that E R² = 1 exactly."""
    square = 1 - log(np.arange(1, STATES + 1) / STATES)
    below = np.arange(1, STATES)
    square[1:] -= below * log1p(1 / below)  # −ln u has a primitive, but its differences would hang on the last bits
    table: Real = np.sqrt(square).astype(np.float32)
    return table


def column_blocks(width: int) -> list[tuple[int, int]]:
    """First and last-plus-one column of every block of the half spectrum of an image of this width.

    Examples
    --------
    >>> column_blocks(100)
    [(0, 32), (32, 51)]
    """
    columns = width // 2 + 1
    return [(first, min(first + COLUMNS, columns)) for first in range(0, columns, COLUMNS)]


def random_block(
    height: int, width: int, block: tuple[int, int], seed: int, rayleigh: bool = False, stream: int = 0
) -> Complex:
    """One block of columns of `random_spectrum`; it depends on no other block, so that any order will do.

    Parameters
    ----------
    height, width : int
        Size of the image in pixels.
    block : tuple of int
        One of `column_blocks`.
    seed : int
        Not negative.
    rayleigh : bool
        As in `random_spectrum`.
    stream : int
        Those of different streams are independent; that of `random_spectrum` is 0.

    Returns
    -------
    ndarray of complex64, shape (height, columns)
    """
    first, last = block
    count = height * (last - first)
    source = SFC64(SeedSequence(seed, spawn_key=(first, stream) if stream else (first,)))
    words = source.random_raw(-(-count // 4)).view(np.uint16)[:count].reshape(height, last - first)
    values = np.take(phase_table(), words, mode="clip")
    if rayleigh:
        drawn = source.random_raw(-(-count // 4)).view(np.uint16)[:count].reshape(height, last - first)
        values *= np.take(_rayleigh_table(), drawn, mode="clip")
    for column in {0, width // 2} if width % 2 == 0 else {0}:
        if first <= column < last:
            symmetrise(values[:, column - first])
            for row in {0, height // 2} if height % 2 == 0 else {0}:
                sign = 1 if words[row, column - first] < STATES // 2 else -1
                # |N| of a real normal N, where all other coefficients are complex normal
                modulus = np.sqrt(2) * erfcinv((float(drawn[row, column - first]) + 0.5) / STATES) if rayleigh else 1
                values[row, column - first] = sign * modulus
    if first == 0:
        values[0, 0] = 1
    return values


def symmetrise(column: Complex) -> None:
    """Make ``column[−k] = conj column[k]`` in place, the lower half following the upper one."""
    half = (len(column) - 1) // 2
    column[len(column) - half :] = column[half:0:-1].conj()


def random_spectrum(height: int, width: int, seed: int, rayleigh: bool = False) -> Complex:
    """``exp(iθ)`` of a uniform random phase θ on the half spectrum, or ``R exp(iθ)`` of a Gaussian white noise.

    θ is odd, uniform on ]−π, π] (on 65536 equidistant values), 0 or π with equal chances where k = −k, and 0 at the
    origin. With ``rayleigh`` the same θ, for the same seed, comes with an independent modulus R that is Rayleigh
    with E R² = 1, and |N(0, 1)| where k = −k: the transform of a white noise of variance 1 / (H W), without its
    mean.

    Parameters
    ----------
    height, width : int
        Size of the image in pixels.
    seed : int
        Not negative.
    rayleigh : bool
        Whether to draw moduli besides.

    Returns
    -------
    ndarray of complex64, shape (height, width // 2 + 1)

    References
    ----------
    Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011: definition 3 (random
    phase), section 4 (the white noise's phase and Rayleigh modulus).

    Examples
    --------
    >>> import numpy as np
    >>> noise = random_spectrum(4, 6, seed=1)
    >>> noise.shape, complex(noise[0, 0]), bool(np.allclose(np.abs(noise), 1))
    ((4, 4), (1+0j), True)
    """
    return np.concatenate(
        [random_block(height, width, block, seed, rayleigh) for block in column_blocks(width)], axis=1
    )


DECADES = 4.0


class LogModulus:
    """The picture of a spectrum: centred, grey, logarithmic.

    Grey 255 is the greatest modulus away from the origin, and 0 is four powers of ten below it or less. The origin,
    which only tells the mean, counts as the greatest.

    Parameters
    ----------
    power : ndarray of float32, shape (H, width // 2 + 1)
        Squared modulus on the half spectrum; for a colour image the mean over the channels.
    width : int
        Of the image.
    """

    def __init__(self, power: Real, width: int) -> None:
        self._power, self._width = power, width
        away = (power[:1, 1:].max(initial=0), power[1:].max(initial=0), np.finfo(np.float32).tiny)
        self._greatest = np.float32(max(away))

    def rows(self, first: int, last: int) -> NDArray[np.uint8]:
        """Rows ``first`` to ``last`` − 1, shape (last − first, width)."""
        power, width, greatest = self._power, self._width, self._greatest
        height = len(power)
        k = (np.arange(first, last) - height // 2) % height
        right, left = power[k, : (width + 1) // 2], power[-k % height, width // 2 : 0 : -1]
        whole = np.minimum(np.concatenate([left, right], axis=1), greatest) / greatest
        if first <= height // 2 < last:
            whole[height // 2 - first, width // 2] = 1
        decades = log10(np.maximum(whole, np.float32(10 ** (-2 * DECADES)))) / 2
        grey: NDArray[np.uint8] = (255.5 + 255 / DECADES * decades).clip(0, 255).astype(np.uint8)
        return grey

"""Half spectrum of a real image: its blocks, its symmetry, random numbers for it, and its picture.

The discrete Fourier transform of a real image of height H and width W is kept as `scipy.fft.rfft2` gives it: H rows
(frequency k₁ = 0 … H − 1) and W // 2 + 1 columns (k₂ = 0 … W // 2); the other half follows from ĥ(−k) = conj ĥ(k).
Column 0, and for an even W column W / 2, hold both k and −k, so that random numbers must be made symmetric there.
"""

from collections.abc import Callable

import numpy as np
from numpy.random import SFC64, SeedSequence
from numpy.typing import NDArray

from ..arrays import Bytes, Complex, Real
from ..elementary import log10

STATES = 1 << 16  # values of a 16-bit word, and so the number of different phases
COLUMNS = 32  # width of a block of columns; part of what a seed means, since every block has its own stream

Block = tuple[int, int]
"""First and last-plus-one column of a block of the half spectrum."""

Draw = Callable[[int, int, Block, SFC64], Complex]
"""A law of random spectra: called with the image's height and width, a block and its random bits, it returns the
coefficients of that block, shape (height, columns), 1 at the origin."""


def column_blocks(width: int) -> list[Block]:
    """Cut the half spectrum of an image of this width into blocks: first and last-plus-one column of each.

    Examples
    --------
    >>> column_blocks(100)
    [(0, 32), (32, 51)]
    """
    columns = width // 2 + 1
    return [(first, min(first + COLUMNS, columns)) for first in range(0, columns, COLUMNS)]


def random_bits(seed: int, block: Block, stream: int = 0) -> SFC64:
    """Make the source of one block's random bits, which depends on no other block: blocks can be drawn in any order.

    Parameters
    ----------
    seed : int
        Not negative.
    block : tuple of int
        One of `column_blocks`.
    stream : int
        Those of different streams are independent; that of RPN and ADSN is 0.

    Returns
    -------
    SFC64
    """
    first = block[0]
    return SFC64(SeedSequence(seed, spawn_key=(first, stream) if stream else (first,)))


def random_words(source: SFC64, height: int, block: Block) -> NDArray[np.uint16]:
    """Draw the next 16 random bits for every coefficient of a block.

    Parameters
    ----------
    source : SFC64
        One of `random_bits`; it moves on.
    height : int
        Height of the image, in pixels.
    block : tuple of int

    Returns
    -------
    ndarray of uint16, shape (height, columns)
    """
    columns = block[1] - block[0]
    count = height * columns
    return source.random_raw(-(-count // 4)).view(np.uint16)[:count].reshape(height, columns)


def symmetric_columns(width: int, block: Block) -> list[int]:
    """Find the columns of a block that hold both k and −k, counted from the block's first.

    Examples
    --------
    >>> symmetric_columns(100, (0, 32)), symmetric_columns(100, (32, 51)), symmetric_columns(101, (32, 51))
    ([0], [18], [])
    """
    first, last = block
    return [column - first for column in sorted({0, width // 2 if width % 2 == 0 else 0}) if first <= column < last]


def real_rows(height: int) -> list[int]:
    """Find the rows of a symmetric column in which −k = k, so that the coefficient is real.

    Examples
    --------
    >>> real_rows(6), real_rows(7)
    ([0, 3], [0])
    """
    return sorted({0, height // 2 if height % 2 == 0 else 0})


def symmetrise(column: Complex | Real) -> None:
    """Make ``column[−k] = conj column[k]`` in place, the lower half following the upper one."""
    half = (len(column) - 1) // 2
    column[len(column) - half :] = column[half:0:-1].conj()


def half_spectrum(draw: Draw, height: int, width: int, seed: int) -> Complex:
    """Draw the whole half spectrum of an image.

    Parameters
    ----------
    draw : callable
        `microtexture.gaussian.rpn.random_phase` or `microtexture.gaussian.adsn.white_noise`.
    height, width : int
        Size of the image in pixels.
    seed : int
        Not negative.

    Returns
    -------
    ndarray of complex64, shape (height, width // 2 + 1)
    """
    blocks = column_blocks(width)
    return np.concatenate([draw(height, width, block, random_bits(seed, block)) for block in blocks], axis=1)


DECADES = 4.0


class LogModulus:
    """Picture of a spectrum: centred, grey, logarithmic.

    Grey 255 is the greatest modulus away from the origin, and 0 is four powers of ten below it or less. The origin,
    which holds nothing but the mean, is white.

    Parameters
    ----------
    power : ndarray of float32, shape (H, width // 2 + 1)
        Squared modulus on the half spectrum; for a colour image the mean over the channels.
    width : int
        Width of the image, in pixels.
    """

    def __init__(self, power: Real, width: int) -> None:
        self._power, self._width = power, width
        away = (power[:1, 1:].max(initial=0), power[1:].max(initial=0), np.finfo(np.float32).tiny)
        self._greatest = np.float32(max(away))

    def rows(self, first: int, last: int) -> Bytes:
        """Compute rows ``first`` to ``last`` − 1 of the picture, shape (last − first, width)."""
        power, width, greatest = self._power, self._width, self._greatest
        height = len(power)
        k = (np.arange(first, last) - height // 2) % height
        right, left = power[k, : (width + 1) // 2], power[-k % height, width // 2 : 0 : -1]
        whole = np.minimum(np.concatenate([left, right], axis=1), greatest) / greatest
        if first <= height // 2 < last:
            whole[height // 2 - first, width // 2] = 1
        decades = log10(np.maximum(whole, np.float32(10 ** (-2 * DECADES)))) / 2
        grey: Bytes = (255.5 + 255 / DECADES * decades).clip(0, 255).astype(np.uint8)
        return grey

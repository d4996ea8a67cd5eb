"""ADSN, asymptotic discrete spot noise: the Gaussian texture whose covariance is the sample's autocorrelation.

    Z = m + (M N)^(−1/2) (h − m) ∗ Y,   Y a Gaussian white noise, the same for every channel.

In the Fourier domain that is RPN times a Rayleigh noise R of E R² = 1: Ẑ(ξ) = ĥ(ξ) R(ξ) exp(iθ(ξ)), and with the
same seed θ is the RPN's. The mean is kept: the coefficient at the origin is not randomised.

`white_noise` draws R exp(iθ). `adsn` returns a texture as one array; `adsn_field` is the same for a texture that is
handed on row by row, and is what the service runs.

References
----------
Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011: definition 1, theorem 2,
section 4.
"""

from functools import cache
from typing import Unpack

import numpy as np
from numpy.random import SFC64
from scipy.special import erfcinv

from ..arrays import Complex, Progress, Real
from ..elementary import log, log1p
from ..fourier.field import Noise, NoiseField, NoiseOptions
from ..fourier.spectral import (
    STATES,
    Block,
    half_spectrum,
    random_words,
    real_rows,
    symmetric_columns,
    symmetrise,
)
from ..fourier.spot import Spot
from ..fourier.spot_noise import convolve
from ..parallel import Team
from .rpn import random_phase


@cache
def _rayleigh_table() -> Real:
    """Rayleigh moduli: R² = −ln U, averaged over each of the 65536 intervals of U, so that E R² = 1 exactly."""
    square = 1 - log(np.arange(1, STATES + 1) / STATES)
    below = np.arange(1, STATES)
    square[1:] -= below * log1p(1 / below)  # −ln u has a primitive, but its differences would hang on the last bits
    table: Real = np.sqrt(square).astype(np.float32)
    return table


def white_noise(height: int, width: int, block: Block, source: SFC64) -> Complex:
    """Draw ``R exp(iθ)`` of a Gaussian white noise on one block of columns of the half spectrum (section 4).

    θ is that of `microtexture.gaussian.rpn.random_phase` from the same bits; R is independent of it, Rayleigh with
    E R² = 1, and |N(0, 1)| where k = −k. It is the transform of a white noise of variance 1 / (H W), without its mean.

    Parameters
    ----------
    height, width, block
        Those of `random_phase`.
    source : SFC64
        Random bits, 32 for each coefficient.

    Returns
    -------
    ndarray of complex64, shape (height, columns of the block)
    """
    noise = random_phase(height, width, block, source)
    words = random_words(source, height, block)
    modulus = np.take(_rayleigh_table(), words, mode="clip")
    for column in symmetric_columns(width, block):
        symmetrise(modulus[:, column])
        for row in real_rows(height):
            # |N| of a real normal N, where all other coefficients are complex normal
            modulus[row, column] = np.sqrt(2) * erfcinv((float(words[row, column]) + 0.5) / STATES)
    if block[0] == 0:
        modulus[0, 0] = 1
    noise *= modulus
    return noise


def adsn(
    h: Real,
    height: int | None = None,
    width: int | None = None,
    *,
    threads: int = 1,
    progress: Progress | None = None,
    **options: Unpack[NoiseOptions],
) -> Real:
    """Synthesize the ADSN of the periodic component of an image, of any size.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
        The sample; any number of channels, any range, finite.
    height, width : int, optional
        Size of the texture in pixels; default: the sample's.
    threads, progress, **options
        Those of `microtexture.gaussian.rpn.rpn`: ``seed``, ``phase``, ``alpha``, ``window``, ``periodic`` and
        ``add_smooth``, with the same meaning and the same defaults.

    Returns
    -------
    ndarray of float32, shape (height, width) or (height, width, C)
        Periodic; values may lie outside the sample's range.

    Raises
    ------
    ValueError
        If values are not finite, or ``add_smooth`` is true with another size or without ``periodic``.

    Examples
    --------
    >>> h = np.random.default_rng(0).random((16, 20, 3), np.float32)
    >>> z = adsn(h, 32, 50, seed=7)
    >>> z.shape, bool(np.allclose(z.mean((0, 1)), h.mean((0, 1))))
    ((32, 50, 3), True)
    """
    with Team(threads) as team:
        return adsn_field(h, height, width, team=team, progress=progress, **options).array()


def adsn_field(
    h: Real,
    height: int | None = None,
    width: int | None = None,
    *,
    team: Team,
    progress: Progress | None = None,
    **options: Unpack[NoiseOptions],
) -> NoiseField:
    """Prepare the ADSN of an image, whose rows are then handed to a sink.

    Parameters
    ----------
    h, height, width, progress, **options
        Those of `adsn`.
    team : Team
        The threads that work.

    Returns
    -------
    NoiseField
        ``adsn_field(…).array()`` is `adsn`.

    Raises
    ------
    ValueError
        As `adsn`.
    """
    return NoiseField(h, Noise(white_noise, height or h.shape[0], width or h.shape[1], **options), team, progress)


def adsn_of_spot(spot: Spot, seed: int, threads: int = 1, progress: Progress | None = None) -> Real:
    """Synthesize the ADSN of any spot, as it is, with the white noise of `adsn` at this seed.

    Parameters
    ----------
    spot : Spot
        A spot of the texture's size.
    seed : int
        Not negative.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between channels; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (spot.height, spot.width, C)
    """
    return convolve([spot], [half_spectrum(white_noise, spot.height, spot.width, seed)], threads, progress)

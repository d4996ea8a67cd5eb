"""RPN, random phase noise: the sample's Fourier modulus with a random phase.

    Ẑ(ξ) = ĥ(ξ) exp(iθ(ξ)),   θ odd, uniform on ]−π, π], θ(0) = 0,

the same θ for every channel, which keeps the phase displacements between channels and so makes no false colours.

`random_phase` draws exp(iθ); all other models that share RPN's phase take it from there. `rpn` returns a texture as one
array; `rpn_field` is the same for a texture that is handed on row by row, and is what the service runs.

References
----------
Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011: definitions 3 and 4, sections
5.1–5.3; "Micro-Texture Synthesis by Phase Randomization", IPOL 2011.
"""

from functools import cache
from typing import Literal, Unpack

import numpy as np
from numpy.random import SFC64

from ..arrays import Complex, Progress, Real
from ..fourier.field import Noise, NoiseField, NoiseOptions
from ..fourier.spectral import (
    STATES,
    Block,
    random_words,
    real_rows,
    symmetric_columns,
    symmetrise,
)
from ..fourier.spot import Profile
from ..parallel import Team


@cache
def phase_table() -> Complex:
    """``exp(iθ)`` for the 65536 equidistant θ = π(1 − 2j / 65536) of ]−π, π]."""
    theta = np.pi * (1 - 2 * np.arange(STATES) / STATES)
    table: Complex = np.exp(1j * theta).astype(np.complex64)
    return table


def random_phase(height: int, width: int, block: Block, source: SFC64) -> Complex:
    """Draw ``exp(iθ)`` of a uniform random phase θ on one block of columns of the half spectrum (definition 3).

    θ is odd, uniform on ]−π, π] (on 65536 equidistant values), 0 or π with equal chances where k = −k, and 0 at the
    origin.

    Parameters
    ----------
    height, width : int
        Size of the image in pixels.
    block : tuple of int
        One of `microtexture.fourier.spectral.column_blocks`.
    source : SFC64
        Random bits, 16 for each coefficient.

    Returns
    -------
    ndarray of complex64, shape (height, columns of the block)

    Examples
    --------
    >>> from microtexture.fourier.spectral import random_bits
    >>> phase = random_phase(4, 6, (0, 4), random_bits(1, (0, 4)))
    >>> phase.shape, complex(phase[0, 0]), bool(np.allclose(np.abs(phase), 1))
    ((4, 4), (1+0j), True)
    """
    words = random_words(source, height, block)
    phase: Complex = np.take(phase_table(), words, mode="clip")
    for column in symmetric_columns(width, block):
        symmetrise(phase[:, column])
        for row in real_rows(height):
            phase[row, column] = 1 if words[row, column] < STATES // 2 else -1
    if block[0] == 0:
        phase[0, 0] = 1
    return phase


def rpn(
    h: Real,
    height: int | None = None,
    width: int | None = None,
    *,
    seed: int = 0,
    phase: Literal["add", "replace"] = "add",
    alpha: float = 0.1,
    window: Profile = "bump",
    periodic: bool = True,
    add_smooth: bool = False,
    threads: int = 1,
    progress: Progress | None = None,
) -> Real:
    """Synthesize the RPN of the periodic component of an image, of any size.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
        The sample; any number of channels, any range, finite.
    height, width : int, optional
        Size of the texture in pixels; default: the sample's. Along a longer axis the spot is extended (see
        `microtexture.fourier.spot`), along a shorter one the sample's centre is taken.
    seed : int
        Not negative; the result depends on nothing else.
    phase : {"add", "replace"}
        Add the random phase to every channel's own, or replace them all by it: the literature's "wrong RPN", which
        makes false colours.
    alpha : float
        Width of the spot's transition as a part of the sample's side, 0–0.5; see `microtexture.fourier.spot.window`.
    window : {"bump", "gaussian"}
        Profile of the transition: of the IPOL article, or of the TIP article.
    periodic : bool
        Without, the sample itself takes the place of its periodic component: the jumps between its opposite borders
        make a cross of streaks.
    add_smooth : bool
        Add the smooth component back; for a texture of the sample's own size only, and with ``periodic``.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between blocks; what it raises stops the work.

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
    >>> z = rpn(h, 32, 50, seed=7)
    >>> z.shape, bool(np.allclose(z.mean((0, 1)), h.mean((0, 1))))
    ((32, 50, 3), True)
    """
    with Team(threads) as team:
        return rpn_field(
            h,
            height,
            width,
            team=team,
            progress=progress,
            seed=seed,
            phase=phase,
            alpha=alpha,
            window=window,
            periodic=periodic,
            add_smooth=add_smooth,
        ).array()


def rpn_field(
    h: Real,
    height: int | None = None,
    width: int | None = None,
    *,
    team: Team,
    progress: Progress | None = None,
    **options: Unpack[NoiseOptions],
) -> NoiseField:
    """Prepare the RPN of an image, whose rows are then handed to a sink.

    Parameters
    ----------
    h, height, width, progress, **options
        Those of `rpn`.
    team : Team
        The threads that work.

    Returns
    -------
    NoiseField
        ``rpn_field(…).array()`` is `rpn`.

    Raises
    ------
    ValueError
        As `rpn`.
    """
    return NoiseField(h, Noise(random_phase, height or h.shape[0], width or h.shape[1], **options), team, progress)

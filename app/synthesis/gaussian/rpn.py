"""RPN, random phase noise: the sample's Fourier modulus with a random phase.

    Ẑ(ξ) = ĥ(ξ) exp(iθ(ξ)),   θ odd, uniform on ]−π, π], θ(0) = 0,

the same θ for every channel, which keeps the phase displacements between channels and so makes no false colours.

References
----------
Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011: definition 4, sections
5.1–5.3; "Micro-Texture Synthesis by Phase Randomization", IPOL 2011.
"""

from typing import Literal

from app.synthesis.arrays import Progress, Real
from app.synthesis.fourier.field import Noise, synthesize
from app.synthesis.fourier.spot import Profile


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
    """RPN of the periodic component of an image, of any size.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
        The sample; any number of channels, any range, finite.
    height, width : int, optional
        Size of the texture; default: the sample's. Along a longer axis the spot is extended (see
        `app.synthesis.fourier.spot`), along a shorter one the sample's centre is taken.
    seed : int
        Not negative; the result depends on nothing else.
    phase : {"add", "replace"}
        "replace" gives every channel's modulus one common phase: the literature's "wrong RPN", which makes false
        colours.
    alpha, window
        The spot's transition, see `app.synthesis.fourier.spot.window`.
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
        If values are not finite, or ``add_smooth`` is asked for with another size or without ``periodic``.

    Examples
    --------
    >>> import numpy as np
    >>> h = np.random.default_rng(0).random((16, 20, 3), np.float32)
    >>> z = rpn(h, 32, 50, seed=7)
    >>> z.shape, bool(np.allclose(z.mean((0, 1)), h.mean((0, 1))))
    ((32, 50, 3), True)
    """
    noise = Noise(
        height or h.shape[0],
        width or h.shape[1],
        seed=seed,
        rayleigh=False,
        phase=phase,
        alpha=alpha,
        window=window,
        periodic=periodic,
        add_smooth=add_smooth,
    )
    return synthesize(h, noise, threads, progress)

"""ADSN, asymptotic discrete spot noise: the Gaussian texture whose covariance is the sample's autocorrelation.

    Z = m + (M N)^(−1/2) (h − m) ∗ Y,   Y a Gaussian white noise, the same for every channel.

In the Fourier domain that is RPN times a Rayleigh noise R of E R² = 1: Ẑ(ξ) = ĥ(ξ) R(ξ) exp(iθ(ξ)), and with the
same seed θ is the RPN's. The mean is kept: the coefficient at the origin is not randomised.

References
----------
Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011: definition 1, theorem 2,
section 4.
"""

from typing import Literal

from app.synthesis.arrays import Progress, Real
from app.synthesis.fourier.field import Noise, synthesize
from app.synthesis.fourier.spot import Profile


def adsn(
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
    """ADSN of the periodic component of an image, of any size.

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
    >>> z = adsn(h, 32, 50, seed=7)
    >>> z.shape, bool(np.allclose(z.mean((0, 1)), h.mean((0, 1))))
    ((32, 50, 3), True)
    """
    noise = Noise(
        height or h.shape[0],
        width or h.shape[1],
        seed=seed,
        rayleigh=True,
        phase=phase,
        alpha=alpha,
        window=window,
        periodic=periodic,
        add_smooth=add_smooth,
    )
    return synthesize(h, noise, threads, progress)

"""Spot extension: the sample pasted into a larger image so that its noise keeps mean, variance and look.

    h̃ = m + g · φ_α · (p − m)

on a centred rectangle of the sample's size, and m elsewhere. The articles' factor, g = sqrt(M₂N₂ / (M₁N₁)) for a φ_α of
mean square 1, keeps the variance on average over all places of the window; on one crop it is off by a twentieth at the
usual α and by a quarter at α = 0.5, more where the crop is coarse. Here g is what makes the variance of the noise that
of p, the mean over the channels, exactly:

    g² = (1/M₁N₁) Σ_c Σ (p_c − m_c)² / Σ_c [(1/M₂N₂) Σ u_c² − ((1/M₂N₂) Σ u_c)²],   u = φ_α (p − m).

It is one number for all channels: how they compare under the window is left as the crop has it there.

References
----------
Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011, equation 4 and figure 9 (the
Gaussian profile); Galerne, Gousseau, Morel, "Micro-Texture Synthesis by Phase Randomization", IPOL 2011, "Spot
Extension Technique".
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from ..arrays import Double, Real
from ..elementary import exp

Profile = Literal["bump", "gaussian"]


@lru_cache(maxsize=64)
def window(n: int, alpha: float, profile: Profile = "bump") -> Double:
    """Sample the smooth transition φ_α at the n points t = (i + ½) / n, mean square 1.

    φ_α rises on [0, α], is constant on [α, 1 − α] and falls as it rose. On [0, α] it is

    - ``bump``: proportional to the primitive of ``exp(−1 / (1 − (2t/α − 1)²))`` (IPOL article);
    - ``gaussian``: proportional to ``exp(−(α − t)² / (2σ²))`` with σ = α/4 (TIP article, figure 9).

    Parameters
    ----------
    n : int
        Points, at least 1.
    alpha : float
        0 (no transition at all) to 0.5.
    profile : {"bump", "gaussian"}
        The IPOL article's or the TIP article's.

    Returns
    -------
    ndarray of float64, shape (n,)
        Read-only.

    Examples
    --------
    >>> import numpy as np
    >>> phi = window(256, 0.1)
    >>> bool(np.isclose((phi**2).mean(), 1)), bool((phi[26:-26] == phi[128]).all())
    (True, True)
    """
    t = (np.arange(n) + 0.5) / n
    t = np.minimum(t, t[::-1])
    if alpha == 0:
        phi = np.ones(n)
    elif profile == "bump":
        u = np.linspace(-1, 1, 4097)
        bump = exp(-1 / np.maximum(1 - u**2, 1e-3))
        bump[[0, -1]] = 0
        primitive = np.concatenate([[0], np.cumsum(bump[1:] + bump[:-1])])
        phi = np.interp(2 * t / alpha - 1, u, primitive / primitive[-1])
    else:
        phi = exp(-8 * np.maximum(1 - t / alpha, 0) ** 2)
    phi /= np.sqrt((phi**2).mean())
    phi.flags.writeable = False
    return phi


def centre(h: Real, height: int, width: int) -> Real:
    """Cut an image to its centre.

    Parameters
    ----------
    h : ndarray, shape (H, W) or (H, W, C)
    height, width : int
        Most pixels of each side that are kept.

    Returns
    -------
    ndarray
        A view, of at most ``height`` × ``width`` pixels.
    """
    top, left = max(0, (h.shape[0] - height) // 2), max(0, (h.shape[1] - width) // 2)
    return h[top : top + height, left : left + width]


@dataclass(frozen=True)
class Spot:
    """An extended spot as planes, without the constant around its rectangle.

    ``planes`` (C, M₁, N₁) is h̃ − m on the rectangle whose first pixel is (``top``, ``left``) of an image of
    ``height`` × ``width`` pixels; ``mean`` is m, shape (C,).
    """

    planes: Real
    mean: Double
    height: int
    width: int

    @property
    def top(self) -> int:
        """First row of the rectangle."""
        return (self.height - int(self.planes.shape[1])) // 2

    @property
    def left(self) -> int:
        """First column of the rectangle."""
        return (self.width - int(self.planes.shape[2])) // 2

    def rows(self, first: int, last: int) -> Real:
        """Compute rows ``first`` to ``last`` − 1 of h̃, shape (C, last − first, width)."""
        channels, high, wide = self.planes.shape
        rows = np.empty((channels, last - first, self.width), np.float32)
        rows[:] = self.mean[:, None, None]
        begin, end = max(first, self.top), min(last, self.top + high)
        if begin < end:
            part = rows[:, begin - first : end - first, self.left : self.left + wide]
            part += self.planes[:, begin - self.top : end - self.top]
        return rows


def variances(planes: Real, area: int) -> Double:
    """Compute the variances, shape (C,), of planes (C, M, N) with zeros around them, up to ``area`` pixels in all."""
    # A row is short enough for single precision; all of them are not.
    squares = np.einsum("cyx,cyx->cy", planes, planes).sum(axis=1, dtype=np.float64)
    sums = planes.sum(axis=2).sum(axis=1, dtype=np.float64)
    found: Double = squares / area - (sums / area) ** 2
    return found


def make_spot(p: Real, mean: Double, height: int, width: int, alpha: float, profile: Profile) -> Spot:
    """Extend a spot as `extend_spot` does, in place and without the constant around its rectangle.

    Parameters
    ----------
    p : ndarray of float32, shape (C, M₁, N₁)
        Planes of the periodic component; overwritten by the spot's.
    mean, height, width, alpha, profile
        Those of `extend_spot`.

    Returns
    -------
    Spot
    """
    high, wide = p.shape[1:]
    p -= mean.astype(np.float32)[:, None, None]
    if (high, wide) != (height, width):
        variance = variances(p, high * wide).sum()
        fade(p, height, width, alpha, profile)
        left = variances(p, height * width).sum()
        p *= np.float32(np.sqrt(variance / left) if left > 0 else 1)
    return Spot(p, mean, height, width)


def fade(p: Real, height: int, width: int, alpha: float, profile: Profile) -> None:
    """Multiply planes by φ_α along every axis that is extended, in place.

    Parameters
    ----------
    p : ndarray of float32, shape (C, M₁, N₁)
    height, width : int
        Size of the extended image, in pixels.
    alpha, profile
        Those of `window`.
    """
    high, wide = p.shape[1:]
    if height > high:
        p *= window(high, alpha, profile).astype(np.float32)[:, None]
    if width > wide:
        p *= window(wide, alpha, profile).astype(np.float32)


def extend_spot(p: Real, mean: Double, height: int, width: int, alpha: float = 0.1, profile: Profile = "bump") -> Real:
    """Extend a periodic component to the spot h̃ of a larger noise.

    An axis that is not extended is not attenuated, and without an extension h̃ is p. The variance of h̃, the mean over
    the channels, is that of p; that of a single channel is so as far as p is homogeneous.

    Parameters
    ----------
    p : ndarray of float32, shape (M₁, N₁, C)
        Periodic component; no axis longer than the output's. (A sample that is larger than the output along an axis
        is replaced by its centre *before* its periodic component is taken, see `centre`: mean and variance are then
        those of the centre.)
    mean : ndarray of float64, shape (C,)
        Mean of every channel.
    height, width : int
        Size M₂ × N₂ of the output.
    alpha, profile
        As in `window`.

    Returns
    -------
    ndarray of float32, shape (height, width, C)
    """
    planes = p.transpose(2, 0, 1).copy()
    return make_spot(planes, mean, height, width, alpha, profile).rows(0, height).transpose(1, 2, 0)

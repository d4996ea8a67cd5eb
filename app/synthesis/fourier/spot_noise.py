"""Spot noise: a spot convolved, on the torus, with a white noise that all channels share.

    Z = m + (h̃ − m̃) ∗ W,   Ẑ(k) = ĥ(k) Ŵ(k) for k ≠ 0,   E|Ŵ(k)|² = 1,

so that the covariance of Z is the autocorrelation of the spot. W is a Gaussian white noise for the asymptotic
discrete spot noise, a normalised count of random points for the discrete one. The coefficient at the origin is the
spot's mean alone.

References
----------
Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011: section 2.
"""

from collections.abc import Sequence

import numpy as np
import scipy.fft

from ..arrays import Complex, Progress, Real
from .periodic import periodic_planes
from .spot import Profile, Spot, centre, make_spot


def sample_spot(
    h: Real, height: int, width: int, alpha: float = 0.1, window: Profile = "bump", threads: int = 1
) -> Spot:
    """Make the spot of RPN and ADSN: the periodic component of a sample, extended to the texture's size.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
        Along an axis that is longer than the texture's, its centre is taken.
    height, width : int
        Size of the texture.
    alpha, window
        See `microtexture.fourier.spot.window`.
    threads : int
        For the transform.

    Returns
    -------
    Spot
    """
    p = periodic_planes(centre(h, height, width), threads)
    return make_spot(p, p.mean(axis=(1, 2), dtype=np.float64), height, width, alpha, window)


def transform(plane: Real, spot: Spot, threads: int = 1) -> Complex:
    """Transform a plane that lies on a spot's rectangle, with zeros around it.

    Parameters
    ----------
    plane : ndarray of float32, shape (M₁, N₁)
    spot : Spot
        Gives the place of the rectangle and the size of the image.
    threads : int
        For the transform.

    Returns
    -------
    ndarray of complex64, shape (spot.height, spot.width // 2 + 1)
    """
    if plane.shape != (spot.height, spot.width):
        whole = np.zeros((spot.height, spot.width), np.float32)
        whole[spot.top : spot.top + plane.shape[0], spot.left : spot.left + plane.shape[1]] = plane
        plane = whole
    spectrum: Complex = scipy.fft.rfft2(plane, workers=threads)
    return spectrum


def convolve(
    spots: Sequence[Spot],
    noises: Sequence[Complex],
    threads: int = 1,
    progress: Progress | None = None,
) -> Real:
    """Convolve spots with white noises and add up the results: the noise of several spots that share their mean.

    Parameters
    ----------
    spots : sequence of Spot
        All of one size and with the same mean, which the sum has once.
    noises : sequence of ndarray of complex64, shape (height, width // 2 + 1)
        Ŵ on the half spectrum, one for each spot; the value at the origin is ignored.
    threads : int
        For the transforms; the result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between transforms; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (height, width, C)
    """
    first = spots[0]
    texture = np.empty((len(first.planes), first.height, first.width), np.float32)
    for channel, mean in enumerate(first.mean):
        total: Complex | None = None
        for number, (spot, noise) in enumerate(zip(spots, noises, strict=True)):
            if progress:
                progress("texture", (channel + number / (len(spots) + 1)) / len(texture))
            spectrum = transform(spot.planes[channel], spot, threads)
            spectrum *= noise
            total = spectrum if total is None else np.add(total, spectrum, out=total)
        assert total is not None
        total[0, 0] = 0
        if progress:
            progress("texture", (channel + len(spots) / (len(spots) + 1)) / len(texture))
        noise_plane = scipy.fft.irfft2(total, s=texture.shape[1:], overwrite_x=True, workers=threads)
        np.add(noise_plane, np.float32(mean), out=texture[channel])
    if progress:
        progress("texture", 1.0)
    return texture.transpose(1, 2, 0)

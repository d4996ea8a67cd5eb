"""Texton: the shortest writing of a Gaussian texture, a spot with the sample's Fourier modulus and no phase.

    t̂_c(k) = p̂_c(k) conj(ℓ̂(k)) / |ℓ̂(k)|,   t̂(0) = 0,

where p is the sample's periodic component and ℓ its luminance. For a grey sample that is |p̂|; for a colour one the
luminance's phase is taken off every channel, so that the channels keep their displacements against each other.
Spots that differ by a phase common to all channels have the same autocorrelation, so the texton's noise is the
sample's; but its energy gathers around its origin, so it can be pasted into a larger image without a window:

    t̃ = m + r (t − m) 1_Ω,

with Ω the sample's domain, or a square of K × K pixels around the texton's origin.

References
----------
Desolneux, Moisan, Ronsin, "A Compact Representation of Random Phase and Gaussian Textures", ICASSP 2012; Galerne,
"Image texture synthesis using spot noise and phase randomization" (lecture, 2017), section 7.
"""

from collections.abc import Sequence

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from app.synthesis.field import Progress
from app.synthesis.luminance import luminance
from app.synthesis.periodic import periodic_planes
from app.synthesis.spectral import random_spectrum
from app.synthesis.spot import Spot
from app.synthesis.spot_noise import Complex, convolve, sample_spot, transform

Real = NDArray[np.float32]


def _sign(spectrum: Complex) -> Complex:
    """``z / |z|``, and 1 where z is 0."""
    modulus = np.abs(spectrum)
    nothing = modulus == 0
    modulus[nothing] = 1
    sign = np.divide(spectrum, modulus, out=spectrum.copy())
    sign[nothing] = 1
    return sign


def texton(h: Real, threads: int = 1, progress: Progress | None = None) -> Real:
    """Texton of the periodic component of an image, without its mean.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
    threads : int
        For the transforms.
    progress : callable ``(stage, part)``, optional
        Called between channels; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (H, W, C)
        Its origin is the pixel (H // 2, W // 2).

    Examples
    --------
    >>> import numpy as np
    >>> t = texton(np.random.default_rng(0).random((16, 21, 1), np.float32))
    >>> [int(i) for i in np.unravel_index(t.argmax(), t.shape)], bool(abs(t.mean()) < 1e-6)
    ([8, 10, 0], True)
    """
    p = periodic_planes(h, threads)
    p -= p.mean(axis=(1, 2), dtype=np.float64, keepdims=True).astype(np.float32)
    turn = _sign(scipy.fft.rfft2(luminance(p.transpose(1, 2, 0)), workers=threads)).conj()
    for channel, plane in enumerate(p):
        if progress:
            progress("texton", (1 + channel) / (1 + len(p)))
        spectrum = scipy.fft.rfft2(plane, workers=threads)
        spectrum *= turn
        spectrum[0, 0] = 0
        plane[:] = np.fft.fftshift(scipy.fft.irfft2(spectrum, s=plane.shape, overwrite_x=True, workers=threads))
    return p.transpose(1, 2, 0)


def radii(t: Real, parts: Sequence[float]) -> list[float]:
    """Radii of the smallest discs around the texton's origin that hold these parts of its energy.

    Parameters
    ----------
    t : ndarray of float32, shape (H, W, C)
        A texton; the energy is Σ t² over pixels and channels.
    parts : sequence of float
        Each in ]0, 1].

    Returns
    -------
    list of float
        Pixels, from the origin to the furthest pixel inside; 0 for a texton without energy.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.zeros((9, 9, 1), np.float32)
    >>> t[4, 4], t[4, 5], t[0, 4] = 2, 1, 1
    >>> radii(t, [0.5, 0.8, 0.99])
    [0.0, 1.0, 4.0]
    """
    height, width = t.shape[:2]
    y, x = np.ogrid[:height, :width]
    square = (y - height // 2) ** 2 + (x - width // 2) ** 2
    energy = np.einsum("yxc,yxc->yx", t, t, dtype=np.float64)
    within = np.cumsum(np.bincount(square.ravel(), weights=energy.ravel()))
    return [float(np.sqrt(np.searchsorted(within, part * within[-1] * (1 - 1e-9)))) for part in parts]


def extend_texton(
    t: Real, mean: NDArray[np.float64], height: int, width: int, cut: int | None = None
) -> tuple[Spot, NDArray[np.float64]]:
    """Extended texton t̃ = m + r (t − m) 1_Ω.

    Its noise has the variance (1/M₂N₂) Σ (t̃ − mean t̃)², the sum over an image of M₂ × N₂ pixels, and is to have that
    of the sample, (1/M₁N₁) Σ (t − m)². With u the part of t − m that is kept, that asks for

        r² = (1/M₁N₁) Σ (t − m)² · M₂N₂ / (Σ u² − (Σ u)² / M₂N₂).

    Uncut, Σ u = 0 and r is the square root of the ratio of the areas, the factor of the spot extension; cut, r also
    makes up for the energy that is lost. It is found for every channel, so that the colours stay.

    Parameters
    ----------
    t : ndarray of float32, shape (M₁, N₁, C)
        `texton`; no axis longer than the output's.
    mean : ndarray of float64, shape (C,)
        The sample's.
    height, width : int
        Size M₂ × N₂ of the output.
    cut : int, optional
        K: keep the K × K pixels around the origin only.

    Returns
    -------
    spot : Spot
    r : ndarray of float64, shape (C,)
        1 for a channel without contrast.
    """
    rows, columns = (_around(side, cut) for side in t.shape[:2])
    kept = t[rows, columns].transpose(2, 0, 1).copy()
    area = height * width
    total = np.einsum("yxc,yxc->c", t, t, dtype=np.float64) / (t.shape[0] * t.shape[1])
    left = np.einsum("cyx,cyx->c", kept, kept, dtype=np.float64)
    left -= kept.sum(axis=(1, 2), dtype=np.float64) ** 2 / area
    flat = (total == 0) | (left <= 0)
    r = np.where(flat, 1.0, np.sqrt(total * area / np.where(flat, 1.0, left)))
    kept *= r.astype(np.float32)[:, None, None]
    return Spot(kept, mean, height, width), r


def _around(side: int, cut: int | None) -> slice:
    """The ``cut`` pixels around pixel ``side // 2`` of a line."""
    if cut is None or cut >= side:
        return slice(0, side)
    first = side // 2 - cut // 2
    return slice(first, first + cut)


def texton_noise(h: Real, spot: Spot, *, seed: int = 0, threads: int = 1, progress: Progress | None = None) -> Real:
    """ADSN of a sample's extended texton, at the phase of the sample's own ADSN.

    At every frequency the random phase is turned by the difference between the phases, in luminance, of the sample's
    extended spot and of the extended texton. A uniform random phase turned by a fixed odd one is a uniform random
    phase, so the law is that of the ADSN of the texton; but from one seed the texture has the phase of
    `app.synthesis.adsn` and its Rayleigh noise, and for a whole texton of the texture's size it is the same texture.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
        The sample.
    spot : Spot
        `extend_texton` of the texton of h, or of its centre.
    seed : int
        Not negative.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between transforms with the part of all the work that is done; what it raises stops it.

    Returns
    -------
    ndarray of float32, shape (spot.height, spot.width, C)
    """
    if progress:
        progress("random phase", 0.0)
    noise = random_spectrum(spot.height, spot.width, seed, rayleigh=True)
    if progress:
        progress("random phase", 0.15)
    own = sample_spot(h, spot.height, spot.width, threads=threads)
    turn = transform(luminance(own.planes.transpose(1, 2, 0)), own, threads)
    if progress:
        progress("random phase", 0.3)
    turn *= transform(luminance(spot.planes.transpose(1, 2, 0)), spot, threads).conj()
    del own
    noise *= _sign(turn)
    return convolve(spot, noise, threads, progress, begin=0.45)

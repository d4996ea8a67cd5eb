"""Periodic plus smooth decomposition h = p + s of an image (Moisan), through a Poisson problem.

p is the solution of Δp = Δᵢh with mean p = mean h, where Δf(x) is the sum over the four neighbours y of f(x) −
f(y), taken on the torus, and Δᵢ is the same with the neighbours inside the image only. Their difference v = Δh −
Δᵢh lives on the border: it is the jump between opposite sides. So Δs = v, and in the Fourier domain

    ŝ(k) = v̂(k) / (4 sin²(π k₁/H) + 4 sin²(π k₂/W)),   ŝ(0) = 0,   p̂ = ĥ − ŝ,

which needs one forward transform of h, and, because v is two lines along each axis, only two transforms of *lines*
for v̂:

    v̂(k) = ĵ(k₂) (1 − exp(2πi k₁/H)) + ĵ'(k₁) (1 − exp(2πi k₂/W)),

with j(x) = h(0, x) − h(H − 1, x) and j'(y) = h(y, 0) − h(y, W − 1). Dividing the jumps alone, and not Δᵢh, by the
small denominators of low frequencies keeps single precision accurate there.

References
----------
Moisan, "Periodic plus smooth image decomposition", JMIV 2011; Galerne, Gousseau, Morel, "Random Phase Textures:
Theory and Synthesis", IEEE TIP 2011, equation 3.
"""

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
import scipy.fft

from ..arrays import Complex, Real

PRODUCT = 1 << 16  # values of a matrix product of inner dimension 4, few enough for BLAS to stay in the calling thread


@lru_cache(maxsize=32)
def _axis(length: int, count: int) -> tuple[Complex, Real]:
    """``1 − exp(2πi k/length)`` and ``4 sin²(π k/length)`` for k = 0 … count − 1."""
    k = np.arange(count)
    turns = 1 - np.exp(2j * np.pi * k / length)
    return turns.astype(np.complex64), (4 * np.sin(np.pi * k / length) ** 2).astype(np.float32)


class SmoothSpectrum:
    """Half spectrum ŝ of the smooth component of an image (H, W, C), one block of columns at a time.

    v̂ is a sum of two products of a function of k₁ and one of k₂: as real and imaginary parts, a matrix product of
    inner dimension 4. In double precision its products are exact and only its sums are rounded, so that it has the same
    bits from every kernel of BLAS, with fused operations or without.
    """

    def __init__(self, h: Real) -> None:
        self._height, self._width = h.shape[:2]
        channels, columns = h.shape[2], self._width // 2 + 1
        down, self._sines = _axis(self._height, self._height)
        across, cross_sines = _axis(self._width, columns)
        # Denominators are laid out like the parts of complex numbers: each stands for two.
        self._cross_sines = np.repeat(cross_sines, 2)
        left = np.empty((channels, self._height, 2), np.complex64)
        left[:, :, 0] = down
        left[:, :, 1] = scipy.fft.fft(h[:, 0].T - h[:, -1].T)
        right = np.empty((channels, 4, columns), np.complex64)
        right[:, 0] = scipy.fft.rfft(h[0].T - h[-1].T)
        right[:, 2] = across
        right[:, 1::2] = 1j * right[:, ::2]
        self._left, self._right = (factor.view(np.float32).astype(np.float64) for factor in (left, right))

    def block(self, first: int, last: int) -> Iterator[Complex]:
        """Compute columns ``first`` to ``last`` − 1 of ŝ, shape (H, last − first), one channel after the other."""
        columns = slice(2 * first, 2 * last)
        step = max(1, PRODUCT // (2 * (last - first)))
        inverse = self._sines[:, None] + self._cross_sines[columns]
        if first == 0:
            inverse[0, :2] = np.inf
        np.reciprocal(inverse, out=inverse)
        for left, right in zip(self._left, self._right, strict=True):
            smooth = np.empty_like(inverse)
            for y in range(0, self._height, step):
                smooth[y : y + step] = left[y : y + step] @ right[:, columns]
            smooth *= inverse
            yield smooth.view(np.complex64)

    def whole(self) -> Complex:
        """Compute all of ŝ, shape (C, H, W // 2 + 1)."""
        return np.stack(list(self.block(0, self._width // 2 + 1)))


def periodic_spectrum(h: Real, threads: int = 1) -> Complex:
    """Compute the half spectrum p̂ of the periodic component.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
    threads : int
        For the transform.

    Returns
    -------
    ndarray of complex64, shape (H, W // 2 + 1) or (H, W // 2 + 1, C)
        As `scipy.fft.rfft2` over the first two axes would give it.
    """
    if h.ndim == 2:
        return periodic_spectrum(h[:, :, None], threads)[:, :, 0]
    spectrum: Complex = scipy.fft.rfft2(h, axes=(0, 1), workers=threads)
    spectrum -= SmoothSpectrum(h).whole().transpose(1, 2, 0)
    return spectrum


def smooth_planes(h: Real, threads: int = 1) -> Real:
    """Compute the `smooth_component` of an image (H, W, C) as planes (C, H, W)."""
    planes: Real = scipy.fft.irfft2(SmoothSpectrum(h).whole(), s=h.shape[:2], overwrite_x=True, workers=threads)
    return planes


def periodic_planes(h: Real, threads: int = 1) -> Real:
    """Compute the `periodic_component` of an image (H, W, C) as planes (C, H, W)."""
    planes = smooth_planes(h, threads)
    for channel, plane in enumerate(planes):
        np.subtract(h[:, :, channel], plane, out=plane)
    return planes


def smooth_component(h: Real, threads: int = 1) -> Real:
    """Compute the smooth component s = h − p of an image; its mean is 0.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
    threads : int
        For the transform.

    Returns
    -------
    ndarray of float32, the shape of ``h``

    Examples
    --------
    >>> import numpy as np
    >>> ramp = np.tile(np.arange(8, dtype=np.float32), (4, 1))
    >>> bool(np.abs(smooth_component(ramp).mean()) < 1e-5)
    True
    """
    if h.ndim == 2:
        return smooth_component(h[:, :, None], threads)[:, :, 0]
    return np.moveaxis(smooth_planes(h, threads), 0, 2)


def periodic_component(h: Real, threads: int = 1) -> Real:
    """Compute the periodic component p of an image, which has no jumps between opposite borders.

    No transform of ``h`` itself is needed: p = h − s.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
    threads : int
        For the transform.

    Returns
    -------
    ndarray of float32, the shape of ``h``

    Examples
    --------
    A constant image is its own periodic component.

    >>> import numpy as np
    >>> bool((periodic_component(np.full((5, 7), 9, np.float32)) == 9).all())
    True
    """
    if h.ndim == 2:
        return periodic_component(h[:, :, None], threads)[:, :, 0]
    return np.moveaxis(periodic_planes(h, threads), 0, 2)

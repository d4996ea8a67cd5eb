"""Real steerable pyramid in the Fourier domain: an image as sub-bands, one for each scale and orientation.

With r the radial frequency (r = 1 at the Nyquist frequency along an axis), θ its angle, S scales, Q orientations and
the order q = Q − 1, the windows are

    high-pass residual   H(r) = c(log₂ r)           on r > 1/2, and 1 for r ≥ 1,
    scale s              B_s(r) = c(log₂ r + s + 1)  on 2^−(s+2) < r < 2^−s,      s = 0 … S − 1,
    low-pass residual    L(r) = c(log₂ r + S + 1)    on r < 2^−S, and 1 for r ≤ 2^−(S+1),
    orientation b        A_b(θ) = √κ cos^q(θ − π b / Q),   κ = 2^{2q} (q!)² / (Q (2q)!),   b = 0 … Q − 1,

with c(t) = cos(π t / 2) on [−1, 1]. An oriented band's filter is (−i)^q B_s A_b, which makes a real image. Since
H² + Σ B_s² + L² = 1 and Σ A_b² = 1, filtering each band once more with the conjugate filter and adding up gives the
image back.

Scale s is sampled at ceil(N / 2^s) points along an axis of N: its frequencies are |k| < N / 2^(s+1), which these
always hold, so the spectrum is cut without loss, and reconstruction is exact, for even, odd and prime sizes alike.

References
----------
Simoncelli, Freeman, "The Steerable Pyramid: A Flexible Architecture for Multi-Scale Derivative Computation", ICIP
1995; Portilla, Simoncelli, "A Parametric Texture Model Based on Joint Statistics of Complex Wavelet Coefficients",
IJCV 2000 (these windows); Briand, Vacher, Galerne, Rabin, "The Heeger-Bergen Pyramid-Based Texture Synthesis
Algorithm", IPOL 2014.
"""

import math
import threading
from collections import deque
from typing import NamedTuple

import numpy as np
import scipy.fft

from ..arrays import Complex, Real
from ..elementary import log2


class Band(NamedTuple):
    """A sub-band: one orientation of a scale (0 is the finest), or, without orientation, a residual.

    The residual of scale 0 is the high-pass one, that of scale S the low-pass one.
    """

    scale: int
    orientation: int | None


def to_spectrum(image: Real) -> Complex:
    """Transform an image (H, W) to Fourier series coefficients (H, W // 2 + 1), with its mean at the origin."""
    spectrum: Complex = scipy.fft.rfft2(image, norm="forward", workers=1)
    return spectrum


def to_image(spectrum: Complex, shape: tuple[int, int]) -> Real:
    """Transform coefficients of `to_spectrum` back to the image (H, W); overwrites them."""
    image: Real = scipy.fft.irfft2(spectrum, s=shape, norm="forward", overwrite_x=True, workers=1)
    return image


class Filter:
    """Window of one band, on the part of the half spectrum that the band keeps."""

    def __init__(self, window: Complex, shape: tuple[int, int]) -> None:
        self._window, self._shape = window, shape
        self._top, self._bottom = (shape[0] + 1) // 2, shape[0] // 2  # rows of k₁ ≥ 0, and of k₁ < 0

    def analyse(self, spectrum: Complex) -> Real:
        """Compute the band of an image from its `to_spectrum`."""
        part = np.empty_like(self._window)
        columns, top = part.shape[1], self._top
        np.multiply(spectrum[:top, :columns], self._window[:top], out=part[:top])
        np.multiply(spectrum[len(spectrum) - self._bottom :, :columns], self._window[top:], out=part[top:])
        return to_image(part, self._shape)

    def synthesise(self, values: Real) -> Complex:
        """Compute a band's part of the image's spectrum, cut to the frequencies that it keeps."""
        part = to_spectrum(values)
        part *= self._window.conj()
        return part

    def add(self, part: Complex, total: Complex) -> None:
        """Add a part that `synthesise` returned to a half spectrum of the image's size, in its place."""
        columns, top = part.shape[1], self._top
        total[:top, :columns] += part[:top]
        total[len(total) - self._bottom :, :columns] += part[top:]


class SteerablePyramid:
    """Steerable pyramid of images of one size.

    Parameters
    ----------
    height, width : int
        Size of the image, in pixels.
    scales, orientations : int
        At least 1. A scale that does not fit (2^scales > height or width) is all zero along that axis.

    Examples
    --------
    >>> import numpy as np
    >>> image = np.random.default_rng(0).random((15, 22), np.float32)
    >>> pyramid = SteerablePyramid(15, 22, scales=2, orientations=4)
    >>> len(pyramid.bands), pyramid.shape(Band(1, 3)), pyramid.shape(pyramid.bands[-1])
    (10, (8, 11), (4, 6))
    >>> spectrum, total = to_spectrum(image), np.zeros((15, 12), np.complex64)
    >>> for filter in map(pyramid.filter, pyramid.bands):
    ...     filter.add(filter.synthesise(filter.analyse(spectrum)), total)
    >>> bool(np.allclose(to_image(total, (15, 22)), image, atol=1e-6))
    True
    """

    def __init__(self, height: int, width: int, scales: int, orientations: int) -> None:
        self._height, self._width, self.scales, self.orientations = height, width, scales, orientations
        self.bands = (
            Band(0, None),
            *(Band(scale, orientation) for scale in range(scales) for orientation in range(orientations)),
            Band(scales, None),
        )
        self._radial = [self._radial_window(scale) for scale in range(scales)]

    def shape(self, band: Band) -> tuple[int, int]:
        """Height and width of a band."""
        return -(-self._height // 2**band.scale), -(-self._width // 2**band.scale)

    def filter(self, band: Band) -> Filter:
        """Make the filter of a band, at each call anew: that costs less than keeping them all."""
        shape = self.shape(band)
        y, x = self._axes(band.scale)
        if band.orientation is None:
            t = _log_radius(y, x)
            window = _cosine(np.minimum(t - 1, 0) if band.scale == 0 else np.maximum(t, 0))
            return Filter(window.astype(np.complex64), shape)
        angle, order = math.pi * band.orientation / self.orientations, self.orientations - 1
        ramp = (y * math.sin(angle))[:, None] + x * math.cos(angle)
        oriented = self._radial[band.scale].copy()
        for _ in range(order):
            oriented *= ramp
        return Filter(oriented * np.complex64((-1j) ** order), shape)

    def _axes(self, scale: int) -> tuple[Real, Real]:
        """Frequencies along y and x of a scale's part of the half spectrum, in units of its centre, 2^−(s+1)."""
        height, width = self.shape(Band(scale, None))
        k = np.arange(height)
        k[(height + 1) // 2 :] -= height
        y, x = 2.0 ** (scale + 2) * k / self._height, 2.0 ** (scale + 2) * np.arange(width // 2 + 1) / self._width
        return y.astype(np.float32), x.astype(np.float32)

    def _radial_window(self, scale: int) -> Real:
        """√κ B_s(r) / r^q, since r^q cos^q(θ − φ) is the q-th power of a linear function of the frequency."""
        order = self.orientations - 1
        kappa = 2 ** (2 * order) * math.factorial(order) ** 2 / (self.orientations * math.factorial(2 * order))
        t = _log_radius(*self._axes(scale))
        window: Real = np.exp(np.maximum(t, -1) * np.float32(-order * math.log(2)))
        window *= math.sqrt(kappa)
        window *= _cosine(t)
        return window


class Total:
    """Sum of the bands' spectra, always in the order of the pyramid's bands: sums of floats depend on the order."""

    def __init__(self, pyramid: SteerablePyramid) -> None:
        self._expected = deque(pyramid.bands)
        self._waiting: dict[Band, tuple[Filter, Complex]] = {}
        self._sum: Complex | None = None
        self._lock = threading.Lock()

    def add(self, band: Band, window: Filter, part: Complex) -> Complex | None:
        """Add one band's part.

        Parameters
        ----------
        band : Band
        window : Filter
            The band's.
        part : ndarray of complex64
            As `Filter.synthesise` returns it.

        Returns
        -------
        ndarray of complex64 or None
            The sum, which is the caller's, once all bands are there.
        """
        with self._lock:
            self._waiting[band] = window, part
            while self._expected and self._expected[0] in self._waiting:
                ready, values = self._waiting.pop(self._expected.popleft())
                if self._sum is None:  # the high-pass residual comes first and has the whole size
                    self._sum = np.zeros_like(values)
                ready.add(values, self._sum)
            if self._expected:
                return None
            total, self._sum = self._sum, None
            return total


def _log_radius(y: Real, x: Real) -> Real:
    """log₂ of the distance from the origin, where it is −∞."""
    return np.asarray(log2(y[:, None] ** 2 + x**2) / 2)


def _cosine(t: Real) -> Real:
    """c(t) = cos(π t / 2) on [−1, 1], 0 outside."""
    return np.asarray(np.cos(np.float32(np.pi / 2) * np.clip(t, -1, 1)))

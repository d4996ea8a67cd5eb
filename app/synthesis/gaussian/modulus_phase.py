"""Swap of modulus and phase: the Fourier modulus of one image with the phase of another, both ways.

    t̂(ξ) = |â(ξ)| exp(i arg b̂(ξ)),   ô(ξ) = |b̂(ξ)| exp(i arg â(ξ)),

channel by channel, on the images as they are and not on their periodic components, so that what is swapped twice comes
back as it was. At the origin the modulus is that of the mean, and its sign the phase. Where one image has nothing but
rounding errors, and so no phase, the other keeps its own: it can then be had back there, too.

References
----------
Oppenheim, Lim, "The Importance of Phase in Signals", Proceedings of the IEEE, 1981.
"""

import math

import numpy as np
import scipy.fft

from ..arrays import Complex, Progress, Real, ignore_progress
from ..elementary import angle

ROUNDING = 1e-6  # of an image's ℓ² norm: what coefficients of single precision may be off by


def swap(first: Real, second: Real, threads: int = 1, progress: Progress | None = None) -> tuple[Real, Real]:
    """Swap the phases of two images.

    Parameters
    ----------
    first, second : ndarray of float32, both of one shape (H, W) or (H, W, C)
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between transforms; what it raises stops the work.

    Returns
    -------
    tuple of two ndarray of float32, each of that shape
        The modulus of the first with the phase of the second, and the modulus of the second with the phase of the
        first. Each has the mean, and every channel's variance, of the image that gave the modulus (with the sign
        of the other's mean).

    Raises
    ------
    ValueError
        If the shapes differ.

    Examples
    --------
    >>> import numpy as np
    >>> a, b = np.random.default_rng(0).random((2, 8, 9), np.float32)
    >>> c, d = swap(*swap(a, b))
    >>> bool(np.allclose(a, c, atol=1e-5) and np.allclose(b, d, atol=1e-5))
    True
    """
    if first.shape != second.shape:
        raise ValueError("The images differ in their size or number of channels.")
    if first.ndim == 2:
        one, other = swap(first[:, :, None], second[:, :, None], threads, progress)
        return one[:, :, 0], other[:, :, 0]
    report = progress or ignore_progress
    report("swap", 0)
    height, width, channels = first.shape
    images = np.empty((2, channels, height, width), np.float32)
    for channel in range(channels):
        planes = first[:, :, channel], second[:, :, channel]
        a, b = (scipy.fft.rfft2(plane, workers=threads) for plane in planes)
        report("swap", (channel + 0.4) / channels)
        floors = (ROUNDING * math.sqrt(np.einsum("yx,yx->", plane, plane)) for plane in planes)
        spectra = _swapped(a, b, *floors)
        report("swap", (channel + 0.6) / channels)
        for image, spectrum in zip(images, spectra, strict=True):
            image[channel] = scipy.fft.irfft2(spectrum, s=(height, width), overwrite_x=True, workers=threads)
        report("swap", (channel + 1) / channels)
    return np.moveaxis(images[0], 0, 2), np.moveaxis(images[1], 0, 2)


def _swapped(a: Complex, b: Complex, a_floor: float, b_floor: float) -> list[Complex]:
    a_modulus, b_modulus = np.abs(a), np.abs(b)
    return [
        _with_modulus(np.where(b_modulus <= b_floor, a, b), a_modulus),
        _with_modulus(np.where(a_modulus <= a_floor, b, a), b_modulus),
    ]


def _with_modulus(spectrum: Complex, modulus: Real) -> Complex:
    own = np.abs(spectrum)
    own[own == 0] = 1
    return spectrum * (modulus / own)  # numpy divides complex numbers ten times slower than it multiplies them


def power(planes: Real, threads: int = 1) -> Real:
    """Compute the squared modulus on the half spectrum, the mean over the channels.

    Parameters
    ----------
    planes : ndarray of float32, shape (C, H, W)
    threads : int

    Returns
    -------
    ndarray of float32, shape (H, W // 2 + 1)
    """
    total = np.zeros((planes.shape[1], planes.shape[2] // 2 + 1), np.float32)
    for plane in planes:
        spectrum = scipy.fft.rfft2(plane, workers=threads)
        total += spectrum.real**2 + spectrum.imag**2
    total /= len(planes)
    return total


def centred_phase(image: Real, threads: int = 1) -> Real:
    """Compute the phase of the mean of an image's channels, with the origin in the middle.

    Parameters
    ----------
    image : ndarray of float32, shape (H, W) or (H, W, C)
    threads : int

    Returns
    -------
    ndarray of float32, shape (H, W)
        Within [−π, π]; the origin is at (H // 2, W // 2), and the phase at −k is minus that at k.

    Examples
    --------
    >>> import numpy as np
    >>> wave = np.cos(np.arange(8) * np.pi / 4 + 1)[None].astype(np.float32)
    >>> phase = centred_phase(wave)
    >>> bool(np.isclose(phase[0, 5], 1)), bool(np.isclose(phase[0, 3], -1))
    (True, True)
    """
    grey = image if image.ndim == 2 else image.mean(axis=2)
    height, width = grey.shape
    half = angle(scipy.fft.rfft2(grey, workers=threads))
    rows = -np.arange(height) % height
    left = -half[rows, width // 2 : 0 : -1]  # frequencies −(W // 2) … −1
    whole = np.concatenate([left, half[:, : (width + 1) // 2]], axis=1)
    return np.fft.fftshift(whole, axes=0).astype(np.float32, copy=False)

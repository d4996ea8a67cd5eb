"""Rayleigh noise on the Fourier modulus of an image, whose phase stays.

    ẑ(ξ) = p̂(ξ) R(ξ),   R even, Rayleigh with E R² = 1, R(0) = 1,

p being the periodic component, which the article takes in all its experiments. R is the modulus noise of the ADSN of
the same seed: to randomise the phase of z as RPN does at this seed is to make that ADSN.

References
----------
Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011: section 6.3 and figure 16.
"""

import numpy as np
import scipy.fft

from ..arrays import Progress, Real, ignore_progress
from ..fourier.periodic import SmoothSpectrum
from ..fourier.spectral import half_spectrum
from ..fourier.spot import centre
from .adsn import white_noise


def rayleigh(
    h: Real,
    height: int | None = None,
    width: int | None = None,
    *,
    seed: int = 0,
    threads: int = 1,
    progress: Progress | None = None,
) -> Real:
    """Multiply the Fourier modulus of an image's periodic component by a white Rayleigh noise, and keep the phase.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
        Any number of channels, any range; the noise is the same in all channels.
    height, width : int, optional
        Size of the result, at most the image's, of which the centre is taken; default: the image's.
    seed : int
        Not negative; the result depends on nothing else.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between transforms; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (height, width) or (height, width, C)
        Periodic, with the mean of ``h`` (or its centre); values may lie outside the range of ``h``.

    Raises
    ------
    ValueError
        If the size is larger than the image's, which has no phase to keep there.

    Examples
    --------
    >>> import numpy as np
    >>> h = np.random.default_rng(0).random((16, 20, 3), np.float32)
    >>> z = rayleigh(h, seed=7)
    >>> z.shape, bool(np.allclose(z.mean((0, 1)), h.mean((0, 1))))
    ((16, 20, 3), True)
    """
    if h.ndim == 2:
        return rayleigh(h[:, :, None], height, width, seed=seed, threads=threads, progress=progress)[:, :, 0]
    report = progress or ignore_progress
    report("rayleigh noise", 0)
    height, width = height or h.shape[0], width or h.shape[1]
    h = centre(h, height, width)
    if h.shape[:2] != (height, width):
        raise ValueError("The image has no phase to keep beyond its own size.")
    noise = np.abs(half_spectrum(white_noise, height, width, seed))
    z = np.empty((h.shape[2], height, width), np.float32)
    smooths = SmoothSpectrum(h).block(0, width // 2 + 1)
    for channel, smooth in enumerate(smooths):
        spectrum = scipy.fft.rfft2(h[:, :, channel], workers=threads)
        report("rayleigh noise", (channel + 0.4) / h.shape[2])
        spectrum -= smooth
        spectrum *= noise
        report("rayleigh noise", (channel + 0.6) / h.shape[2])
        z[channel] = scipy.fft.irfft2(spectrum, s=(height, width), overwrite_x=True, workers=threads)
        report("rayleigh noise", (channel + 1) / h.shape[2])
    return np.moveaxis(z, 0, 2)

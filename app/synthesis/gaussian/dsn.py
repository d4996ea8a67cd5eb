"""DSN, discrete spot noise: n copies of a spot at random places, centred and normalised.

    Z = (f_n − n m) / √n + m,   f_n(x) = Σ_{k ≤ n} h(x − X_k),   X_k uniform on the torus, independent.

With the count image c(x) = #{k : X_k = x} that is one convolution, Z = m + (h − m) ∗ (c − n/N) / √n for N pixels,
and c is a multinomial variable: its cost need not grow with n. Mean and covariance are those of the ADSN for every
n, and the excess kurtosis of a pixel is that of the spot's values divided by n.

References
----------
Galerne, Gousseau, Morel, "Random Phase Textures: Theory and Synthesis", IEEE TIP 2011: sections 2.1 and 2.2, figures
4 and 5; van Wijk, "Spot noise: texture synthesis for data visualization", SIGGRAPH 1991.
"""

from typing import Literal

import numpy as np
import scipy.fft
from numpy.random import SFC64, Generator, SeedSequence
from numpy.typing import NDArray
from scipy.special import pdtr

from ..arrays import Double, Ints, Progress, Real
from ..fourier.spectral import STATES
from ..fourier.spot import Spot
from ..fourier.spot_noise import convolve

POINTS = 100_000  # most points that are drawn one by one
DEVIATIONS = 12  # of a Poisson variable: it goes further with a chance of 1e-32


def counts(height: int, width: int, order: int, seed: int) -> Ints:
    """Count how many of ``order`` independent uniform points of the torus fall on each pixel: a multinomial variable.

    The first 100,000 points are drawn one by one, so that those of a smaller order are among those of a greater
    one. Of the rest, all but a few are drawn at once: a Poisson number on each pixel, whose law *given its total*
    is the multinomial one; the points that are missing from ``order`` are drawn one by one again. Nothing is
    approximated, and 10⁷ points cost what 10 do.

    Parameters
    ----------
    height, width : int
        Size of the torus, in pixels.
    order : int
        Number of points, at least 1.
    seed : int
        Not negative.

    Returns
    -------
    ndarray of int64, shape (height, width)
        Their sum is ``order``.

    Examples
    --------
    >>> few, more = counts(8, 9, 10, seed=1), counts(8, 9, 100, seed=1)
    >>> int(few.sum()), int(more.sum()), bool((few <= more).all())
    (10, 100, True)
    """
    pixels = height * width
    points, rest = (Generator(SFC64(SeedSequence(seed, spawn_key=(0, stream)))) for stream in range(2))
    mean = max(0.0, order - POINTS - DEVIATIONS * np.sqrt(order)) / pixels
    many = _poisson(rest, mean, pixels) if mean else None
    single = order if many is None else order - int(many.sum(dtype=np.int64))
    drawn: Ints = np.bincount(points.integers(pixels, size=single), minlength=pixels)
    if many is not None:
        drawn += many
    return drawn.reshape(height, width)


def _poisson(random: Generator, mean: float, size: int) -> NDArray[np.int32]:
    """``size`` Poisson variables by inversion: a table for 16 random bits, more bits where those do not decide."""
    if size < STATES:
        return random.poisson(mean, size).astype(np.int32)
    reach = DEVIATIONS * (np.sqrt(mean) + 1)
    low = max(0, int(mean - reach))
    cumulated = pdtr(np.arange(low, mean + reach), mean)
    edges = np.arange(STATES + 1) / STATES
    least, greatest = np.searchsorted(cumulated, edges[:-1], "right"), np.searchsorted(cumulated, edges[1:], "left")
    table = np.where(least == greatest, low + least, -1).astype(np.int32)
    words = random.bit_generator.random_raw(-(-size // 4)).view(np.uint16)[:size]
    values = np.take(table, words)
    open_ones = np.flatnonzero(values < 0)
    finer = (words[open_ones] + random.random(len(open_ones))) / STATES
    values[open_ones] = low + np.searchsorted(cumulated, finer, "right")
    return values


def impulses(height: int, width: int, order: int, seed: int) -> Real:
    """Draw the white noise of a DSN, (c − n/N) / √n, of mean 0 and variance 1/N.

    Parameters
    ----------
    height, width, order, seed
        Those of `counts`.

    Returns
    -------
    ndarray of float32, shape (height, width)
    """
    drawn = counts(height, width, order, seed)
    # Whole numbers first: near zero, single precision is enough.
    drawn -= order // drawn.size
    noise: Real = drawn.astype(np.float32)
    noise -= np.float32(order % drawn.size / drawn.size)
    noise /= np.float32(np.sqrt(order))
    return noise


def dsn(spot: Spot, order: int, *, seed: int = 0, threads: int = 1, progress: Progress | None = None) -> Real:
    """Synthesize the DSN of a spot.

    Parameters
    ----------
    spot : Spot
        A spot of the texture's size: `microtexture.fourier.spot_noise.sample_spot`, or `standard_spot`.
    order : int
        n, at least 1.
    seed : int
        Not negative; points of a smaller order are among those of a greater one, up to 100,000.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between transforms; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (height, width, C)
        Periodic; its mean is the spot's, values may lie outside the sample's range.

    Examples
    --------
    >>> spot = standard_spot("disc", 32, 40, radius=3, mean=128, deviation=40)
    >>> z = dsn(spot, 10, seed=7)
    >>> z.shape, round(float(z.mean()))
    ((32, 40, 1), 128)
    """
    if progress:
        progress("points", 0.0)
    noise = impulses(spot.height, spot.width, order, seed)
    if progress:
        progress("points", 0.5)
    spectrum = scipy.fft.rfft2(noise, overwrite_x=True, workers=threads)
    return convolve([spot], [spectrum], threads, progress)


def spot_shape(kind: Literal["disc", "gaussian"], height: int, width: int, radius: float) -> Real:
    """Draw a spot that needs no sample, in the middle of an image, with values from 0 to 1.

    Parameters
    ----------
    kind : {"disc", "gaussian"}
        1 within ``radius`` of the middle pixel and 0 elsewhere, or a Gaussian whose standard deviation is half of it.
    height, width : int
        Size of the image, in pixels.
    radius : float
        In pixels.

    Returns
    -------
    ndarray of float32, shape (height, width)
    """
    y, x = np.ogrid[:height, :width]
    square = (y - height // 2) ** 2 + (x - width // 2) ** 2
    values: Real = (square <= radius**2 if kind == "disc" else np.exp(-2 * square / radius**2)).astype(np.float32)
    return values


def standard_spot(
    kind: Literal["disc", "gaussian"], height: int, width: int, radius: float, mean: float, deviation: float
) -> Spot:
    """Make a spot from `spot_shape` whose noises have this mean and standard deviation.

    Parameters
    ----------
    kind, height, width, radius
        Those of `spot_shape`.
    mean, deviation : float
        Mean and standard deviation of every noise of the spot.

    Returns
    -------
    Spot
        A spot of one channel.

    Raises
    ------
    ValueError
        If the shape covers the whole image and so has no deviation.
    """
    values = spot_shape(kind, height, width, radius)
    values -= values.mean(dtype=np.float64)
    found = values.std(dtype=np.float64)
    if found == 0:
        raise ValueError("The spot covers the whole texture.")
    values *= np.float32(deviation / found)
    return Spot(values[None], np.array([mean]), height, width)


def excess_kurtosis(spot: Spot) -> Double:
    """Compute the excess kurtosis of a spot's values, shape (C,); a pixel of its DSN has 1/n of it.

    0 for a spot without contrast.
    """
    pixels, found = spot.height * spot.width, []
    for plane in spot.planes:
        # Outside its rectangle the spot less its mean over the image is −mean.
        mean, around = float(plane.sum(dtype=np.float64)) / pixels, pixels - plane.size
        square = plane - np.float32(mean)
        square *= square
        second = (float(square.sum(dtype=np.float64)) + around * mean**2) / pixels
        square *= square
        fourth = (float(square.sum(dtype=np.float64)) + around * mean**4) / pixels
        found.append(fourth / second**2 - 3 if second else 0.0)
    return np.array(found)

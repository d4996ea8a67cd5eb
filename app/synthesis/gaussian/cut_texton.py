"""Cut texton: a Gaussian colour texture from a kernel of K × K pixels, which keeps the covariance of its colours.

At every frequency the model of a sample is Gaussian of covariance p̂ p̂* over the channels (p̂ a column, the spectrum of
the periodic component). A cut cannot keep all of that, but it can keep an average over neighbouring frequencies,
which fades the covariance Γ(z) = IDFT(p̂ p̂*) of the colours of two places out with their lag z, along each axis of N
pixels linearly and until 4K N/(N − K). Of all kernels, matrices t̂ with that product t̂ t̂*, the Hermitian root is the
one without phase:

    Ŝ = DFT(w Γ),   t̂ = Ŝ^(1/2),   w(z) = (1 − |z₁|/reach₁)₊ (1 − |z₂|/reach₂)₊.

(Without the average, t̂ = p̂ p̂*/‖p̂‖ would weigh colours by themselves, at each frequency by what it has of them against
light and dark, which flutters from one to the next. Of grey there is nothing to weigh: t̂ = |p̂| is not averaged.)

Column j is the spot of a white noise Wⱼ of its own. Whole, that changes nothing: w is 1, and t̂ Ŵ is p̂ times one white
noise. But a cut to Ω leaves of a single colour spot, `microtexture.gaussian.texton`, the luminance, whose
phase was taken off, and little of the colours, which do not gather at the origin; leaves turn sepia. Here everything
gathers there. What is cut off is variance, of the differences of channels more than of what they share, and one matrix
for the whole kernel gives it back:

    t̃ = m + R t 1_Ω,   R = B^(−1/2) (B^(1/2) C B^(1/2))^(1/2) B^(−1/2),

with C the covariance of the sample's colours, B the one that the cut kernel makes in the texture, and R the symmetric
matrix for which R B Rᵀ = C. For grey it is a factor.

References
----------
Desolneux, Moisan, Ronsin, "A Compact Representation of Random Phase and Gaussian Textures", ICASSP 2012 (grey); Xia,
Ferradans, Peyré, Aujol, "Synthesizing and Mixing Stationary Gaussian Texture Models", SIIMS 2014 (spectra as matrices).
What else was tried is in benchmarks/README.md.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from math import ceil, hypot, inf, sqrt

import numpy as np
import scipy.fft
from scipy.fft import next_fast_len

from ..arrays import Complex, Double, Ints, Progress, Real
from ..fourier.periodic import periodic_planes
from ..fourier.spot import Spot
from ..pyramid.colour_space import ColourSpace

REACH = 4  # times K, of the covariances that the cut kernel is the root of; see benchmarks/README.md
NOTHING = 1e-10  # of the greatest variance: axes of colours with less hold rounding
ROUNDING = 1e-15  # the same of a cut kernel, where what is weak in the sample is weaker still


@dataclass(frozen=True)
class CutTexton:
    """Cut texton of a sample.

    Parameters
    ----------
    spots : tuple of Spot
        One for each white noise, at most C: R t 1_Ω along the principal axes of the sample's colours, the strongest
        first; an axis without variance has none.
    gains : tuple of float
        R along these axes.
    """

    spots: tuple[Spot, ...]
    gains: tuple[float, ...]


def cut_texton(
    h: Real,
    mean: Double,
    height: int,
    width: int,
    cut: int,
    threads: int = 1,
    progress: Progress | None = None,
) -> CutTexton:
    """Cut the texton of a sample to the K × K pixels around its origin, for textures of one size.

    Parameters
    ----------
    h : ndarray of float32, shape (M₁, N₁, C)
        The sample; no axis longer than the output's.
    mean : ndarray of float64, shape (C,)
        Mean of every channel of the sample.
    height, width : int
        Size of the output.
    cut : int
        K, at least 1; a shorter axis is taken whole.
    threads : int
        For the transforms.
    progress : callable ``(stage, part)``, optional
        Called between transforms; what it raises stops the work.

    Returns
    -------
    CutTexton

    Examples
    --------
    >>> import numpy as np
    >>> h = np.random.default_rng(0).random((16, 21, 3), np.float32)
    >>> texton = cut_texton(h, h.mean((0, 1), dtype=np.float64), 40, 40, 1)
    >>> [spot.planes.shape for spot in texton.spots]
    [(3, 1, 1), (3, 1, 1), (3, 1, 1)]
    """
    p = _centred(h, threads)
    colours = ColourSpace.from_planes(p)
    used = max(1, int((colours.variances > NOTHING * colours.variances[0]).sum()))
    axes = colours.axes[:used]
    p = np.stack([sum(np.float32(part) * plane for part, plane in zip(axis, p, strict=True)) for axis in axes])
    kernel = _root(_spectra(p, threads), p.shape[1:], cut, threads, progress)
    _report(progress, 1.0)
    factor = _transport(_covariance(kernel, height * width), np.diag(colours.variances[:used]))
    turned = np.einsum("ab,bjyx->jayx", axes.T @ factor, kernel)
    spots = tuple(Spot(planes.astype(np.float32), mean, height, width) for planes in turned)
    return CutTexton(spots, tuple(float(gain) for gain in factor.diagonal()))


def lag_error(h: Real, spots: Sequence[Spot], threads: int = 1) -> tuple[float, float]:
    """Measure the largest error of a model's covariance of colours at two places.

    The covariance at lag z is the matrix Γ(z) of the mean products of channel a at u and b at u + z. All lags of the
    sample's torus are compared with the sample's own, by Frobenius norms.

    Parameters
    ----------
    h : ndarray of float32, shape (M₁, N₁, C)
        The sample.
    spots : sequence of Spot
        One for each white noise of the model.
    threads : int
        For the transforms.

    Returns
    -------
    error : float
        Norm of the largest difference, as a part of that of Γ(0); 0 for a sample without contrast.
    lag : float
        Distance of the two places, in pixels.

    Examples
    --------
    >>> import numpy as np
    >>> h = np.random.default_rng(0).random((16, 21, 3), np.float32)
    >>> mean = h.mean((0, 1), dtype=np.float64)
    >>> [round(lag_error(h, cut_texton(h, mean, 16, 21, cut).spots)[0], 3) for cut in (1, 99)]
    [0.184, 0.0]
    """
    p = _centred(h, threads)
    spectra, size = _spectra(p, threads), p.shape[1:]
    texture, kernel = (spots[0].height, spots[0].width), spots[0].planes.shape[1:]
    area = texture[0] * texture[1]
    # Twice the kernel's size keeps its correlations apart, in a texture that is so large.
    torus = [min(2 * side, whole) for side, whole in zip(kernel, texture, strict=True)]
    kernels = [scipy.fft.rfft2(spot.planes, s=torus, workers=threads) for spot in spots]
    sums = [spot.planes.sum(axis=(1, 2), dtype=np.float64) / area for spot in spots]
    there, lags = [], []
    for side, reach, period, whole in zip(size, kernel, torus, texture, strict=True):
        lag = centred_places(side, side)
        lag = lag if period == whole else lag[np.abs(lag) < reach]
        there.append(lag % side)
        lags.append(lag % period)
    squares = np.zeros(size)
    for a, b in combinations_with_replacement(range(len(p)), 2):
        error = scipy.fft.irfft2(spectra[a].conj() * spectra[b], s=size, workers=threads) / (size[0] * size[1])
        product = np.sum([each[a].conj() * each[b] for each in kernels], axis=0)
        error[np.ix_(*there)] -= (scipy.fft.irfft2(product, s=torus, workers=threads) / area)[np.ix_(*lags)]
        error += np.float32(sum(each[a] * each[b] for each in sums))
        error *= error
        squares += error
        if a != b:  # the other way round, each lag has what its opposite has here
            squares += np.roll(error[::-1, ::-1], 1, (0, 1))
    row, column = np.unravel_index(squares.argmax(), size)
    norm = sqrt(sum(float(np.mean(a * b, dtype=np.float64)) ** 2 for a in p for b in p))
    distance = hypot(min(row, size[0] - row), min(column, size[1] - column))
    return (sqrt(squares[row, column]) / norm, distance) if norm else (0.0, 0.0)


def _centred(h: Real, threads: int) -> Real:
    """Compute the planes of the periodic component, without their means."""
    p = periodic_planes(h, threads)
    p -= p.mean(axis=(1, 2), dtype=np.float64, keepdims=True).astype(np.float32)
    return p


def _spectra(p: Real, threads: int) -> Complex:
    spectra: Complex = scipy.fft.rfft2(p, workers=threads)
    spectra[:, 0, 0] = 0
    return spectra


def centred_places(side: int, cut: int) -> Ints:
    """List the places, relative to the origin of a torus, of the ``cut`` pixels whose middle is the origin."""
    count = min(cut, side)
    return np.arange(count) - count // 2


def _root(spectra: Complex, size: Sequence[int], cut: int, threads: int, progress: Progress | None) -> Real:
    """The square around the origin of the root of the averaged spectra, (C, C, K, K)."""
    count = len(spectra)
    kernel = np.empty((count, count, *(min(side, cut) for side in size)), np.float32)
    if count == 1:
        kernel[0, 0] = scipy.fft.irfft2(np.abs(spectra[0]), s=size, workers=threads)[_square(size, cut)]
        return kernel
    reaches = [REACH * cut * side / (side - cut) if cut < side else inf for side in size]
    # The averaged spectra are those of covariances within reach, which a grid of twice that has room for.
    grid = [
        side if 2 * reach >= side else next_fast_len(2 * ceil(reach)) for side, reach in zip(size, reaches, strict=True)
    ]
    grid = [min(each) for each in zip(grid, size, strict=True)]
    lags = [centred_places(side, side) for side in grid]
    down, across = (
        np.maximum(1 - np.abs(lag) / reach, 0).astype(np.float32) for lag, reach in zip(lags, reaches, strict=True)
    )
    place, taken = (np.ix_(*(lag % side for lag, side in zip(lags, sides, strict=True))) for sides in (grid, size))
    averaged = np.empty((grid[0], grid[1] // 2 + 1, count, count), np.complex64)
    faded = np.empty(grid, np.float32)
    for done, (a, b) in enumerate(combinations_with_replacement(range(count), 2)):
        _report(progress, done / (count * count + count))
        product = scipy.fft.irfft2(spectra[a] * spectra[b].conj(), s=size, overwrite_x=True, workers=threads)
        faded[place] = product[taken] * down[:, None] * across
        averaged[:, :, a, b] = scipy.fft.rfft2(faded, workers=threads)
        averaged[:, :, b, a] = averaged[:, :, a, b].conj()
    for row, matrices in enumerate(averaged):
        _report(progress, 0.5 + 0.4 * row / len(averaged))
        # In double precision, and rounded after: other processors' LAPACK rounds otherwise.
        values, axes = np.linalg.eigh(matrices.astype(np.complex128))
        matrices[:] = (axes * np.sqrt(np.maximum(values, 0))[:, None, :]) @ axes.conj().swapaxes(1, 2)
    for a, b in np.ndindex(count, count):
        _report(progress, 0.9 + 0.1 * (a * count + b) / count**2)
        kernel[a, b] = scipy.fft.irfft2(averaged[:, :, a, b], s=grid, workers=threads)[_square(grid, cut)]
    return kernel


def _square(size: Sequence[int], cut: int) -> tuple[Ints, ...]:
    """Index of the pixels around the origin of a torus."""
    return np.ix_(*(centred_places(side, cut) for side in size))


def _report(progress: Progress | None, part: float) -> None:
    if progress:
        progress("texton", part)


def _covariance(kernel: Real, area: int) -> Double:
    """Compute the covariance (C, C) of the colours of a kernel's texture of ``area`` pixels."""
    sums = kernel.sum(axis=(2, 3), dtype=np.float64) / area
    found: Double = np.einsum("ajyx,bjyx->ab", kernel, kernel, dtype=np.float64) / area - sums @ sums.T
    return found


def _transport(have: Double, target: Double) -> Double:
    """The symmetric R with R have Rᵀ = target: the optimal transport between Gaussian laws of these covariances."""
    root, inverse = _roots(have)
    middle, _ = _roots(root @ target @ root)
    factor: Double = inverse @ middle @ inverse
    return factor


def _roots(symmetric: Double) -> tuple[Double, Double]:
    """The root of a covariance and its inverse, which is 0 along axes that hold nothing at all."""
    values, axes = np.linalg.eigh(symmetric)
    there = values > ROUNDING * max(values[-1], 0)
    roots = np.sqrt(np.where(there, values, 0))
    inverses = np.where(there, 1 / np.where(there, roots, 1), 0)
    return (axes * roots) @ axes.T, (axes * inverses) @ axes.T

"""Texton: a compact representation of a Gaussian texture, the spot with the sample's Fourier modulus and no phase.

    t̂_c(k) = p̂_c(k) conj(ℓ̂(k)) / |ℓ̂(k)|,   t̂(0) = 0,

where p is the sample's periodic component and ℓ its luminance. For a grey sample that is |p̂|; for a colour one the
luminance's phase is taken off every channel, so that the channels keep their displacements against each other.
Spots that differ by a phase common to all channels have the same autocorrelation, so the texton's noise is the
sample's; but its energy gathers around its origin, so it can be pasted into a larger image without a window:

    t̃ = m + r (t − m) 1_Ω,

with Ω the sample's domain.

References
----------
Desolneux, Moisan, Ronsin, "A Compact Representation of Random Phase and Gaussian Textures", ICASSP 2012; Galerne,
"Image texture synthesis using spot noise and phase randomization" (lecture, 2017), section 7.
"""

from collections.abc import Sequence

import numpy as np
import scipy.fft

from ..arrays import Complex, Double, Progress, Real, ignore_progress
from ..fourier.periodic import periodic_planes
from ..fourier.spectral import Block, column_blocks, random_bits
from ..fourier.spot import Spot
from ..fourier.spot_noise import convolve, sample_spot, transform
from ..luminance import luminance
from .adsn import white_noise


def _sign(spectrum: Complex) -> Complex:
    """``z / |z|``, and 1 where z is 0."""
    modulus = np.abs(spectrum)
    nothing = modulus == 0
    modulus[nothing] = 1
    sign = np.divide(spectrum, modulus, out=spectrum.copy())
    sign[nothing] = 1
    return sign


def texton(h: Real, threads: int = 1, progress: Progress | None = None) -> Real:
    """Compute the texton of the periodic component of an image, without its mean.

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
    if progress:
        progress("texton", 1.0)
    return p.transpose(1, 2, 0)


def radii(t: Real, parts: Sequence[float]) -> list[float]:
    """Find the radii of the smallest discs around the texton's origin that hold parts of its energy.

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


def extend_texton(t: Real, mean: Double, height: int, width: int) -> Spot:
    """Extend a texton: t̃ = m + r (t − m) 1_Ω with r² = M₂N₂ / (M₁N₁).

    Its noise has the covariance of colours (1/M₂N₂) Σ (t̃ − m)(t̃ − m)ᵀ, the sum over an image of M₂ × N₂ pixels, and
    that is then the sample's, (1/M₁N₁) Σ (t − m)(t − m)ᵀ. No more can be cut off than that: see
    `microtexture.gaussian.cut_texton`.

    Parameters
    ----------
    t : ndarray of float32, shape (M₁, N₁, C)
        `texton`; no axis longer than the output's.
    mean : ndarray of float64, shape (C,)
        Mean of every channel of the sample.
    height, width : int
        Size M₂ × N₂ of the output.

    Returns
    -------
    Spot
    """
    r = np.sqrt(height * width / (t.shape[0] * t.shape[1]))
    return Spot(t.transpose(2, 0, 1) * np.float32(r), mean, height, width)


def texton_noise(
    h: Real, spots: Sequence[Spot], *, seed: int = 0, threads: int = 1, progress: Progress | None = None
) -> Real:
    """Synthesize the ADSN of a sample's texton, its luminance at the phase of the sample's own ADSN.

    At every frequency, with ℓ the luminance of the sample's extended spot, aⱼ that of the texton's spots, R the white
    noise of `microtexture.gaussian.adsn` at this seed and V white noises of their own, spot j has the noise

        Ŵⱼ = vⱼ R + V̂ⱼ − vⱼ Σᵢ v̄ᵢ V̂ᵢ,   vⱼ = (ℓ / |ℓ|) āⱼ / ‖a‖.

    v is fixed and of norm 1, so Ŵ is white and of independent components; and the texture's luminance, Σ aⱼ Ŵⱼ, is
    ‖a‖ (ℓ / |ℓ|) R: it has the phase of the ADSN, and its Rayleigh noise. Of a whole texton, a single spot, the
    texture is that ADSN in all channels, where it has the sample's size.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
        The sample.
    spots : sequence of Spot
        `extend_texton` of the texton of h, alone, or the spots of `microtexture.gaussian.cut_texton.cut_texton`.
    seed : int
        Not negative.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between transforms; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (height, width, C) of the spots
    """
    report = progress or ignore_progress
    height, width = spots[0].height, spots[0].width
    report("random phase", 0.0)
    own = sample_spot(h, height, width, threads=threads)
    phase = _sign(transform(luminance(own.planes.transpose(1, 2, 0)), own, threads))
    del own
    shares = []
    for number, spot in enumerate(spots):
        report("random phase", (1 + 2 * number / len(spots)) / 5)
        shares.append(transform(luminance(spot.planes.transpose(1, 2, 0)), spot, threads).conj())
    norm = np.sqrt(sum(np.square(share.real) + np.square(share.imag) for share in shares))
    nowhere = norm == 0
    norm[nowhere] = 1
    phase /= norm
    for share in shares:
        np.multiply(share, phase, out=share)
        share[nowhere] = 1 / np.sqrt(len(shares))
    del norm, phase
    report("random phase", 3 / 5)
    for block in column_blocks(width):
        _draw(shares, block, width, seed)
    return convolve(spots, shares, threads, progress)


def _draw(shares: Sequence[Complex], block: Block, width: int, seed: int) -> None:
    """Put the noises Ŵⱼ in the place of the shares vⱼ, in a block of columns."""
    columns = [share[:, slice(*block)] for share in shares]
    height = len(columns[0])
    common = white_noise(height, width, block, random_bits(seed, block))
    if len(columns) == 1:
        columns[0] *= common
        return
    streams = range(1, 1 + len(columns))
    own = [white_noise(height, width, block, random_bits(seed, block, stream)) for stream in streams]
    for share, noise in zip(columns, own, strict=True):
        common -= share.conj() * noise
    for share, noise in zip(columns, own, strict=True):
        np.add(np.multiply(share, common, out=share), noise, out=share)

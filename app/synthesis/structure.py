"""The structure index δ: how far an image is from its own random phase textures.

Of all images with one Fourier modulus, those whose phases are in no order have the greatest total variation, near
enough: order makes edges, and between edges it is flat. So the share of total variation that an image lacks against
ADSN(p) tells whether a random phase model can reproduce it. With ẋ and ẏ the forward differences along the rows and
the columns of the torus, α_x = ‖ẋp‖₂ and α_y = ‖ẏp‖₂, and N pixels,

    TV(p) = ‖ẋp‖₁ + ‖ẏp‖₁,
    μ = E TV(ADSN(p)) = (α_x + α_y) √(2/π) √N,
    σ_TV² = Var TV(ADSN(p)) = (2/π) Σ_z [α_x² ω(Γ_xx(z)/α_x²) + 2 α_x α_y ω(Γ_xy(z)/(α_x α_y)) + α_y² ω(Γ_yy(z)/α_y²)],
    ω(t) = t asin t + √(1 − t²) − 1,   Γ the periodic correlations of the differences,
    δ = (μ − TV)/μ,   z = (μ − TV)/σ_TV.

p is the grey periodic component, smoothed by a periodic Gaussian: at the finest scale total variation tells sharp
pictures from blurred ones rather than structured from unstructured ones.

References
----------
Blanchet, Moisan, "An explicit sharpness index related to global phase coherence", ICASSP 2012: μ, σ_TV and ω.
"""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from app.synthesis.luminance import luminance
from app.synthesis.periodic import periodic_spectrum
from app.synthesis.spot import centre

Complex = NDArray[np.complex64]
Real = NDArray[np.float32]

CENTRE = 1024  # pixels of a side that are measured: more of a texture tells nothing new, and costs
FLAT = 1e-6  # of the crop's contrast: differences that are smaller on average are those of rounding


@dataclass(frozen=True)
class Structure:
    """What `structure_index` finds.

    Parameters
    ----------
    delta : float
        δ, at most 1: the share of total variation that is lacking. About 0 for a random phase texture.
    z : float
        The same difference in deviations of TV(ADSN(p)): the sharpness index before it is made a probability.
    mean : float
        μ, mean of TV(ADSN(p)), in the crop's values.
    total_variation : float
        TV(p).
    deviation : float
        σ_TV, deviation of TV(ADSN(p)).
    """

    delta: float
    z: float
    mean: float
    total_variation: float
    deviation: float


def structure_index(h: Real, sigma: float = 2.0) -> Structure:
    """Measure δ_σ and z of a crop; see the module.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
        Any range and size; finite.
    sigma : float
        Deviation of the Gaussian, in pixels; 0 does not smooth.

    Returns
    -------
    Structure
        All 0 if the crop is constant, or has no contrast left at this scale: a constant is its own random phase
        texture.

    Examples
    --------
    A step lacks most of the variation of its random phase textures, white noise lacks none.

    >>> import numpy as np
    >>> step = np.zeros((128, 128), np.float32)
    >>> step[32:96, 32:96] = 1
    >>> noise = np.random.default_rng(0).normal(size=(128, 128)).astype(np.float32)
    >>> round(structure_index(step).delta, 1), abs(round(structure_index(noise).delta, 1))
    (0.7, 0.0)
    """
    grey = luminance(h)
    grey = grey - grey[0, 0]  # exact, and exactly 0 for a constant
    height, width = grey.shape
    spectrum = periodic_spectrum(grey)
    spectrum *= np.exp(-((sigma * _frequencies(height, width)) ** 2).sum(0) / 2).astype(np.float32)
    p: Real = scipy.fft.irfft2(spectrum, s=(height, width))
    down, across = np.roll(p, -1, 0) - p, np.roll(p, -1, 1) - p
    norms = [sqrt(np.square(each, dtype=np.float64).sum()) for each in (down, across)]
    mean = sum(norms) * sqrt(2 / pi * p.size)
    if mean <= FLAT * p.size * float(np.abs(grey).max()):
        return Structure(0.0, 0.0, 0.0, 0.0, 0.0)
    variation = float(np.abs(down).sum(dtype=np.float64) + np.abs(across).sum(dtype=np.float64))
    deviation = _deviation(spectrum, (height, width), norms)
    return Structure((mean - variation) / mean, (mean - variation) / deviation, mean, variation, deviation)


def structure_of(h: Real, sigma: float = 2.0) -> Structure:
    """`structure_index` of a crop, or of the centre 1024 × 1024 pixels of one that is larger.

    Parameters
    ----------
    h, sigma
        As there. An axis of at most 1024 pixels is measured whole.
    """
    return structure_index(centre(h, CENTRE, CENTRE), sigma)


def _frequencies(height: int, width: int) -> NDArray[np.float64]:
    """Angular frequencies of the half spectrum, down and across, shape (2, height, width // 2 + 1)."""
    down, across = 2 * np.pi * np.fft.fftfreq(height), 2 * np.pi * np.fft.rfftfreq(width)
    return np.stack(np.meshgrid(down, across, indexing="ij"))


def _deviation(spectrum: Complex, size: tuple[int, int], norms: list[float]) -> float:
    """σ_TV from p̂ on the half spectrum and the norms of p's differences down and across."""
    steps = (np.exp(1j * _frequencies(*size)) - 1).astype(np.complex64)
    power = np.square(spectrum.real) + np.square(spectrum.imag)
    total = 0.0
    for first, second, times in ((0, 0, 1), (0, 1, 2), (1, 1, 1)):
        scale = norms[first] * norms[second]
        if scale > 0:
            correlation = scipy.fft.irfft2(power * steps[first] * steps[second].conj(), s=size)
            total += times * scale * _omega(correlation / np.float32(scale))
    return sqrt(2 / pi * total)


def _omega(t: Real) -> float:
    """Sum of ω(t), in a form that does not cancel for small t."""
    t = t.clip(-1, 1)
    square = t * t
    values = t * np.arcsin(t) - square / (1 + np.sqrt(1 - square))
    return float(values.sum(dtype=np.float64))

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

from .arrays import Complex, Real
from .fourier.periodic import periodic_spectrum
from .fourier.spot import centre
from .luminance import luminance

SIGMA = 2.0  # pixels; the scale at which δ tells best, see benchmarks/README.md
LEAST = 32  # pixels of a side; at 32 δ is right three times out of four (benchmarks/README.md), below it is noise
CENTRE = 1024  # pixels of a side that are measured: more of a texture costs time and changes nothing
CACHED = 1 << 15  # values worked on at a time
FLAT = 1e-6  # of the crop's contrast: average differences below this are rounding errors


@dataclass(frozen=True)
class Structure:
    """Result of `structure_index`.

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


def structure_index(h: Real, sigma: float = SIGMA) -> Structure:
    """Measure the structure index δ_σ of a crop, and z; the module has the formulas.

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
        texture. The numbers are those of the formulas at any size; whether they mean anything, `is_too_small` says.

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
    found = _Variation(h, sigma)
    if found.flat:
        return Structure(0.0, 0.0, 0.0, 0.0, 0.0)
    deviation, lacking = found.deviation(), found.mean - found.total
    return Structure(lacking / found.mean, lacking / deviation, found.mean, found.total, deviation)


def is_too_small(height: int, width: int) -> bool:
    """Tell whether a crop is too small for its δ to mean anything: whether a side has less than 32 pixels.

    Examples
    --------
    >>> is_too_small(1, 1), is_too_small(31, 500), is_too_small(32, 32)
    (True, True, False)
    """
    return min(height, width) < LEAST


def measure_delta(h: Real, sigma: float = SIGMA) -> float | None:
    """Measure only δ_σ, of the central 1024 × 1024 pixels of a larger crop; a third of the work of `structure_index`.

    Parameters
    ----------
    h, sigma
        As of `structure_index`. An axis of at most 1024 pixels is measured whole.

    Returns
    -------
    float or None
        None for a crop that is `is_too_small`.
    """
    if is_too_small(h.shape[0], h.shape[1]):
        return None
    found = _Variation(centre(h, CENTRE, CENTRE), sigma)
    return 0.0 if found.flat else (found.mean - found.total) / found.mean


class _Variation:
    """TV(p) and μ of a crop, and what σ_TV takes besides."""

    def __init__(self, h: Real, sigma: float) -> None:
        grey = luminance(h)
        grey = grey - grey[0, 0]  # exact, and exactly 0 for a constant
        height, width = self._size = grey.shape[0], grey.shape[1]
        self._down, self._across = 2 * np.pi * np.fft.fftfreq(height), 2 * np.pi * np.fft.rfftfreq(width)
        spectrum = periodic_spectrum(grey)
        for frequencies in (self._down[:, None], self._across):
            spectrum *= np.exp(-((sigma * frequencies) ** 2) / 2).astype(np.float32)
        self._spectrum: Complex = spectrum
        p: Real = scipy.fft.irfft2(spectrum, s=self._size)
        self._norms, self.total = [], 0.0
        for axis in (0, 1):
            difference = np.roll(p, -1, axis) - p
            self._norms.append(sqrt(np.square(difference).sum(dtype=np.float64)))
            self.total += float(np.abs(difference, out=difference).sum(dtype=np.float64))
        self.mean = sum(self._norms) * sqrt(2 / pi * p.size)
        self.flat = self.mean <= FLAT * p.size * float(np.abs(grey).max())

    def deviation(self) -> float:
        """σ_TV."""
        power = np.square(self._spectrum.real) + np.square(self._spectrum.imag)
        steps = [(np.exp(1j * each) - 1).astype(np.complex64) for each in (self._down[:, None], self._across)]
        total = 0.0
        for first, second, times in ((0, 0, 1), (0, 1, 2), (1, 1, 1)):
            scale = self._norms[first] * self._norms[second]
            if scale > 0:
                product = power * (steps[first] * steps[second].conj() / np.float32(scale))
                total += times * scale * _omega(scipy.fft.irfft2(product, s=self._size, overwrite_x=True))
        return sqrt(2 / pi * total)


def _omega(correlations: Real) -> float:
    """Sum of ω, in a form that does not cancel where t is small, and by rows that stay in the cache."""
    total = 0.0
    for rows in np.array_split(correlations, -(-correlations.size // CACHED)):
        t = rows.clip(-1, 1)
        square = t * t
        total += float((t * np.arcsin(t) - square / (1 + np.sqrt(1 - square))).sum(dtype=np.float64))
    return total

"""Mixtures of Gaussian textures: barycentres of ADSN models for the optimal transport distance.

At every frequency the model of a spot f is Gaussian of covariance f̂ f̂* over the channels (f̂ a column, * the conjugate
transpose). Two of them are coupled in the best way by one and the same noise, once the second spot is turned by the
phase u = (f̂₁* f̂₀) / |f̂₁* f̂₀|, so that the geodesic between them consists of the models of

    f̂_ρ = (1 − ρ) f̂₀ + ρ u f̂₁,

their distance is W² = ‖f̂₀‖² + ‖f̂₁‖² − 2 |f̂₁* f̂₀|, and, with the same noise throughout, the textures along the geodesic
are averages, pixel by pixel, of those at its ends.

For N spots of weights w the barycentre is a fixed point of

    f̂ = Σ wᵢ uᵢ f̂ᵢ,   uᵢ = (f̂ᵢ* f̂) / |f̂ᵢ* f̂|,

that is, phases that make ‖Σ wᵢ uᵢ f̂ᵢ‖ greatest. This keeps to models of a spot: one random phase for all channels.
For three samples nothing is lost by it. The best correlations K of their noises, Hermitian with a diagonal of ones,
make a linear function, Σ wᵢ wⱼ (f̂ᵢ* f̂ⱼ) Kᵢⱼ, greatest, so some best K is an extreme point; those have ranks r with
r² ≤ N, so r = 1, which is one noise for all (but for the four frequencies at most where all is real). For four samples
it is a restriction.

The phases are unique up to a common one: here the first sample's is kept, u₁ = 1.

References
----------
Xia, Ferradans, Peyré, Aujol, "Synthesizing and Mixing Stationary Gaussian Texture Models", SIIMS 2014.
"""

from collections.abc import Iterator, Sequence

import numpy as np
import scipy.fft

from ..arrays import Complex, Progress, Real, ignore_progress
from ..fourier.field import Noise, NoiseField
from ..fourier.spectral import column_blocks
from ..fourier.spot import Profile
from ..parallel import Team, row_blocks
from ..sinks import Sink, array_sink
from .adsn import white_noise

SEARCH, SWEEPS = 5, 12  # over the phases: from every start, and then from the best one
TINY = np.complex64(1e-30)  # far below any product of spectra but 0, and gives that a phase

Inner = dict[tuple[int, int], Complex]  # wᵢ wⱼ (f̂ᵢ* f̂ⱼ) of every pair i ≠ j


class Mixture:
    """Samples as textures of one noise, their phases turned so that averages of them are barycentres.

    Parameters
    ----------
    samples : sequence of ndarray of float32, each (H, W, C)
        Two or more; sizes may differ, channels may not.
    weights : sequence of float
        Not negative, of sum 1. The phases of three samples and more depend on them, those of two do not.
    noise : Noise
    team : Team
    progress : callable ``(stage, part)``
        Called in the calling thread between blocks; may raise.

    Raises
    ------
    ValueError
        If samples differ in channels or hold values that are not finite.
    """

    def __init__(
        self, samples: Sequence[Real], weights: Sequence[float], noise: Noise, team: Team, progress: Progress
    ) -> None:
        if len({sample.shape[2] for sample in samples}) != 1:
            raise ValueError("The samples differ in their number of channels.")
        self._noise, self._team, self._progress = noise, team, progress
        fields = [
            NoiseField(sample, noise, team, _share(progress, number, len(samples)))
            for number, sample in enumerate(samples)
        ]
        self._means = [field.mean for field in fields]
        self._columns = [field.buffer() for field in fields]

        def transform(block: tuple[int, int]) -> None:
            random = fields[0].random(block)
            spectra = [np.stack(list(field.spectra(block, random))) for field in fields]
            for spectrum, turn in zip(spectra[1:], align(spectra, weights), strict=True):
                np.multiply(spectrum, turn, out=spectrum)
            for columns, spectrum in zip(self._columns, spectra, strict=True):
                columns[:, :, slice(*block)] = scipy.fft.ifft(spectrum, axis=1, overwrite_x=True, workers=1)

        team.run(transform, column_blocks(noise.width), lambda part: progress("random phase", part))

    def emit(self, weights: Sequence[float], sink: Sink, stage: str = "texture") -> None:
        """Hand the rows of Σ wᵢ Xᵢ to a sink, as `NoiseField.emit` does; any number of times.

        Parameters
        ----------
        weights : sequence of float
            Not negative, of sum 1.
        sink : callable ``(first row, planes)``
        stage : str
            Name of this pass in the progress.
        """

        def transform(rows: tuple[int, int]) -> None:
            sink(rows[0], self._planes(weights, *rows))

        self._team.run(transform, row_blocks(self._noise.height), lambda part: self._progress(stage, part))

    def _planes(self, weights: Sequence[float], begin: int, end: int) -> Iterator[Real]:
        used = [index for index, weight in enumerate(weights) if weight]
        for channel in range(len(self._means[0])):
            # A weight of 1 leaves every bit as it is: an end of a path is its sample's own texture.
            rows = np.float32(weights[used[0]]) * self._columns[used[0]][channel, begin:end]
            mean = weights[used[0]] * self._means[used[0]][channel]
            for index in used[1:]:
                rows += np.float32(weights[index]) * self._columns[index][channel, begin:end]
                mean += weights[index] * self._means[index][channel]
            plane: Real = scipy.fft.irfft(rows, n=self._noise.width, overwrite_x=True, workers=1)
            plane += np.float32(mean)
            yield plane


def _share(progress: Progress, number: int, count: int) -> Progress:
    """Progress of one of ``count`` equal parts of a stage."""
    return lambda stage, part: progress(stage, (number + part) / count)


def _phase(values: Complex) -> Complex:
    """A complex number over its modulus, and 1 for 0."""
    turns = values + TINY
    turns *= np.reciprocal(np.abs(turns))  # numpy divides complex numbers ten times slower than it multiplies them
    return turns


def align(spectra: Sequence[Complex], weights: Sequence[float]) -> list[Complex]:
    """Find the phases uᵢ that turn spots into one another as closely as possible.

    Every uᵢ in turn is set to the best for the others, the phase of Σⱼ wⱼ (f̂ᵢ* f̂ⱼ) uⱼ over j ≠ i, from each sample's
    own alignment as a start, and the best is gone on with. One start alone ends in a lesser maximum at four
    frequencies out of a thousand for four random spots, and at none for three.

    Parameters
    ----------
    spectra : sequence of ndarray of complex64, each (C, …)
    weights : sequence of float

    Returns
    -------
    list of ndarray of complex64, each (…)
        Phases of the second spot and of those after it; the first one's is 1.

    Examples
    --------
    >>> import numpy as np
    >>> spots = [np.array([[z]], np.complex64) for z in (1, 2j, -3)]
    >>> bool(np.allclose(align(spots, [1 / 3] * 3), [[-1j], [-1]]))
    True
    """
    count = len(spectra)
    inner = {(i, j): (spectra[i].conj() * spectra[j]).sum(axis=0) for i in range(count) for j in range(i)}
    if count == 2:
        return [_phase(inner[1, 0])]
    for i, j in list(inner):
        inner[i, j] *= np.float32(weights[i] * weights[j])
        inner[j, i] = inner[i, j].conj()
    best: list[Complex] = []
    greatest = np.full(spectra[0].shape[1:], -np.inf, np.float32)
    for start in range(count):
        turns = [np.ones_like(spectra[0][0]) if i == start else _phase(inner[i, start]) for i in range(count)]
        _sweep(inner, turns, SEARCH)
        value = sum((turns[i].conj() * _sum_of(inner, turns, i)).real for i in range(count))
        better = value > greatest
        greatest = np.where(better, value, greatest)
        best = [np.where(better, new, old) for new, old in zip(turns, best or turns, strict=True)]
    _sweep(inner, best, SWEEPS)
    return [turn * best[0].conj() for turn in best[1:]]


def _sweep(inner: Inner, turns: list[Complex], times: int) -> None:
    """Set every phase in turn to the best for the others."""
    for _ in range(times):
        for i in range(len(turns)):
            turns[i] = _phase(_sum_of(inner, turns, i))


def _sum_of(inner: Inner, turns: Sequence[Complex], i: int) -> Complex:
    """Σ of wᵢ wⱼ (f̂ᵢ* f̂ⱼ) uⱼ over j ≠ i."""
    total: Complex = sum(inner[i, j] * turn for j, turn in enumerate(turns) if j != i)  # type: ignore[assignment]
    return total


def mix(
    samples: Sequence[Real],
    weights: Sequence[float] | None = None,
    height: int | None = None,
    width: int | None = None,
    *,
    seed: int = 0,
    alpha: float = 0.1,
    window: Profile = "bump",
    threads: int = 1,
    progress: Progress | None = None,
) -> Real:
    """Synthesize a Gaussian texture whose model is the barycentre of the models of several samples.

    Parameters
    ----------
    samples : sequence of ndarray of float32, each (H, W, C)
        Two or more; sizes may differ, channels may not. Each one's periodic component is extended, or its centre
        taken, to the texture's size.
    weights : sequence of float, optional
        Not negative, with a positive sum, by which they are divided; default: equal. For two samples (1 − ρ, ρ).
    height, width : int, optional
        Size of the texture; default: the first sample's.
    seed : int
        Not negative. The noise is that of `microtexture.gaussian.adsn.adsn` at the same seed.
    alpha, window
        The spot's transition, see `microtexture.fourier.spot.window`.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between blocks; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (height, width, C)
        Periodic; its mean is the average of the means.

    Raises
    ------
    ValueError
        If samples differ in channels or hold values that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> black, white = np.zeros((8, 9, 1), np.float32), np.full((7, 8, 1), 4, np.float32)
    >>> bool(np.allclose(mix([black, white], [1, 3]), 3))
    True
    """
    height, width = height or samples[0].shape[0], width or samples[0].shape[1]
    shares = np.asarray(weights or [1] * len(samples), float)
    shares /= shares.sum()
    texture = np.empty((height, width, samples[0].shape[2]), np.float32)
    noise = Noise(white_noise, height, width, seed=seed, alpha=alpha, window=window)
    with Team(threads) as team:
        mixture = Mixture(samples, list(shares), noise, team, progress or ignore_progress)
        mixture.emit(list(shares), array_sink(texture))
    return texture

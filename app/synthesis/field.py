"""The engine of RPN and ADSN: from a sample to rows of a texture, by blocks that stay in the processor's cache.

Three passes over blocks, each shared out over the threads of a `Team`:

1. rows of the spot → real transforms along x (rows outside the spot are zero and are never transformed);
2. columns → transform along y, minus the smooth component (same size), times the random spectrum, inverse transform along y;
3. rows → inverse real transform along x, plus the mean, handed to a sink.

Every block of columns has its own stream of random numbers, so the result does not depend on the number of threads.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from app.synthesis.periodic import SmoothSpectrum, periodic_component
from app.synthesis.spectral import column_blocks, random_block
from app.synthesis.spot import Profile, Spot, centre, spot_of
from app.synthesis.team import Team

ROWS = 64  # rows of a block

Complex = NDArray[np.complex64]
Real = NDArray[np.float32]
Progress = Callable[[str, float], None]
Sink = Callable[[int, Real], None]


@dataclass(frozen=True)
class Noise:
    """What to make of a sample.

    Parameters
    ----------
    height, width : int
        Size of the texture in pixels.
    seed : int
        Not negative.
    rayleigh : bool
        ADSN if true, RPN if false.
    phase : {"add", "replace"}
        Add the random phase to every channel's own, or replace them all by it (the article's "wrong RPN").
    alpha : float
        Width of the spot's transition, 0–0.5 of the sample.
    window : {"bump", "gaussian"}
        Its profile.
    add_smooth : bool
        Add the smooth component to the texture; same size only.
    """

    height: int
    width: int
    seed: int = 0
    rayleigh: bool = False
    phase: Literal["add", "replace"] = "add"
    alpha: float = 0.1
    window: Profile = "bump"
    add_smooth: bool = False


def channel_means(h: Real) -> NDArray[np.float64]:
    """Mean of every channel of an image (H, W, C), summed in double precision."""
    sums: NDArray[np.float64] = h.sum(axis=0, dtype=np.float64).sum(axis=0) / (h.shape[0] * h.shape[1])
    return sums


def row_blocks(height: int) -> list[tuple[int, int]]:
    """First and last-plus-one row of every block."""
    return [(first, min(first + ROWS, height)) for first in range(0, height, ROWS)]


class Field:
    """A noise whose columns are done: `emit` gives its rows, any number of times.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
        The sample; along an axis that is longer than the texture's, its centre is taken.
    noise : Noise
    team : Team
    progress : callable ``(stage, part)``
        Called in the calling thread between blocks with the part of the stage that is done; may raise.

    Raises
    ------
    ValueError
        If the sample holds values that are not finite, or ``add_smooth`` is asked for at another size.
    """

    def __init__(self, h: Real, noise: Noise, team: Team, threads: int, progress: Progress) -> None:
        self.noise = noise
        self._team = team
        self._progress = progress
        h = centre(h, noise.height, noise.width)
        if not np.isfinite(h).all():
            raise ValueError("The sample holds values that are not finite.")
        self.mean = channel_means(h)
        self._smooth: SmoothSpectrum | None = None
        progress("spot", 0)
        if h.shape[:2] == (noise.height, noise.width):
            self._smooth = SmoothSpectrum(h)
            spot = Spot(h - self.mean.astype(np.float32), self.mean, noise.height, noise.width)
        elif noise.add_smooth:
            raise ValueError("The smooth component can be added only to a texture of the sample's own size.")
        else:
            p = periodic_component(h, threads)
            spot = spot_of(p, self.mean, noise.height, noise.width, noise.alpha, noise.window)
        self._spot = spot
        self._blocks: list[Complex] = self._transform_rows()

    def _transform_rows(self) -> list[Complex]:
        spot, channels = self._spot, len(self.mean)
        high, wide = spot.values.shape[:2]
        spectra = [np.empty((channels, high, last - first), np.complex64) for first, last in column_blocks(spot.width)]

        def transform(rows: tuple[int, int]) -> None:
            begin, end = rows
            padded = np.zeros((channels, end - begin, spot.width), np.float32)
            padded[:, :, spot.left : spot.left + wide] = spot.values[begin:end].transpose(2, 0, 1)
            rows_spectrum = scipy.fft.rfft(padded, workers=1)
            for (first, last), target in zip(column_blocks(spot.width), spectra, strict=True):
                target[:, begin:end] = rows_spectrum[:, :, first:last]

        self._team.run(transform, row_blocks(high), lambda part: self._progress("spot", part))
        return spectra

    def _column_spectrum(self, index: int) -> Complex:
        """One block of columns of the noise's spectrum, without the mean."""
        noise, rows_spectrum = self.noise, self._blocks[index]
        channels, high, columns = rows_spectrum.shape
        first, last = column_blocks(noise.width)[index]
        if high == noise.height:
            spectrum = rows_spectrum
        else:
            spectrum = np.zeros((channels, noise.height, columns), np.complex64)
            spectrum[:, self._spot.top : self._spot.top + high] = rows_spectrum
        spectrum = scipy.fft.fft(spectrum, axis=1, overwrite_x=True, workers=1)
        smooth = self._smooth.block(first, last) if self._smooth else None
        if smooth is not None:
            spectrum -= smooth
        if noise.phase == "replace":
            spectrum = np.abs(spectrum).astype(np.complex64)
        spectrum *= random_block(noise.height, noise.width, (first, last), noise.seed, noise.rayleigh)
        if first == 0:
            spectrum[:, 0, 0] = 0
        if noise.add_smooth and smooth is not None:
            spectrum += smooth
        return spectrum

    def randomise(self) -> "Field":
        """Do the columns; needed once before `emit`."""

        def transform(index: int) -> None:
            self._blocks[index] = scipy.fft.ifft(self._column_spectrum(index), axis=1, overwrite_x=True, workers=1)

        self._team.run(transform, range(len(self._blocks)), lambda part: self._progress("random phase", part))
        return self

    def power(self) -> Real:
        """Squared modulus of the noise's half spectrum, the mean over the channels, instead of `randomise`.

        Returns
        -------
        ndarray of float32, shape (height, width // 2 + 1)
        """
        power = np.empty((self.noise.height, self.noise.width // 2 + 1), np.float32)

        def measure(index: int) -> None:
            first, last = column_blocks(self.noise.width)[index]
            spectrum = self._column_spectrum(index)
            power[:, first:last] = (spectrum.real**2 + spectrum.imag**2).mean(axis=0)

        self._team.run(measure, range(len(self._blocks)), lambda part: self._progress("output spectrum", part))
        return power

    def emit(self, sink: Sink, stage: str = "texture") -> None:
        """Hand every row block to ``sink(first row, block)``, from the team's threads and in any order.

        The block is (C, rows, width) float32, the mean included; it belongs to the sink.
        """
        width, mean = self.noise.width, self.mean.astype(np.float32)[:, None, None]

        def transform(rows: tuple[int, int]) -> None:
            begin, end = rows
            block = np.concatenate([columns[:, begin:end] for columns in self._blocks], axis=2)
            values = scipy.fft.irfft(block, n=width, overwrite_x=True, workers=1)
            values += mean
            sink(begin, values)

        self._team.run(transform, row_blocks(self.noise.height), lambda part: self._progress(stage, part))


def synthesize(h: Real, noise: Noise, threads: int = 1, progress: Progress | None = None) -> Real:
    """The noise of a sample as one array of floats.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
    noise : Noise
    threads : int
    progress : callable ``(stage, part)``, optional

    Returns
    -------
    ndarray of float32, shape (noise.height, noise.width) or (noise.height, noise.width, C)
    """
    if h.ndim == 2:
        return synthesize(h[:, :, None], noise, threads, progress)[:, :, 0]
    texture = np.empty((noise.height, noise.width, h.shape[2]), np.float32)

    def store(first: int, block: Real) -> None:
        texture[first : first + block.shape[1]] = block.transpose(1, 2, 0)

    with Team(threads) as team:
        Field(h, noise, team, threads, progress or (lambda stage, part: None)).randomise().emit(store)
    return texture

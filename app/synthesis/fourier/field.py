"""Noise field: from a sample to rows of its RPN or ADSN, by blocks that stay in the processor's cache.

Three passes over blocks, each shared out over the threads of a `Team`:

1. rows of the spot → real transforms along x (rows outside the spot are zero and are never transformed);
2. columns → transform along y, minus the smooth component (same size), times the random spectrum, back along y;
3. rows → inverse real transform along x, plus the mean, handed to a sink.

Every block of columns has its own stream of random numbers, so the result does not depend on the number of threads.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypedDict

import numpy as np
import scipy.fft

from ..arrays import Complex, Progress, Real, ignore_progress
from ..parallel import Team, row_blocks
from ..sinks import Sink, array_sink
from .periodic import SmoothSpectrum, periodic_planes
from .spectral import Block, Draw, column_blocks, random_bits
from .spot import Profile, centre, make_spot


class NoiseOptions(TypedDict, total=False):
    """Keyword arguments that RPN and ADSN share; `microtexture.gaussian.rpn.rpn` describes them."""

    seed: int
    phase: Literal["add", "replace"]
    alpha: float
    window: Profile
    periodic: bool
    add_smooth: bool


@dataclass(frozen=True)
class Noise:
    """Parameters of a noise: what is drawn, for a texture of what size, and the `NoiseOptions` with their defaults."""

    draw: Draw
    height: int
    width: int
    seed: int = 0
    phase: Literal["add", "replace"] = "add"
    alpha: float = 0.1
    window: Profile = "bump"
    periodic: bool = True
    add_smooth: bool = False


class NoiseField:
    """A noise of a sample, prepared up to its last transform: `emit` hands on its rows, any number of times.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
        The sample; along an axis that is longer than the texture's, its centre is taken.
    noise : Noise
    team : Team
        The threads that work.
    progress : callable ``(stage, part)``, optional
        Called in the calling thread between blocks with the part of the stage that is done; what it raises stops the
        work.

    Attributes
    ----------
    mean : ndarray of float64, shape (C,)
        Mean of every channel, in the sample's values.

    Raises
    ------
    ValueError
        If the sample holds values that are not finite, or ``add_smooth`` is true for another size or without
        ``periodic``.
    """

    def __init__(self, h: Real, noise: Noise, team: Team, progress: Progress | None = None) -> None:
        if noise.add_smooth and not noise.periodic:
            raise ValueError("The smooth component can be added only where it was taken out before.")
        self.noise = noise
        self._team = team
        self._progress = progress or ignore_progress
        self._progress("spot", 0)
        self._grey = h.ndim == 2
        if self._grey:
            h = h[:, :, None]
        h = centre(h, noise.height, noise.width)
        height, width, channels = h.shape
        self._top = (noise.height - height) // 2
        self._smooth: SmoothSpectrum | None = None
        if (height, width) == (noise.height, noise.width):
            if noise.periodic:
                self._smooth = SmoothSpectrum(h)
            # What is subtracted first need only be near the mean: the transforms give the rest of the mean.
            near = h[::8, ::8].mean(axis=(0, 1), dtype=np.float64).astype(np.float32)
            self._spectrum = self._transform_rows(h.transpose(2, 0, 1), near)
            self.mean = near + self._spectrum[:, :, 0].real.sum(axis=1, dtype=np.float64) / (height * width)
        elif noise.add_smooth:
            raise ValueError("The smooth component can be added only to a texture of the sample's own size.")
        else:
            p = periodic_planes(h, team.threads) if noise.periodic else h.transpose(2, 0, 1).copy()
            self.mean = p.mean(axis=(1, 2), dtype=np.float64)
            spot = make_spot(p, self.mean, noise.height, noise.width, noise.alpha, noise.window)
            self._spectrum = self._transform_rows(spot.planes, np.zeros(channels, np.float32))
        if not np.isfinite(self.mean).all():
            raise ValueError("The sample holds values that are not finite.")

    def _transform_rows(self, planes: Real, offsets: Real) -> Complex:
        """Transforms along x of planes − offsets, centred: (C, rows of the spot, width // 2 + 1)."""
        (channels, high, wide), width = planes.shape, self.noise.width
        left = (width - wide) // 2
        spectrum = np.empty((channels, high, width // 2 + 1), np.complex64)

        def transform(rows: tuple[int, int]) -> None:
            begin, end = rows
            padded = np.zeros((end - begin, width), np.float32)
            for channel, offset in enumerate(offsets):
                np.subtract(planes[channel, begin:end], offset, out=padded[:, left : left + wide])
                spectrum[channel, begin:end] = scipy.fft.rfft(padded, workers=1)

        self._team.run(transform, row_blocks(high), lambda part: self._progress("spot", part))
        return spectrum

    def random(self, block: Block) -> Complex:
        """Draw one block of columns of the random spectrum."""
        noise = self.noise
        return noise.draw(noise.height, noise.width, block, random_bits(noise.seed, block))

    def spectra(self, block: Block, random: Complex) -> Iterator[Complex]:
        """Compute one block of columns of the noise's spectrum, without the mean, one channel after the other.

        To be called before `randomise`, which overwrites what it needs.

        Parameters
        ----------
        block : tuple of int
            One of `column_blocks`.
        random : ndarray of complex64, shape (height, columns)
            That block of the random spectrum.

        Yields
        ------
        ndarray of complex64, shape (height, columns)
        """
        noise, (first, last) = self.noise, block
        smooths = self._smooth.block(first, last) if self._smooth else None
        for rows in self._spectrum[:, :, first:last]:
            spectrum: Complex
            if len(rows) == noise.height:
                spectrum = scipy.fft.fft(rows, axis=0, workers=1)
            else:
                padded = np.zeros((noise.height, last - first), np.complex64)
                padded[self._top : self._top + len(rows)] = rows
                spectrum = scipy.fft.fft(padded, axis=0, overwrite_x=True, workers=1)
            if smooths is not None:
                smooth = next(smooths)
                spectrum -= smooth
            if noise.phase == "replace":
                spectrum[:] = np.abs(spectrum)
            spectrum *= random
            if first == 0:
                spectrum[0, 0] = 0
            if noise.add_smooth:
                spectrum += smooth
            yield spectrum

    def buffer(self) -> Complex:
        """Return an array for transformed columns, (C, height, width // 2 + 1): the field's own if large enough."""
        if self._spectrum.shape[1] == self.noise.height:
            return self._spectrum
        return np.empty((len(self.mean), self.noise.height, self.noise.width // 2 + 1), np.complex64)

    def randomise(self) -> "NoiseField":
        """Transform the columns with the random spectrum; once, before `emit`."""
        noise, done = self.noise, self.buffer()

        def transform(block: Block) -> None:
            columns = slice(*block)
            for plane, spectrum in zip(done, self.spectra(block, self.random(block)), strict=True):
                plane[:, columns] = scipy.fft.ifft(spectrum, axis=0, overwrite_x=True, workers=1)

        self._team.run(transform, column_blocks(noise.width), lambda part: self._progress("random phase", part))
        self._spectrum = done
        return self

    def power(self) -> Real:
        """Compute the squared modulus of the noise's half spectrum, the mean over the channels.

        To be called before `randomise`, which overwrites what it needs.

        Returns
        -------
        ndarray of float32, shape (height, width // 2 + 1)
        """
        noise = self.noise
        power = np.zeros((noise.height, noise.width // 2 + 1), np.float32)

        def measure(block: Block) -> None:
            columns = power[:, slice(*block)]
            for spectrum in self.spectra(block, self.random(block)):
                columns += spectrum.real**2 + spectrum.imag**2
            columns /= len(self.mean)

        self._team.run(measure, column_blocks(noise.width), lambda part: self._progress("output-spectrum", part))
        return power

    def emit(self, sink: Sink, stage: str = "texture") -> None:
        """Hand every block of rows to a sink, from the team's threads and in any order; after `randomise`.

        Parameters
        ----------
        sink : callable ``(first row, planes)``
            The planes, one for each channel, are (rows, width) float32, the mean included; each is computed when the
            sink takes it, and belongs to the sink.
        stage : str
            Name of this pass in the progress.
        """

        def transform(rows: tuple[int, int]) -> None:
            sink(rows[0], self._planes(*rows))

        self._team.run(transform, row_blocks(self.noise.height), lambda part: self._progress(stage, part))

    def array(self) -> Real:
        """Compute the texture as one array: (height, width, C), or (height, width) for a sample of two axes."""
        texture = np.empty((self.noise.height, self.noise.width, len(self.mean)), np.float32)
        self.randomise().emit(array_sink(texture))
        return texture[:, :, 0] if self._grey else texture

    def _planes(self, begin: int, end: int) -> Iterator[Real]:
        for channel, mean in enumerate(self.mean.astype(np.float32)):
            plane: Real = scipy.fft.irfft(self._spectrum[channel, begin:end], n=self.noise.width, workers=1)
            plane += mean
            yield plane

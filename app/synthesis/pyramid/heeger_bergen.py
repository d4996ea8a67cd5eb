"""Heeger–Bergen pyramid-based synthesis: noise whose pixels and sub-bands take the sample's histograms.

In the principal axes of the sample's colours, each channel alone: white noise takes the histogram of the sample;
then, again and again, every band of its steerable pyramid takes the histogram of the sample's band, the pyramid is
put together, and the result takes the sample's histogram once more.

The sample's borders do not match, which the pyramid, periodic as it is, would take for edges. ``periodic`` gives it
the sample's periodic component. ``mirror`` gives it the sample with its mirror images beside it, and keeps of each
band the sample's own part, so that the mirror images' orientations are not counted.

References
----------
Heeger, Bergen, "Pyramid-Based Texture Analysis/Synthesis", SIGGRAPH 1995; Briand, Vacher, Galerne, Rabin, "The
Heeger-Bergen Pyramid-Based Texture Synthesis Algorithm", IPOL 2014.
"""

import math
from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np
from numpy.random import SFC64, Generator, SeedSequence

from ..arrays import Complex, Progress, Real, ignore_progress
from ..fourier.periodic import smooth_planes
from ..parallel import Team, Work
from .colour_space import ColourSpace
from .histogram import match, quantiles
from .pyramid import Band, SteerablePyramid, Total, to_image, to_spectrum

Edges = Literal["periodic", "mirror"]

FINEST = Band(0, None)
MOST = 1 << 20  # values of a band that are kept; of larger bands as many quantiles


@dataclass(frozen=True)
class Decomposition:
    """Decomposition of images into sub-bands.

    Parameters
    ----------
    scales, orientations : int
        Scales and orientations of the pyramid, each at least 1.
    edges : {"periodic", "mirror"}
        How the sample's borders are made to match: take its periodic component, or put its mirror images beside it.
    """

    scales: int = 4
    orientations: int = 4
    edges: Edges = "periodic"


class ChannelBands:
    """Sub-bands of one channel: a real steerable pyramid of an image, or of it with its mirror images beside it.

    Parameters
    ----------
    plane : ndarray of float32, shape (H, W)
    decomposition : Decomposition
    """

    def __init__(self, plane: Real, decomposition: Decomposition) -> None:
        self._mirror = decomposition.edges == "mirror"
        if self._mirror:
            height, width = plane.shape
            plane = np.pad(plane, ((0, height), (0, width)), mode="symmetric")
        height, width = plane.shape
        self._pyramid = SteerablePyramid(height, width, decomposition.scales, decomposition.orientations)
        self._spectrum = to_spectrum(plane)

    def band(self, band: Band) -> Real:
        """Compute a sub-band, of mirror images only the samples whose places lie within the image itself."""
        values = self._pyramid.filter(band).analyse(self._spectrum)
        height, width = values.shape
        return values[: (height + 1) // 2, : (width + 1) // 2] if self._mirror else values


class SampleStatistics:
    """Statistics of a sample: its colours, and the sorted values of its channels and of their bands.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
    decomposition : Decomposition
    pyramid : SteerablePyramid
        Pyramid of the texture: no more values are kept of a band than the texture's band has, or than `MOST`.
    work : Work
        Its stage ``"sample"``.

    Attributes
    ----------
    space : ColourSpace
    channels : ndarray of float32, shape (C, H, W)
        The principal components.
    """

    def __init__(self, h: Real, decomposition: Decomposition, pyramid: SteerablePyramid, work: Work) -> None:
        if not np.isfinite(h).all():
            raise ValueError("The sample holds values that are not finite.")
        planes = h.transpose(2, 0, 1).astype(np.float32, order="C")
        if decomposition.edges == "periodic":
            planes -= smooth_planes(h, work.threads)
        self.space = ColourSpace.from_planes(planes)
        self.channels = self.space.forward(planes)
        self.pixels = [_sorted(channel, math.prod(pyramid.shape(FINEST))) for channel in self.channels]
        self.bands: dict[tuple[int, Band], Real] = {}
        channel_bands = [ChannelBands(channel, decomposition) for channel in self.channels]

        def analyse(item: tuple[int, Band]) -> None:
            work.checkpoint()
            channel, band = item
            self.bands[item] = _sorted(channel_bands[channel].band(band), min(MOST, math.prod(pyramid.shape(band))))

        work.run("sample", analyse, list(product(range(len(planes)), pyramid.bands)))


class Synthesis:
    """Texture in the making: noise with the sample's histogram at first, then iteration by iteration.

    Parameters
    ----------
    sample : Sample
    pyramid : SteerablePyramid
        A pyramid of the texture's size.
    seed : int
        Not negative.
    work : Work
        Its stage ``"noise"``.
    """

    def __init__(self, sample: SampleStatistics, pyramid: SteerablePyramid, seed: int, work: Work) -> None:
        self._sample, self._pyramid, self._work = sample, pyramid, work
        self._planes: list[Real] = [np.empty(0, np.float32)] * len(sample.pixels)
        self._spectra: list[Complex] = [np.empty(0, np.complex64)] * len(sample.pixels)

        def begin(channel: int) -> None:
            noise = Generator(SFC64(SeedSequence(seed, spawn_key=(channel,))))
            self.restart(channel, noise.standard_normal(pyramid.shape(FINEST), np.float32))

        work.run("noise", begin, range(len(sample.pixels)))

    def iterate(self, stage: str) -> None:
        """Match all bands, and then the pixels, to the sample's histograms."""
        totals = [Total(self._pyramid) for _ in self._planes]

        def match_band(item: tuple[int, Band]) -> None:
            channel, band = item
            window = self._pyramid.filter(band)
            values = window.analyse(self._spectra[channel])
            self._work.checkpoint()
            match(values, self._sample.bands[item], self._work.checkpoint)
            part = window.synthesise(values)
            self._work.checkpoint()
            total = totals[channel].add(band, window, part)
            if total is not None:
                self.restart(channel, to_image(total, self._pyramid.shape(FINEST)))

        self._work.run(stage, match_band, list(product(range(len(self._planes)), self._pyramid.bands)))

    def restart(self, channel: int, plane: Real) -> None:
        """Replace a channel by a plane, matched in place to the sample's pixel histogram."""
        self._work.checkpoint()
        match(plane, self._sample.pixels[channel], self._work.checkpoint)
        self._planes[channel], self._spectra[channel] = plane, to_spectrum(plane)

    def channel(self, number: int) -> Real:
        """Return a principal component of the texture as it is now, shape (H, W)."""
        return self._planes[number]

    def planes(self, limit: int | None = None) -> Real:
        """Compute the texture as it is now in the sample's colours, (C, H, W), at most ``limit`` rows and columns."""
        return self._sample.space.back(np.stack([plane[:limit, :limit] for plane in self._planes]))

    def distances(self, stage: str, channel: int = 0) -> dict[Band, float]:
        """Measure how far a channel's sub-bands are from the sample's histograms.

        Parameters
        ----------
        stage : str
            Name of this pass in the progress.
        channel : int
            Number of the principal component.

        Returns
        -------
        dict of Band to float
            Root mean square difference of the quantiles (the Wasserstein distance), in deviations of the sample's
            band.
        """
        distances = dict.fromkeys(self._pyramid.bands, 0.0)

        def measure(band: Band) -> None:
            self._work.checkpoint()
            found = np.sort(self._pyramid.filter(band).analyse(self._spectra[channel]), axis=None)
            self._work.checkpoint()
            target = quantiles(self._sample.bands[channel, band], len(found))
            distances[band] = float(np.sqrt(np.square(found - target).mean())) / (float(target.std()) or 1)

        self._work.run(stage, measure, self._pyramid.bands)
        return distances


def _sorted(values: Real, count: int) -> Real:
    """Sort values; of more than ``count`` keep that many quantiles."""
    ordered = np.sort(values, axis=None)
    return quantiles(ordered, count) if count < len(ordered) else ordered


def heeger_bergen(
    h: Real,
    height: int | None = None,
    width: int | None = None,
    *,
    seed: int = 0,
    decomposition: Decomposition | None = None,
    iterations: int = 5,
    add_smooth: bool = False,
    threads: int = 1,
    progress: Progress = ignore_progress,
) -> Real:
    """Synthesize a texture of any size with the pixel and sub-band histograms of an image.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)
        The sample; any number of channels, any range, finite.
    height, width : int, optional
        Size of the texture; default: the sample's.
    seed : int
        Not negative; draws the noise at the start.
    decomposition : Decomposition, optional
        Default: four scales, four orientations, periodic edges.
    iterations : int
        0 or more; 0 returns the noise with the sample's pixel histogram.
    add_smooth : bool
        Add the smooth component back; for a texture of the sample's own size and periodic edges only.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between pieces of work; what it raises stops the work.

    Returns
    -------
    ndarray of float32, shape (height, width) or (height, width, C)
        Periodic. Each of its principal components has the sample's histogram exactly.

    Raises
    ------
    ValueError
        If values are not finite, or ``add_smooth`` is true for another size or mirrored edges.

    Examples
    --------
    >>> import numpy as np
    >>> h = np.random.default_rng(0).random((32, 40), np.float32)
    >>> z = heeger_bergen(h, 48, 50, seed=7)
    >>> z.shape, bool(abs(z.std() - h.std()) < 0.01)
    ((48, 50), True)
    """
    if h.ndim == 2:
        return heeger_bergen(
            h[:, :, None],
            height,
            width,
            seed=seed,
            decomposition=decomposition,
            iterations=iterations,
            add_smooth=add_smooth,
            threads=threads,
            progress=progress,
        )[:, :, 0]
    decomposition = decomposition or Decomposition()
    height, width = height or h.shape[0], width or h.shape[1]
    if add_smooth and (decomposition.edges != "periodic" or (height, width) != h.shape[:2]):
        raise ValueError("The smooth component needs periodic edges and a texture of the sample's own size.")
    pyramid = SteerablePyramid(height, width, decomposition.scales, decomposition.orientations)
    with Team(threads) as team:
        work = Work(team, progress)
        sample = SampleStatistics(h, decomposition, pyramid, work)
        synthesis = Synthesis(sample, pyramid, seed, work)
        for iteration in range(1, iterations + 1):
            synthesis.iterate(f"iteration {iteration}")
    planes = synthesis.planes()
    if add_smooth:
        planes += smooth_planes(h, threads)
    return planes.transpose(1, 2, 0)

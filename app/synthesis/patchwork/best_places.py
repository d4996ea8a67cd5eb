"""Patch matching by exhaustive or random search: the place of a texture that is nearest to a patch, for many patches.

It is not PatchMatch (Barnes et al. 2009), which finds approximate places by propagation: here every candidate is
compared exactly, and with ``candidates=0`` every place of the texture is one.

The patch of a pattern P is a rectangle about its centre p. At a place q of the texture I it differs by

    d(q) = Σ_x |P(x) − I(x − p + q)|² = Σ |P|² + Σ |I|² − 2 Σ P · I,

the sums over the rectangle and the channels. The second one is a difference of sums that are known beforehand. The
third one is a scalar product for each of a few candidates q, and a correlation for all places at once: that is computed
in the Fourier domain, by tiles that overlap.

Values are compared in whole sixteenths of an 8-bit level. So all sums are whole numbers, which double precision adds
up exactly in whatever order: a distance does not depend on how it was computed, nor on the number of threads.

References
----------
Harrison, "Patchwork texture synthesis", technical report, Monash University, 2002, section 5.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.random import SFC64, Generator, SeedSequence
from numpy.typing import NDArray
from scipy import fft

from ..arrays import Double, Index, Real
from ..parallel import Work

STEPS = 16 * 255  # of the values' range
BLOCK = 16  # patches that share random numbers, and a task
GATHERED = 1 << 14  # values of the texture that are compared together: what stays in the cache
LEAST_TILE = 128
IN_TILES = 1 << 19  # pixels that are transformed together
STREAM = 2  # of the seed's; cells and their random sources have those before


@dataclass(frozen=True)
class PatternPatches:
    """Patches of a pattern, and the places of the texture that each may take.

    Parameters
    ----------
    centres : ndarray of int, shape (n, 2)
        Row and column of every patch's centre p in the pattern.
    boxes : ndarray of int, shape (n, 4)
        Every patch's top, bottom, left and right in the pattern, with bottom and right one past the last.
    first, last : ndarray of int, shape (n, 2)
        The places q of the texture, from ``first`` to ``last`` inclusive in rows and in columns, that the centre may
        take. The patch at each of them lies within the texture; the centre itself need not.
    """

    centres: Index
    boxes: Index
    first: Index
    last: Index

    def __len__(self) -> int:
        return len(self.centres)


@dataclass(frozen=True)
class Matches:
    """Best places of patches.

    Parameters
    ----------
    places : ndarray of int, shape (n, 2)
        Row and column of q.
    errors : ndarray of float64, shape (n,)
        Sum of squared differences there, over pixels and channels, in the values' own unit squared.
    sizes : ndarray of int, shape (n,)
        Pixels of the patch.
    """

    places: Index
    errors: Double
    sizes: Index


def best_matches(
    texture: Real, pattern: Real, patches: PatternPatches, *, peak: float, candidates: int, seed: int, work: Work
) -> Matches:
    """Find for every patch the candidate with the least sum of squared differences, the first one of several.

    Each patch has candidates of its own, drawn uniformly and independently. For one seed, the candidates of a smaller
    number are a subset of those of a larger one.

    Parameters
    ----------
    texture : ndarray of float32, shape (H', W', C)
    pattern : ndarray of float32, shape (H, W, C)
        Both with values of [0, ``peak``].
    patches : Patches
    peak : float
        Greatest value.
    candidates : int
        Number of places that are drawn for each patch; 0, or as many as there are or more, compares all.
    seed : int
        Not negative; draws the candidates.
    work : Work
        Its stage ``"matching"``.

    Returns
    -------
    Matches
    """
    search = _Search(_whole(texture, peak), _whole(pattern, peak), patches)
    extents = patches.last - patches.first + 1
    every = (extents.prod(1) <= candidates) | (candidates == 0)

    def match(first: int) -> None:
        block = np.arange(first, min(first + BLOCK, len(patches)))
        if not every[block].all():
            generator = Generator(SFC64(SeedSequence(seed, spawn_key=(STREAM, first))))
            numbers = generator.random((candidates, len(block), 2))
            for patch in block[~every[block]].tolist():
                places = patches.first[patch] + (numbers[:, patch - first] * extents[patch]).astype(np.intp)
                search.among(patch, places)
                work.checkpoint()
        for _ in search.everywhere(block[every[block]]):
            work.checkpoint()

    work.run("matching", match, range(0, len(patches), BLOCK))
    return Matches(search.places, search.errors * (peak / STEPS) ** 2, search.sizes)


def _whole(image: Real, peak: float) -> Double:
    """Round values to whole numbers of steps, about the middle of their range."""
    steps: Double = np.rint(image.astype(np.float64) * (STEPS / peak))
    return steps - STEPS // 2


class _Search:
    """Best place of each patch so far, and its distance in steps squared."""

    def __init__(self, texture: Double, pattern: Double, patches: PatternPatches) -> None:
        self._texture, self._pattern, self._patches = texture, pattern, patches
        # Sums of |I|² over all that is above and to the left.
        squares = np.square(texture).sum(2)
        self._above = np.pad(squares, ((1, 0), (1, 0))).cumsum(0).cumsum(1)
        boxes = patches.boxes
        self._shapes = boxes[:, 1::2] - boxes[:, ::2]
        self._tops = boxes[:, ::2] - patches.centres
        self.sizes: Index = self._shapes.prod(1)
        self.places = patches.first.copy()
        self.errors = np.full(len(patches), np.inf)

    def _patch(self, patch: int) -> Double:
        top, bottom, left, right = self._patches.boxes[patch]
        return self._pattern[top:bottom, left:right]

    def _offer(self, patch: int, place: Index, sum_: float) -> None:
        error = sum_ + float(np.square(self._patch(patch)).sum())
        if error < self.errors[patch]:
            self.errors[patch], self.places[patch] = error, place

    def among(self, patch: int, places: Index) -> None:
        """Compare a patch with some places (N, 2)."""
        height, width = self._shapes[patch]
        channels = self._texture.shape[2]
        y, x = (places + self._tops[patch]).T
        above = self._above
        sums = above[y + height, x + width] - above[y, x + width] - above[y + height, x] + above[y, x]
        flat = self._texture.reshape(len(self._texture), -1)
        windows = sliding_window_view(flat, (height, width * channels))[:, ::channels]
        factors = self._patch(patch).reshape(-1)
        step = max(1, GATHERED // factors.size)
        for begin in range(0, len(places), step):
            part = slice(begin, begin + step)
            sums[part] -= 2 * np.einsum("nk,k->n", windows[y[part], x[part]].reshape(-1, factors.size), factors)
        best = int(sums.argmin())
        self._offer(patch, places[best], float(sums[best]))

    def everywhere(self, chosen: Index) -> Iterator[None]:
        """Compare patches with all places that their centres may take."""
        if len(chosen):
            largest = self._shapes[chosen].max(0)
            tile = fft.next_fast_len(max(LEAST_TILE, 4 * int(largest.max())), real=True)
            together = max(1, IN_TILES // tile**2)
            for begin in range(0, len(chosen), together):
                yield from self._by_tiles(chosen[begin : begin + together], tile, tile - largest + 1)

    def _by_tiles(self, chosen: Index, tile: int, step: Index) -> Iterator[None]:
        # The upper left corners of the patches run over these places.
        first, last = (corner[chosen] + self._tops[chosen] for corner in (self._patches.first, self._patches.last))
        spectra = self._spectra(chosen, tile)
        for top in range(int(first[:, 0].min()), int(last[:, 0].max()) + 1, step[0]):
            for left in range(int(first[:, 1].min()), int(last[:, 1].max()) + 1, step[1]):
                products = self._correlations(spectra, top, left, tile)
                corner = np.array((top, left))
                begins, ends = np.maximum(first, corner), np.minimum(last, corner + step - 1) + 1
                for number in np.flatnonzero((begins < ends).all(1)):
                    patch, begin, end = int(chosen[number]), begins[number], ends[number]
                    sums = self._energies(begin, end, self._shapes[patch])
                    sums -= 2 * products[number, begin[0] - top : end[0] - top, begin[1] - left : end[1] - left]
                    best = np.array(np.unravel_index(sums.argmin(), sums.shape))
                    self._offer(patch, begin + best - self._tops[patch], float(sums[*best]))
                yield

    def _energies(self, begin: Index, end: Index, shape: Index) -> Double:
        """Compute Σ |I|² over rectangles of a shape with their upper left corners from ``begin`` to ``end`` − 1."""
        (top, left), (bottom, right), (height, width) = begin, end, shape
        rows, lower = slice(top, bottom), slice(top + height, bottom + height)
        columns, further = slice(left, right), slice(left + width, right + width)
        above = self._above
        energies: Double = above[lower, further] - above[rows, further]
        energies -= above[lower, columns]
        energies += above[rows, columns]
        return energies

    def _spectra(self, chosen: Index, tile: int) -> NDArray[np.complex128]:
        """Compute the conjugate spectra of patches, shape (C, patches, tile, tile // 2 + 1)."""
        planes = np.zeros((self._texture.shape[2], len(chosen), tile, tile))
        for number, patch in enumerate(chosen.tolist()):
            height, width = self._shapes[patch]
            planes[:, number, :height, :width] = self._patch(patch).transpose(2, 0, 1)
        spectra: NDArray[np.complex128] = fft.rfft2(planes)
        return np.conj(spectra, out=spectra)

    def _correlations(self, spectra: NDArray[np.complex128], top: int, left: int, tile: int) -> Double:
        """Compute Σ P · I for patches with their upper left corners everywhere in a tile, (patches, tile, tile)."""
        part = self._texture[top : top + tile, left : left + tile].transpose(2, 0, 1)
        of_part = fft.rfft2(part, (tile, tile))
        product = spectra[0] * of_part[0]
        for factor, other in zip(spectra[1:], of_part[1:], strict=True):
            product += factor * other
        sums: Double = fft.irfft2(product, (tile, tile), overwrite_x=True)
        return np.rint(sums, out=sums)

"""The place of a texture where a patch of any shape is matched best, for many patches at once.

The patch of a pattern P is a set of pixels around its centre p. At a place q of the texture I it differs by

    d(q) = Σ_x |P(x) − I(x − p + q)|² = Σ |P|² + Σ (|I|² − 2 P · I),

the sums over the patch and over the channels. Of a few candidates q the last sum is a scalar product of what is there
with (1, −2P); of all places at once it is a correlation, which is computed in the Fourier domain by overlapping tiles.

Values are compared in whole sixteenths of an 8-bit level. So all sums are whole numbers, which double precision adds
up exactly in whatever order: a distance does not depend on how it was computed, nor on the number of threads.

References
----------
Harrison, "Patchwork texture synthesis", technical report, Monash University, 2002, section 5.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from app.synthesis.work import Work

STEPS = 16 * 255  # of the values' range
BLOCK = 16  # patches that share random numbers, and a task
GATHERED = 1 << 15  # pixels of the texture at a time: what stays in the cache
LEAST_TILE = 128
STREAM = 5  # keeps the numbers apart from others that are drawn from the same seed

Real = NDArray[np.float32]
Double = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True)
class Patches:
    """What is to be matched, and where.

    Parameters
    ----------
    centres : ndarray of int, shape (n, 2)
        Row and column of every patch's centre p in the pattern.
    owners : ndarray of int, shape (H, W)
        The patch of each pixel of the pattern.
    first, last : ndarray of int, shape (n, 2)
        The places q of the texture, from ``first`` to ``last`` inclusive in rows and in columns, that the centre may
        take. The patch at each of them lies within the texture.
    """

    centres: Index
    owners: Index
    first: Index
    last: Index

    def __len__(self) -> int:
        return len(self.centres)


@dataclass(frozen=True)
class Matches:
    """The best places.

    ``places`` (n, 2) are rows and columns of q, ``errors`` (n,) the sums of squared differences there, in the values'
    own unit squared, and ``sizes`` (n,) the pixels of the patches.
    """

    places: Index
    errors: Double
    sizes: Index


def best_matches(
    texture: Real, pattern: Real, patches: Patches, *, peak: float, candidates: int, seed: int, work: Work
) -> Matches:
    """For every patch the candidate where the sum of squared differences is least, the first one of several.

    Each patch has candidates of its own, drawn uniformly and independently; from one seed, more of them include fewer.

    Parameters
    ----------
    texture : ndarray of float32, shape (H', W', C)
    pattern : ndarray of float32, shape (H, W, C)
        Both with values of [0, ``peak``].
    patches : Patches
    peak : float
    candidates : int
        How many places are drawn for each patch; 0, or as many as there are or more: all are compared.
    seed : int
    work : Work
        Its stage ``"matching"``.
    """
    search = _Search(_whole(texture, peak), _whole(pattern, peak), patches)
    extents = patches.last - patches.first + 1
    every = (extents.prod(1) <= candidates) | (candidates == 0)

    def match(block: slice) -> None:
        drawn = np.arange(len(patches))[block]
        if not every[drawn].all():
            generator = np.random.Generator(np.random.SFC64([seed, STREAM, block.start]))
            numbers = generator.random((candidates, len(drawn), 2))
            for column, patch in enumerate(drawn):
                if not every[patch]:
                    places = patches.first[patch] + (numbers[:, column] * extents[patch]).astype(np.intp)
                    search.among(patch, places)
                    work.alive()
        for _ in search.everywhere(drawn[every[drawn]]):
            work.alive()

    work.run("matching", match, [slice(begin, begin + BLOCK) for begin in range(0, len(patches), BLOCK)])
    return Matches(search.places, search.errors * (peak / STEPS) ** 2, search.sizes)


def _whole(image: Real, peak: float) -> Double:
    """Values as whole numbers of steps, about the middle of their range."""
    steps: Double = np.rint(image.astype(np.float64) * (STEPS / peak))
    return steps - STEPS // 2


class _Search:
    """Keeps, for each patch, the best place found and its distance in steps squared."""

    def __init__(self, texture: Double, pattern: Double, patches: Patches) -> None:
        self._patches = patches
        self._rows, self._columns = texture.shape[:2]
        squares = np.square(texture).sum(2, keepdims=True)
        # A pixel is C values and the sum of their squares, less the middle of what that can be: the transforms of small
        # numbers are more exact.
        self._offset = float(texture.shape[2] * (STEPS // 2) ** 2 // 2)
        self._texture = np.concatenate([texture, squares - self._offset], axis=2)
        self._factors = np.concatenate([-2 * pattern, np.ones((*pattern.shape[:2], 1))], axis=2)
        self._energies = np.bincount(patches.owners.ravel(), np.square(pattern).sum(2).ravel(), len(patches))
        self.sizes: Index = np.bincount(patches.owners.ravel(), minlength=len(patches)).astype(np.intp)
        self._order = np.argsort(patches.owners.ravel(), kind="stable")
        self._ends = np.cumsum(self.sizes)
        self.places = patches.first.copy()
        self.errors = np.full(len(patches), np.inf)

    def _pixels(self, patch: int) -> tuple[Index, Index, Double]:
        """Rows and columns of a patch relative to its centre, and the factors (K, C + 1) of its pixels."""
        end = self._ends[patch]
        y, x = np.divmod(self._order[end - self.sizes[patch] : end], self._patches.owners.shape[1])
        row, column = self._patches.centres[patch]
        return y - row, x - column, self._factors[y, x]

    def _offer(self, patch: int, place: Index | tuple[int, int], sum_: float) -> None:
        error = sum_ + self._energies[patch] + self._offset * self.sizes[patch]
        if error < self.errors[patch]:
            self.errors[patch], self.places[patch] = error, place

    def among(self, patch: int, places: Index) -> None:
        """Compare a patch with the given places (N, 2)."""
        y, x, factors = self._pixels(patch)
        pixels = y * self._columns + x
        corners = places[:, 0] * self._columns + places[:, 1]
        texture = self._texture.reshape(-1, self._texture.shape[2])
        step = max(1, GATHERED // max(1, len(pixels)))
        sums = np.empty(len(places))
        for begin in range(0, len(places), step):
            part = slice(begin, begin + step)
            found = texture.take(corners[part, None] + pixels, axis=0, mode="clip")
            np.einsum("nkc,kc->n", found, factors, out=sums[part])
        best = int(sums.argmin())
        self._offer(patch, places[best], sums[best])

    def everywhere(self, chosen: Index) -> Iterator[None]:
        """Compare patches with all places that their centres may take, tile by tile."""
        if not len(chosen):
            return
        shapes = [self._pixels(int(patch)) for patch in chosen]
        tops = np.array([[y.min(initial=0), x.min(initial=0)] for y, x, _ in shapes])
        bottoms = np.array([[y.max(initial=0), x.max(initial=0)] for y, x, _ in shapes])
        side = int((bottoms - tops).max()) + 1
        tile = fft.next_fast_len(max(LEAST_TILE, 4 * side), real=True)
        # The upper left corners of the boxes around the patches run over these places.
        first, last = self._patches.first[chosen] + tops, self._patches.last[chosen] + tops
        spectra = self._spectra(shapes, tops, tile)
        step = tile - side + 1
        for top in range(int(first[:, 0].min()), int(last[:, 0].max()) + 1, step):
            for left in range(int(first[:, 1].min()), int(last[:, 1].max()) + 1, step):
                part = np.moveaxis(self._texture[top : top + tile, left : left + tile], 2, 0)
                sums = self._correlations(spectra, part, tile)
                for number, patch in enumerate(chosen):
                    begin = np.maximum(first[number] - (top, left), 0)
                    end = np.minimum(last[number] - (top, left), step - 1) + 1
                    if (begin < end).all():
                        valid = sums[number, begin[0] : end[0], begin[1] : end[1]]
                        y, x = divmod(int(valid.argmin()), valid.shape[1])
                        place = np.array((top, left)) + begin + (y, x) - tops[number]
                        self._offer(int(patch), place, valid[y, x])
                yield

    def _spectra(self, shapes: list[tuple[Index, Index, Double]], tops: Index, tile: int) -> NDArray[np.complex128]:
        """Conjugate spectra of the factors, shape (C + 1, patches, tile, tile // 2 + 1)."""
        planes = np.zeros((self._texture.shape[2], len(shapes), tile, tile))
        for number, (y, x, factors) in enumerate(shapes):
            planes[:, number, y - tops[number, 0], x - tops[number, 1]] = factors.T
        spectra: NDArray[np.complex128] = fft.rfft2(planes)
        return np.conj(spectra, out=spectra)

    def _correlations(self, spectra: NDArray[np.complex128], part: Double, tile: int) -> Double:
        """Σ (|I|² − 2 P · I) for all patches at all places of a part of the texture, shape (patches, tile, tile)."""
        of_part = fft.rfft2(part, (tile, tile))
        product = spectra[0] * of_part[0]
        for factor, other in zip(spectra[1:], of_part[1:], strict=True):
            product += factor * other
        sums: Double = fft.irfft2(product, (tile, tile), overwrite_x=True)
        return np.rint(sums, out=sums)

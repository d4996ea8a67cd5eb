"""Window search: exact search of an image for the patches that are nearest to a patch known in part.

Over the known pixels K of a patch p the distance to a patch s of the sample is

    d(p, s) = Σ_{k ∈ K} G(k) (p(k) − s(k))² = Σ G p² − 2 Σ G p s + Σ G s²,

and the last two sums, for all patches of the sample at once, are a matrix product of (G p, G) on K with the matrix of
all (s, s²). Single precision loses digits in it where d is small against Σ G p². So the product only sifts: what its
rounding errors leave in doubt is measured again, in double precision and without cancellation, and what is chosen
depends on those distances alone, not on how the product was computed or shared out.

References
----------
Efros, Leung, "Texture Synthesis by Non-parametric Sampling", ICCV 1999; Higham, "Accuracy and Stability of Numerical
Algorithms", 2002, section 3.1, for the bound on the errors of a scalar product.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ..arrays import Double, Index, Mask, PartDone, Real
from ..elementary import exp
from ..parallel import Team

PRODUCT = 1 << 18  # multiplications in one of them, few enough for BLAS to stay in the calling thread
BATCH = 1 << 29  # multiplications for a batch of patches: a tenth of a second or two
DISTANCES = 1 << 23  # in a batch, 32 MB
PAIRS = 4096  # patches measured in double precision at a time
OUTSIDE = 1e30  # stands for s² beyond the image: a patch that is known there is far from any
UNIT = 2.0**-24  # unit roundoff of single precision


def gaussian_window(half_patch: int) -> Double:
    """Compute the Gaussian weights of a square window, of sum 1 and of Efros and Leung's deviation, its side / 6.4.

    Parameters
    ----------
    half_patch : int
        n ≥ 1; the window has 2n + 1 pixels a side.

    Returns
    -------
    ndarray of float64, shape (2n + 1, 2n + 1)

    Examples
    --------
    >>> g = gaussian_window(4)
    >>> g.shape, round(float(g[4, 4] / g[4, 0]), 2), round(float(g.sum()), 12)
    ((9, 9), 57.14, 1.0)
    """
    side = 2 * half_patch + 1
    profile = exp(-0.5 * (np.arange(-half_patch, half_patch + 1) * 6.4 / side) ** 2)
    profile /= profile.sum()
    window: Double = np.outer(profile, profile)
    return window


class WindowSearch:
    """All patches of an image, laid out to be searched again and again.

    There is one around every pixel. Around those near the border it reaches beyond the image, and is compared only
    where what is known lies inside. Patches that are equal are searched once and count as often as they occur.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
        Finite; neither side shorter than 2n + 1, so that some patch can always be compared.
    half_patch : int
        n ≥ 1: patches have 2n + 1 pixels a side.
    team : Team
        Computes the products; the result does not depend on its threads.
    progress : callable ``(part)``
        Called while the patches are laid out; what it raises stops that.
    """

    def __init__(self, h: Real, half_patch: int, team: Team, progress: PartDone) -> None:
        side, channels = 2 * half_patch + 1, h.shape[2]
        self._team = team
        self._weights = gaussian_window(half_patch).ravel()
        frame = ((half_patch, half_patch), (half_patch, half_patch), (0, 0))
        self._patches = _patches(np.pad(h, frame), side)
        self._columns = h.shape[1]
        self._centre = h.mean((0, 1), dtype=np.float64)
        rows = _patches(np.pad(h, frame, constant_values=np.nan), side).reshape(-1, side * side * channels)
        progress(0.0)
        classes, self._first = _equal_rows(rows)
        self._members = np.argsort(classes, kind="stable")
        self._counts = np.bincount(classes)
        self._starts = np.cumsum(self._counts) - self._counts
        self._tiles = self._tiled(rows, progress)
        # Of a product of this many terms, and of the roundings of its factors and of what it is compared with.
        self._error = 1.01 * UNIT * (self._tiles.shape[1] + 16)

    def _tiled(self, rows: Real, progress: PartDone) -> Real:
        """Lay out the distinct patches, (s, s²) with s centred, or (0, `OUTSIDE`): (tiles, terms, size of a tile)."""
        pixels, channels = len(self._weights), len(self._centre)
        terms = pixels * (channels + 1)
        size = 32 if terms <= 1024 else 16  # of a tile; what was fastest
        tiles = np.zeros((-(-len(self) // size), terms, size), np.float32)
        for number, tile in enumerate(tiles):
            if number % 128 == 0:
                progress(number / len(tiles))
            members = self._first[number * size : (number + 1) * size]
            s = rows[members].reshape(-1, pixels, channels) - self._centre
            squares = np.square(s).sum(2)
            tile[: pixels * channels, : len(members)] = np.nan_to_num(s).reshape(len(members), -1).T
            tile[pixels * channels :, : len(members)] = np.nan_to_num(squares, nan=OUTSIDE).T
        progress(1.0)
        return tiles

    def __len__(self) -> int:
        """Number of distinct patches, to which the cost of a search is proportional."""
        return len(self._first)

    @property
    def batch(self) -> int:
        """Number of patches that are best searched for at a time."""
        return max(1, min(DISTANCES // len(self), BATCH // self._tiles.size))

    def draw(self, values: Real, known: Mask, tolerance: float, chances: Double) -> Index:
        """Draw for each of M patches one of the image's, uniformly among those within (1 + ε) of the nearest.

        Parameters
        ----------
        values : ndarray of float32, shape (M, (2n + 1)², C)
            Any finite value where they are not known.
        known : ndarray of bool, shape (M, (2n + 1)²)
            Which pixels are known, at least one of each patch.
        tolerance : float
            ε ≥ 0.
        chances : ndarray of float64, shape (M,)
            Uniform on [0, 1[; decides which of them is drawn.

        Returns
        -------
        ndarray of int, shape (M,)
            y W + x of the pixel in the middle of the drawn patch.
        """
        weights = self._weights * known
        centred = values - self._centre
        energy = np.einsum("mk,mkc->m", weights, np.square(centred))
        rough = self._product(centred, weights)
        best = rough.argmin(1)
        # The best of the rough ones bounds the least distance, hence the distances that count, hence their errors:
        # |p| |s| + |s|² with |s| ≤ |p| + √d.
        reach = (1 + tolerance) * self._distances(values, weights, np.arange(len(values)), best)
        doubt = 3 * self._error * (np.sqrt(energy) + np.sqrt(reach)) ** 2
        near = rough <= (reach - energy + doubt).astype(np.float32)[:, None]
        rows, found = np.divmod(np.flatnonzero(near), len(self))  # several times faster than a search of two axes
        distances = self._distances(values, weights, rows, found)
        ends = np.searchsorted(rows, np.arange(len(values)), side="right")
        least = np.minimum.reduceat(distances, np.concatenate([[0], ends[:-1]]))
        copies = np.where(distances <= (1 + tolerance) * least[rows], self._counts[found], 0)
        totals = np.cumsum(copies)
        before = np.concatenate([[0], totals[ends[:-1] - 1]])
        drawn = before + (chances * (totals[ends - 1] - before)).astype(np.intp)
        pair = np.searchsorted(totals, drawn, side="right")
        taken: Index = self._members[self._starts[found[pair]] + drawn - (totals[pair] - copies[pair])]
        return taken

    def _product(self, centred: Double, weights: Double) -> Real:
        """Compute the distances of M patches to all N distinct ones, less their own energy, in single precision."""
        count, pixels, channels = centred.shape
        tiles, terms, size = self._tiles.shape
        parts = -(-count // max(1, PRODUCT // (terms * size)))
        rows = -(-count // parts)
        left = np.zeros((parts * rows, terms), np.float32)
        left[:count, : pixels * channels] = (-2 * weights[:, :, None] * centred).reshape(count, -1)
        left[:count, pixels * channels :] = weights
        result = np.empty((parts * rows, tiles * size), np.float32)
        # A tile stays in the cache while it meets all parts of the left side.
        products = result.reshape(parts, rows, tiles, size).transpose(2, 0, 1, 3)
        factors = left.reshape(1, parts, rows, terms)
        step = -(-tiles // max(1, self._team.threads))

        def multiply(first: int) -> None:
            np.matmul(factors, self._tiles[first : first + step, None], out=products[first : first + step])

        self._team.run(multiply, range(0, tiles, step), lambda part: None)
        return result[:count, : len(self)]

    def _distances(self, values: Real, weights: Double, rows: Index, found: Index) -> Double:
        """Compute the distances of patches ``rows`` and distinct patches ``found``, pair by pair."""
        result = np.empty(len(rows))
        for first in range(0, len(rows), PAIRS):
            pairs = slice(first, first + PAIRS)
            patches = self._patches[np.divmod(self._first[found[pairs]], self._columns)]
            differences = patches.reshape(-1, *values.shape[1:]).astype(np.float64)
            differences -= values[rows[pairs]]
            np.square(differences, out=differences)
            # Terms in the same order for every patch: equal patches must have equal distances.
            result[pairs] = (differences.sum(2) * weights[rows[pairs]]).sum(1)
        return result


def _patches(framed: Real, side: int) -> Real:
    """All windows of an image, shape (rows, columns, side, side, C), as a view."""
    return np.moveaxis(sliding_window_view(framed, (side, side), axis=(0, 1)), 2, 4)


def _equal_rows(rows: Real) -> tuple[Index, Index]:
    """The class of every row, numbered by first occurrence, and the first row of every class."""
    packed = np.ascontiguousarray(rows).view(np.dtype((np.void, rows.shape[1] * rows.itemsize)))[:, 0]
    _, first, inverse = np.unique(packed, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return rank[inverse], first[order]

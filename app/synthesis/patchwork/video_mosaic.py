"""Video mosaic: a patchwork of a video in which time is one more dimension of space.

Jittered grid points p_i = (t, y, x), one in each block of ``interval`` frames by ``grid`` by ``grid`` pixels, have the
weights w_i(x) = d(x, p_i)^(−f), where ``interval`` frames count as ``grid`` pixels, and

    O(x) = Σ (I(x − p_i + q_i) − a) w_i(x) / √(Σ w_i(x)²) + a.

From f = 6 on, and for near points only, the weights are lowered by R^(−f), R = 1.75 grids, which ends them. Otherwise
every point counts, once: on a circular axis by the short way, and beyond the clip with its mirror image.

As the patches come and go, so does what stood still in the clip.

References
----------
Harrison, "Patchwork texture synthesis", 2002, section 4, Figure 5a; equations (1) and (2).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import Bytes, Ints, Mask, Real
from .cells import Window
from .unbounded_cells import ENDS, Reach

REACH = 1.75  # R; every place has a point within √3 grids
CENTRE = np.float32(1e-3)  # square pixels, added to squared distances: at a centre nothing else counts
TILE = 512  # pixels a side that are computed at a time
HELD = 12  # arrays of a tile's size that a thread holds, in single precision


def least_length(length: int, spacing: int) -> int:
    """Compute the least pixels of a side of the crop, or frames of the clip, for patches of a spacing.

    Parameters
    ----------
    length : int
        Pixels or frames of the output.
    spacing : int
        Grid or interval.

    Examples
    --------
    >>> least_length(320, 64), least_length(72, 18), least_length(5, 64)
    (225, 63, 5)
    """
    return min(2 * int(REACH * spacing) + 1, length)


def tile_bytes(height: int, width: int, threads: int = 4) -> int:
    """Compute the bytes that the threads hold of tiles.

    Parameters
    ----------
    height, width : int
        Size of a frame, in pixels.
    threads : int

    Returns
    -------
    int
    """
    return 4 * HELD * threads * min(height, TILE) * min(width, TILE)


def count_mosaic_terms(shape: tuple[int, int, int], grid: int, interval: int) -> int:
    """Count the products of a weight and a pixel that a frame has where every point counts.

    Parameters
    ----------
    shape : tuple of int
        Frames, height and width of the output.
    grid, interval : int
        Spacing of the points in pixels and in frames.

    Returns
    -------
    int
    """
    frames, height, width = shape
    points = -(-frames // interval) * -(-height // grid) * -(-width // grid)
    return points * height * width


class VideoMosaic:
    """Three-dimensional patchwork, any frame of which can be computed.

    Parameters
    ----------
    planes : ndarray of uint8, shape (T, C, H, W)
        The clip, each side at least `least_length`.
    shape : tuple of int
        Frames, height and width of the output.
    grid, interval : int
        Spacing of the points in pixels and in frames.
    sharpness : float
        f.
    loop, tileable : bool
        Whether distances are circular in time, and in space.
    rng : numpy.random.Generator
    reach : {"all", "near"}
        Whether every point counts at a pixel.

    Attributes
    ----------
    sources : ndarray of int64, shape (cells, 3)
        q_i as (t, y, x).
    """

    def __init__(
        self,
        planes: Bytes,
        shape: tuple[int, int, int],
        *,
        grid: int,
        interval: int,
        sharpness: float,
        loop: bool,
        tileable: bool,
        rng: np.random.Generator,
        reach: Reach = "all",
    ) -> None:
        self._ends = reach == "near" or sharpness >= ENDS
        self._planes, self._sharpness = planes, sharpness
        self._mean: Real = planes.mean((0, 2, 3), dtype=np.float64).astype(np.float32)
        self._reach2 = np.float32((REACH * grid) ** 2)
        self._pixels = grid / interval  # that count as much as a frame
        frames, _, height, width = planes.shape
        spacings = (interval, grid, grid)
        blocks = np.indices([-(-length // spacing) for length, spacing in zip(shape, spacings, strict=True)])
        self._times, self._rows, self._columns = (
            _Axis(*of_axis, rng, self._ends)
            for of_axis in zip(
                shape, (frames, height, width), spacings, (loop, tileable, tileable), blocks.reshape(3, -1), strict=True
            )
        )
        self.sources: Ints = np.stack([axis.q for axis in (self._times, self._rows, self._columns)], 1)

    def frame(self, number: int) -> Real:
        """Compute frame ``number`` of the output, (H, W, C); values may lie outside the clip's range."""
        frame = np.empty((self._rows.length, self._columns.length, len(self._mean)), np.float32)
        for top in range(0, len(frame), TILE):
            for left in range(0, frame.shape[1], TILE):
                window = Window(top, min(top + TILE, len(frame)), left, min(left + TILE, frame.shape[1]))
                frame[top : window.bottom, left : window.right] = self._tile(number, window).transpose(1, 2, 0)
        return frame

    def _tile(self, number: int, window: Window) -> Real:
        mean = self._mean[:, None, None]
        total = np.zeros((len(mean), window.bottom - window.top, window.right - window.left), np.float32)
        squares = np.zeros(total.shape[1:], np.float32)
        for patch, weights in self._weights(number, window):
            squares[patch.place] += weights * weights
            time, rows, columns = patch.source
            values = self._planes[time][:, rows][:, :, columns] - mean
            values *= weights
            total[:, *patch.place] += values
        total /= np.sqrt(squares)
        total += mean
        return total

    def paint(self, number: int, window: Window, colours: Real) -> Real:
        """Paint the cells that meet a window of a frame, each in its colour, mixed by their weights.

        Parameters
        ----------
        number : int
            Number of the frame.
        window : Window
        colours : ndarray of float32, shape (cells, 3)

        Returns
        -------
        ndarray of float32, shape (rows, columns, 3)
        """
        total = np.zeros((window.bottom - window.top, window.right - window.left, 3), np.float32)
        sums = np.zeros((*total.shape[:2], 1), np.float32)
        for patch, weights in self._weights(number, window):
            total[patch.place] += weights[:, :, None] * colours[patch.cell]
            sums[patch.place] += weights[:, :, None]
        total /= sums
        return total

    def _weights(self, number: int, window: Window) -> Iterator[tuple["_Patch", Real]]:
        """Yield the patches of a window, with their weights as a part of the largest at each pixel."""
        nearest = np.full((window.bottom - window.top, window.right - window.left), np.inf, np.float32)
        for patch in self._patches(number, window):
            place = nearest[patch.place]
            np.minimum(place, patch.distances, out=place)
        end = self._power(nearest / self._reach2) if self._ends else None
        for patch in self._patches(number, window):
            weights = self._power(nearest[patch.place] / patch.distances)
            if end is not None:
                weights -= end[patch.place]
                np.maximum(weights, 0, out=weights)
            yield patch, weights

    def _power(self, ratios: Real) -> Real:
        """(d² / d'²)^(f/2), in place."""
        np.log(ratios, out=ratios)
        ratios *= np.float32(self._sharpness / 2)
        return np.exp(ratios, out=ratios)

    def _patches(self, number: int, window: Window) -> Iterator["_Patch"]:
        """Yield the patches that reach into a window; one that reaches over the border comes in parts."""
        offsets = self._times.offsets(number)
        for cell in np.flatnonzero(self._times.reaches(offsets)).tolist():
            offset = int(offsets[cell])
            when = CENTRE + np.float32((offset * self._pixels) ** 2)
            time = int(self._times.mirrored(self._times.q[cell] + offset))
            for rows, source_rows, y in self._rows.parts(cell, window.top, window.bottom):
                for columns, source_columns, x in self._columns.parts(cell, window.left, window.right):
                    yield _Patch(
                        cell, (rows, columns), (time, source_rows, source_columns), (y * y + when)[:, None] + x * x
                    )


@dataclass(frozen=True)
class _Patch:
    """Place of a patch, or of a part of it, in a window and in the clip, and the squared distances to its point."""

    cell: int
    place: tuple[slice, slice]
    source: tuple[int, slice | Ints, slice | Ints]
    distances: Real


class _Axis:
    """One coordinate of all points: p in the output, q in the clip.

    ``before`` and ``after`` places on either side are seen. If the weights end, all of these lie in the clip around q;
    otherwise those do that would be seen if the weights ended.
    """

    def __init__(
        self, length: int, source: int, spacing: int, wraps: bool, block: Ints, rng: np.random.Generator, ends: bool
    ) -> None:
        self.length, self._source, self._wraps, self._ends = length, source, wraps, ends
        count = -(-length // spacing)
        self._p = rng.integers(block * length // count, (block + 1) * length // count)
        most_before, most_after = ((length - 1) // 2, length // 2) if wraps else (self._p, length - 1 - self._p)
        whole = [np.broadcast_to(most, block.shape) for most in (most_before, most_after)]
        near = [np.minimum(int(REACH * spacing), most) for most in whole]
        self.q: Ints = rng.integers(near[0], source - near[1])
        seen = near if ends else whole
        self._before, self._after = seen[0], seen[1]

    def mirrored(self, places: Ints) -> Ints:
        """Reflect places beyond the clip's ends into it."""
        turn = places % (2 * self._source)
        return np.minimum(turn, 2 * self._source - 1 - turn)

    def offsets(self, place: int) -> Ints:
        """Compute the offsets from every point to a place, the short way where the axis is circular."""
        offsets: Ints = place - self._p
        if self._wraps:
            back = (self.length - 1) // 2
            offsets = (offsets + back) % self.length - back
        return offsets

    def reaches(self, offsets: Ints) -> Mask:
        """Tell which points are seen at these offsets from them."""
        seen: Mask = (-self._before <= offsets) & (offsets <= self._after)
        return seen

    def parts(self, cell: int, begin: int, end: int) -> Iterator[tuple[slice, slice | Ints, Real]]:
        """Yield where a cell is seen between two places: relative to the first, in the clip, and from its point."""
        p, q, before, after = (int(of_all[cell]) for of_all in (self._p, self.q, self._before, self._after))
        for turn in (-self.length, 0, self.length) if self._wraps else (0,):
            start, stop = max(p - before, begin + turn), min(p + after + 1, end + turn)
            if start < stop:
                offsets = np.arange(start - p, stop - p, dtype=np.float32)
                source = slice(start - p + q, stop - p + q)
                shown = source if self._ends else self.mirrored(np.arange(source.start, source.stop))
                yield slice(start - begin - turn, stop - begin - turn), shown, offsets

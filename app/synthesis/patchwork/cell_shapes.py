"""Extents of the cells of a jittered grid, measured on a lattice of points for all cells at once.

The part that a cell has of a pixel x is w_i(x) / sqrt(Σ_j w_j(x)²), with the weights of
`microtexture.patchwork.cells`. Where it is at least some share s, d(x, p_i) ≤ T_s(x) with a distance T_s that depends
on x alone; so a cell's box is found by comparing distances.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache, reduce
from math import ceil, hypot

import numpy as np

from ..arrays import Double, Ints, Real
from ..elementary import power

REACH = 3.0  # spacings after which a weight is 0
JITTER = 0.75  # of its square's side, in which a centre lies
LATTICE = 13  # points along a spacing, or all of its pixels where there are fewer
AT_ONCE = 1 << 18  # points that are looked at together
NEAR = 2  # spacings within which centres make up nearly all of Σ w²
ROUNDING = 2  # pixels that a centre may be off for lying on a whole one

LEAST_SQUARE = np.float32(1e-6)  # of a distance, to take logarithms of
EPSILON = 1e-5  # what single precision may be wrong by


def log_weight(d: Double, sharpness: float) -> Double:
    """Compute log(d^(−f) − R^(−f)) of distances in spacings, −∞ from R on.

    Examples
    --------
    >>> np.exp(log_weight(np.array([0.5, 3.0]), 2)).round(6).tolist()
    [3.888889, 0.0]
    """
    with np.errstate(divide="ignore"):
        shoulder = np.log1p(-(np.minimum(d / REACH, 1) ** sharpness))
    return shoulder - sharpness * np.log(d)


@dataclass(frozen=True)
class Axis:
    """Squares of the grid along one axis: ``count`` in the plane, ``beyond`` more before it and as many behind it.

    ``size`` is the plane's, in pixels.
    """

    size: int
    count: int
    beyond: int

    @property
    def spacing(self) -> float:
        """Pixels from one square to the next."""
        return self.size / self.count

    @property
    def edges(self) -> Ints:
        """First pixels of all squares, and the end of the last."""
        edges: Ints = np.arange(-self.beyond, self.count + self.beyond + 1) * self.size // self.count
        return edges

    def jittered(self, jitter: Double, axis: int) -> Ints:
        """Turn an array of numbers of [0, 1) into places in the squares, which lie along ``axis`` of it."""
        shape = (-1, 1) if axis == 0 else (1, -1)
        first, length = self.edges[:-1].reshape(shape), np.diff(self.edges).reshape(shape)
        places: Ints = first + (length * ((1 - JITTER) / 2 + JITTER * jitter)).astype(np.int64)
        return places

    @property
    def _along(self) -> int:
        return min(LATTICE, ceil(self.spacing))

    def points(self) -> Ints:
        """List the pixels at which shapes are measured, from the first to the last of each square: (points, count)."""
        edges = self.edges[self.beyond : self.beyond + self.count + 1]
        along = self._along
        points: Ints = edges[:-1] + np.arange(along)[:, None] * (np.diff(edges) - 1) // max(1, along - 1)
        return points

    @property
    def off(self) -> int:
        """Most pixels from a pixel to the nearest point."""
        return ceil((ceil(self.spacing) - 1) / max(1, self._along - 1)) // 2

    def gap(self, offset: int) -> float:
        """Least distance, in pixels, of a centre from the points of a square that many squares away."""
        return max(0.0, (abs(offset) - 1 + (1 - JITTER) / 2) * self.spacing - ROUNDING)


def thresholds(
    squares: Callable[[], Iterable[Real]], sharpness: float, shares: tuple[float, ...], off: float = 0.0
) -> list[Real]:
    """Compute the squared distances T_s(x)² up to which a centre's part of a pixel can be a share s.

    Parameters
    ----------
    squares : callable
        Yields the squared distances, in spacings, of each pixel to one centre after another, arrays of one shape.
    sharpness : float
        f.
    shares : tuple of float
        1 means the largest part of all.
    off : float
        Spacings by which a pixel may lie beside the point that is looked at: the distances are enlarged so that they
        hold there too, where the distance to a centre differs by at most ``off``, and T_s by at most T_s / nearest
        times ``off``.

    Returns
    -------
    list of ndarray of float32
        One of each share, in spacings squared.
    """
    nearest = reduce(np.minimum, squares())
    np.maximum(nearest, LEAST_SQUARE, out=nearest)
    half, logs = np.float32(sharpness / 2), np.log(nearest)
    shoulder = np.exp((logs - np.float32(2 * np.log(REACH))) * half)
    norm = np.zeros_like(nearest)
    for square in squares():
        weight = np.exp((logs - np.log(np.maximum(square, nearest))) * half)
        weight -= shoulder
        np.maximum(weight, 0, out=weight)
        weight *= weight
        norm += weight
    norm = np.sqrt(norm)  # times (1 − shoulder)
    found = []
    for share in shares:
        ratio: Real = np.ones_like(norm) if share == 1 else power(shoulder + np.float32(share) * norm, -1 / sharpness)
        reached = np.sqrt(nearest) * ratio + np.float32(off + EPSILON) * (1 + ratio)
        found.append(np.square(reached, out=reached))
    return found


@lru_cache(maxsize=64)
def farthest(sharpness: float, share: float) -> float:
    """Bound, in spacings, how far a cell's part of at least ``share`` can reach, wherever the centres lie.

    Every other centre is put where its square's jitter takes it farthest from the pixel.
    """
    x = np.linspace(0, 1, 65, dtype=np.float32)
    low, high = np.float32((1 - JITTER) / 2), np.float32((1 + JITTER) / 2)

    def squares() -> Iterable[Real]:
        away = [np.maximum(np.abs(x - (k + low)), np.abs(x - (k + high))) ** 2 for k in range(-2, 3)]
        return (dy[:, None] + dx[None, :] for dy in away for dx in away)

    return float(np.sqrt(thresholds(squares, sharpness, (share,))[0].max()))


class _Band:
    """Points of some rows of squares, and how far centres are from them."""

    def __init__(self, axes: tuple[Axis, Axis], points: tuple[Ints, Ints], first: int, y: Ints, x: Ints) -> None:
        self._axes, self._first = axes, first
        self._y, self._x = y, x
        self._rows, self._columns = points[0][:, :, None], points[1][:, None, :]
        self._unit = max(axis.spacing for axis in axes)

    def around(self, distance: float) -> Iterator[tuple[int, int, float]]:
        """Yield the offsets of squares, in rows and columns, whose centres may be within a distance, and how near."""
        rows, columns = self._axes
        for dr in range(-rows.beyond, rows.beyond + 1):
            for dc in range(-columns.beyond, columns.beyond + 1):
                nearest = hypot(rows.gap(dr), columns.gap(dc)) / self._unit
                if nearest <= distance:
                    yield dr, dc, nearest

    def squares(self, dr: int, dc: int) -> tuple[slice, slice]:
        """Index the squares at an offset in arrays over all squares."""
        top, left = self._first + self._axes[0].beyond + dr, self._axes[1].beyond + dc
        return slice(top, top + self._rows.shape[1]), slice(left, left + self._columns.shape[2])

    def away(self, dr: int, dc: int) -> tuple[Real, Real]:
        """Compute the pixels from the centre at an offset to each row, (points, R, C), and each column of points."""
        where = self.squares(dr, dc)
        return (self._rows - self._y[where]).astype(np.float32), (self._columns - self._x[where]).astype(np.float32)

    def distances(self, dy: Real, dx: Real) -> Real:
        """Compute squared distances in spacings, shape (points along y, points along x, R, C)."""
        scale = np.float32(1 / self._unit)
        square: Real = ((dy * scale) ** 2)[:, None] + ((dx * scale) ** 2)[None, :]
        return square

    def near(self) -> Iterator[Real]:
        """Yield the squared distances to the centres that matter most."""
        return (self.distances(*self.away(dr, dc)) for dr, dc, _ in self.around(NEAR))


def extents(rows: Axis, columns: Axis, y: Ints, x: Ints, sharpness: float, shares: tuple[float, ...]) -> Real:
    """Compute boxes relative to the centres, outside of which their parts of the pixels are less than a share.

    Parameters
    ----------
    rows, columns : Axis
    y, x : ndarray of int64, shape (squares along the rows' axis, squares along the columns' axis)
        The centres.
    sharpness : float
    shares : tuple of float
        See `thresholds`.

    Returns
    -------
    ndarray of float32, shape (shares, 4, *y.shape)
        Top, bottom, left, right, bottom and right being one past the last; infinite, top and left greater than bottom
        and right, where a centre has no such pixel.
    """
    points, off = (rows.points(), columns.points()), (rows.off, columns.off)
    unit = max(rows.spacing, columns.spacing)
    boxes = np.empty((len(shares), 4, *y.shape), np.float32)
    boxes[:, ::2], boxes[:, 1::2] = np.inf, -np.inf
    chunk = max(1, AT_ONCE // (len(points[0]) * points[1].size))
    for first in range(0, rows.count, chunk):
        band = _Band((rows, columns), (points[0][:, first : first + chunk], points[1]), first, y, x)
        limits = thresholds(band.near, sharpness, shares, hypot(*off) / unit)
        for dr, dc, nearest in band.around(max(farthest(sharpness, share) for share in shares)):
            where, away = band.squares(dr, dc), band.away(dr, dc)
            squares = band.distances(*away)
            for share, limit, box in zip(shares, limits, boxes, strict=True):
                if nearest > farthest(sharpness, share):
                    continue
                inside = squares <= limit
                for axis, d in enumerate(away):
                    hit = inside.any(axis=1 - axis)
                    low, high = box[2 * axis][where], box[2 * axis + 1][where]
                    np.minimum(low, np.where(hit, d - np.float32(off[axis]), np.float32(np.inf)).min(axis=0), out=low)
                    np.maximum(
                        high, np.where(hit, d + np.float32(off[axis] + 1), np.float32(-np.inf)).max(axis=0), out=high
                    )
    for share, box in zip(shares, boxes, strict=True):
        pixels = reach(unit, sharpness, share)
        np.maximum(box[::2], -pixels, out=box[::2])
        np.minimum(box[1::2], pixels + 1, out=box[1::2])
    return boxes


def reach(unit: float, sharpness: float, share: float) -> int:
    """Round `farthest` up to pixels, for centres on whole pixels.

    Parameters
    ----------
    unit : float
        A spacing, in pixels.
    sharpness, share : float
        Those of `farthest`.

    Returns
    -------
    int
    """
    return ceil(farthest(sharpness, share) * unit) + ROUNDING

"""How far the cells of a jittered grid reach: found out on a lattice of points, for all cells at once.

The part that a cell has of a pixel x is w_i(x) / sqrt(Σ_j w_j(x)²), with the weights of `app.synthesis.cells`. Where it
is at least some share s, d(x, p_i) ≤ T_s(x) with a distance T_s that depends on x alone; so a cell's box is found by
comparing distances.
"""

from collections.abc import Callable, Iterable
from functools import lru_cache
from math import ceil
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

REACH = 3.0  # spacings after which a weight is 0
JITTER = 0.75  # of its square's side, in which a centre lies
LATTICE = 8  # points along a spacing
AT_ONCE = 1 << 20  # distances that are held at once
NEAR = 2  # squares each way whose centres make up all but nothing of Σ w²
ROUNDING = 2  # pixels that a centre may be off for lying on a whole one

Ints = NDArray[np.int64]
Real = NDArray[np.float32]


class Axis(NamedTuple):
    """Squares of the grid along one axis, ``beyond`` of them before the plane and as many behind it.

    ``edges`` are the first pixels of all squares, and the end of the last; ``size`` is the plane's.
    """

    size: int
    count: int
    beyond: int

    @property
    def edges(self) -> Ints:
        return np.arange(-self.beyond, self.count + self.beyond + 1) * self.size // self.count

    @property
    def spacing(self) -> float:
        return self.size / self.count

    @property
    def points(self) -> Ints:
        """Pixels at which shapes are found out, shape (count, points of a square); some come twice."""
        first, last = self.edges[self.beyond : -self.beyond - 1, None], self.edges[self.beyond + 1 : -self.beyond, None]
        along = max(1, min(LATTICE, ceil(self.spacing)))
        return first + np.arange(along) * (last - first) // along

    @property
    def step(self) -> int:
        """Most pixels from a point to the next."""
        return ceil(ceil(self.spacing) / self.points.shape[1])

    def jittered(self, jitter: NDArray[np.float64], axis: int) -> Ints:
        """Places in the squares along ``axis`` of an array of numbers of [0, 1)."""
        shape = (-1, 1) if axis == 0 else (1, -1)
        first, length = self.edges[:-1].reshape(shape), np.diff(self.edges).reshape(shape)
        return first + (length * ((1 - JITTER) / 2 + JITTER * jitter)).astype(np.int64)


def thresholds(squares: Callable[[], Iterable[Real]], sharpness: float, shares: tuple[float, ...]) -> list[Real]:
    """Squared distances T_s(x)² up to which a centre's part of a pixel can be a share s, in spacings.

    Parameters
    ----------
    squares : callable
        Gives the squared distances of each pixel to one centre after another, arrays of one shape.
    sharpness : float
    shares : tuple of float
        1 means the largest part of all.
    """
    nearest: Any = None
    for square in squares():
        nearest = square.copy() if nearest is None else np.minimum(nearest, square, out=nearest)
    np.maximum(nearest, np.float32(1e-6), out=nearest)
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
        least = shoulder + np.float32(share) * norm
        found.append(nearest.copy() if share == 1 else nearest * least ** np.float32(-2 / sharpness))
    return found


@lru_cache(maxsize=64)
def farthest(sharpness: float, share: float) -> float:
    """How many spacings a cell's part of at least ``share`` can reach at most, wherever the centres lie.

    Every other centre is put where its square's jitter takes it farthest from the pixel.
    """
    x = np.linspace(0, 1, 65, dtype=np.float32)
    low, high = np.float32((1 - JITTER) / 2), np.float32((1 + JITTER) / 2)

    def squares() -> Iterable[Real]:
        away = [np.maximum(np.abs(x - (k + low)), np.abs(x - (k + high))) ** 2 for k in range(-NEAR, NEAR + 1)]
        return (dy[:, None] + dx[None, :] for dy in away for dx in away)

    return float(np.sqrt(thresholds(squares, sharpness, (share,))[0].max()))


def extents(
    rows: Axis, columns: Axis, y: Ints, x: Ints, unit: float, sharpness: float, shares: tuple[float, ...]
) -> Ints:
    """Boxes relative to the centres, outside of which their parts of the plane's pixels are less than a share.

    Parameters
    ----------
    rows, columns : Axis
    y, x : ndarray of int64, shape (rows, columns) of squares
        The centres.
    unit, sharpness : float
    shares : tuple of float

    Returns
    -------
    ndarray of int64, shape (shares, rows, columns, 4)
        Top, bottom, left, right; the last two pairs' ends are one past. All 0 where a centre has no such pixel.
    """
    out = np.zeros((len(shares), *y.shape, 4), np.int64)
    empty = np.iinfo(np.int64).max // 2
    out[..., ::2], out[..., 1::2] = empty, -empty
    at_y, at_x = rows.points, columns.points
    chunk = max(1, AT_ONCE // (at_y.shape[1] * at_x.size))
    for first in range(0, rows.count, chunk):
        _extend(out, rows, columns, y, x, unit, sharpness, shares, slice(first, min(first + chunk, rows.count)))
    nothing = out[..., :1] == empty
    for side, step in enumerate((rows.step, rows.step, columns.step, columns.step)):
        out[..., side] += (step if side % 2 else 1 - step) if step > 1 else side % 2
    limits = np.array([ceil(farthest(sharpness, share) * unit) + ROUNDING for share in shares])[:, None, None, None]
    out[..., ::2] = np.maximum(out[..., ::2], -limits)
    out[..., 1::2] = np.minimum(out[..., 1::2], limits + 1)
    return np.where(nothing, 0, out)


def _extend(
    out: Ints,
    rows: Axis,
    columns: Axis,
    y: Ints,
    x: Ints,
    unit: float,
    sharpness: float,
    shares: tuple[float, ...],
    band: slice,
) -> None:
    """Let the boxes hold the points of a band of squares."""
    at_y, at_x = rows.points[band], columns.points
    height, width = len(at_y), len(at_x)

    def away(dr: int, dc: int) -> tuple[tuple[slice, slice], Ints, Ints]:
        top, left = band.start + rows.beyond + dr, columns.beyond + dc
        where = (slice(top, top + height), slice(left, left + width))
        return where, at_y[:, None, :] - y[where][:, :, None], at_x[None, :, :] - x[where][:, :, None]

    def square(dy: Ints, dx: Ints) -> Real:
        scaled_y, scaled_x = ((d * np.float32(1 / unit)).astype(np.float32) ** 2 for d in (dy, dx))
        total: Real = scaled_y[:, :, :, None] + scaled_x[:, :, None, :]
        return total

    near_rows, near_columns = min(rows.beyond, NEAR), min(columns.beyond, NEAR)

    def squares() -> Iterable[Real]:
        for dr in range(-near_rows, near_rows + 1):
            for dc in range(-near_columns, near_columns + 1):
                yield square(*away(dr, dc)[1:])

    limits = thresholds(squares, sharpness, shares)
    empty = np.iinfo(np.int64).max // 2
    for dr in range(-rows.beyond, rows.beyond + 1):
        for dc in range(-columns.beyond, columns.beyond + 1):
            where, dy, dx = away(dr, dc)
            d2 = square(dy, dx)
            for boxes, limit in zip(out, limits, strict=True):
                inside = d2 <= limit
                for side, d, hit in ((0, dy, inside.any(3)), (2, dx, inside.any(2))):
                    box = boxes[where]
                    np.minimum(box[:, :, side], np.where(hit, d, empty).min(2), out=box[:, :, side])
                    np.maximum(box[:, :, side + 1], np.where(hit, d, -empty).max(2), out=box[:, :, side + 1])

"""Histogram matching: values take another image's distribution and keep their order.

Exact: the value of rank j among n becomes the quantile (j + ½) / n of the target, whose quantiles between its sorted
values are interpolated where the sizes differ.
"""

import threading

import numpy as np

from ..arrays import Checkpoint, Ints, Real

CHUNK = 1 << 14  # values worked on at a time, so that what is in between stays in the cache

_rooms = threading.local()


def quantiles(ordered: Real, count: int, first: int = 0, last: int | None = None) -> Real:
    """Compute the quantiles (j + ½) / count, j = first … last − 1, of sorted values that stand for (i + ½) / n.

    Parameters
    ----------
    ordered : ndarray of float32, shape (n,)
        Ascending.
    count : int
        Number of quantiles in all.
    first, last : int
        First and last-plus-one of those that are computed; default: all.

    Returns
    -------
    ndarray of float32, shape (last − first,)

    Examples
    --------
    >>> import numpy as np
    >>> quantiles(np.array([0, 4, 8], np.float32), 6)
    array([0., 1., 3., 5., 7., 8.], dtype=float32)
    """
    last = count if last is None else last
    if len(ordered) == count:
        return ordered[first:last]
    ratio = len(ordered) / count
    place = np.arange(first, last) * ratio
    place += 0.5 * ratio - 0.5
    np.maximum(place, 0, out=place)
    below = place.astype(np.intp)
    place -= below
    low = ordered.take(below, mode="clip")
    below += 1
    result: Real = ordered.take(below, mode="clip")
    result -= low
    result *= place.astype(np.float32)
    result += low
    return result


def match(values: Real, ordered: Real, checkpoint: Checkpoint = lambda: None) -> None:
    """Match values, in place, to the distribution of a target; of equal values the first one ranks lower.

    Floats become whole numbers that sort alike, with their places in the lower half: sorting these whole numbers
    is several times as fast as `numpy.argsort` of floats.

    Parameters
    ----------
    values : ndarray of float32, contiguous
        Fewer than 2³¹ values.
    ordered : ndarray of float32, shape (n,)
        The target's values, ascending.
    checkpoint : callable
        Called between pieces of work; what it raises stops the work.

    Examples
    --------
    >>> import numpy as np
    >>> values = np.array([[30, 10], [40, 20]], np.float32)
    >>> match(values, np.array([-2, 0, 0.5, 9], np.float32))
    >>> values
    array([[ 0.5, -2. ],
           [ 9. ,  0. ]], dtype=float32)
    """
    flat = values.reshape(-1, copy=False)
    bits, keys = flat.view(np.int32), _keys(flat.size)
    for first in range(0, flat.size, CHUNK):
        piece, key = bits[first : first + CHUNK], keys[first : first + CHUNK]
        key[:] = piece ^ ((piece >> 31) & 0x7FFFFFFF)  # the magnitude of negative floats counts downwards
        key <<= 32
        key |= np.arange(first, first + len(piece))
    checkpoint()
    keys.sort()
    for first in range(0, flat.size, CHUNK):
        checkpoint()
        place = keys[first : first + CHUNK]
        place &= 0xFFFFFFFF
        flat[place] = quantiles(ordered, flat.size, first, first + len(place))


def _keys(count: int) -> Ints:
    """Return an array of the calling thread to sort in: fresh memory would cost a third of the sorting."""
    room: Ints | None = getattr(_rooms, "keys", None)
    if room is None or len(room) < count:
        _rooms.keys = room = np.empty(count, np.int64)
    return room[:count]

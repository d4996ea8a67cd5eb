"""Efros–Leung non-parametric sampling: a texture that grows from a few pixels, pixel by pixel, by copying.

The next pixel takes the value of a pixel of the sample, drawn among those whose surroundings look like what is
already there. The articles compare whole windows of the sample only; here every pixel of it can be drawn, also one near
the border, if the sample holds all that is known of the window: its other half may reach beyond.

Which pixel is next depends on no value, so the whole order is laid down first. Pixels whose windows do not contain each
other then are computed together: the result is that of the order, one after the other.

References
----------
Efros, Leung, "Texture Synthesis by Non-parametric Sampling", ICCV 1999; Aguerrebere, Gousseau, Tartavel,
"Exemplar-based Texture Synthesis: the Efros-Leung Algorithm", IPOL 2013.
"""

from collections.abc import Iterator
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.random import SFC64, Generator, SeedSequence

from ..arrays import Index, Progress, Real, ignore_progress
from ..parallel import Team
from .window_search import WindowSearch

SEED_SIDE = 3  # pixels
PIXELS = 4096  # between two calls of the progress while the order is laid down


class Growth(NamedTuple):
    """Texture, the places of the sample that its pixels were copied from, and the order in which they were."""

    texture: Real
    copied: Index
    order: Index


def efros_leung(
    h: Real,
    height: int | None = None,
    width: int | None = None,
    *,
    half_patch: int = 4,
    tolerance: float = 0.1,
    seed: int = 0,
    threads: int = 1,
    progress: Progress = ignore_progress,
) -> Growth:
    """Grow a texture around 3 × 3 pixels taken from the sample at random.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W, C)
        The sample, finite, any range; neither side shorter than the window.
    height, width : int, optional
        Size of the texture; default: the sample's.
    half_patch : int
        n ≥ 1; the window has 2n + 1 pixels a side.
    tolerance : float
        ε ≥ 0: a pixel is drawn among those whose windows are within (1 + ε) times the least distance.
    seed : int
        Not negative; the result depends on nothing else.
    threads : int
        The result does not depend on it.
    progress : callable ``(stage, part)``, optional
        Called between blocks; what it raises stops the work.

    Returns
    -------
    texture : ndarray of float32, shape (height, width, C)
    copied : ndarray of int, shape (height, width, 2)
        Row and column in the sample that each pixel was copied from.
    order : ndarray of int, shape (height, width)
        0, 1, …: when each pixel was filled; the initial ones come first.

    Raises
    ------
    ValueError
        If the sample is smaller than the window.

    Examples
    --------
    >>> import numpy as np
    >>> h = np.random.default_rng(0).random((20, 24, 3), np.float32)
    >>> z, copied, order = efros_leung(h, 30, 31, seed=7)
    >>> z.shape, bool((z == h[copied[:, :, 0], copied[:, :, 1]]).all()), int(order.max())
    ((30, 31, 3), True, 929)
    """
    height, width = height or h.shape[0], width or h.shape[1]
    side = 2 * half_patch + 1
    if min(h.shape[:2]) < side:
        raise ValueError(f"The sample is {h.shape[0]} × {h.shape[1]} and must hold a window of {side} × {side}.")
    rng = Generator(SFC64(SeedSequence(seed)))
    progress("order", 0.0)
    sequence = growth_order(height, width, half_patch, rng)
    initial = sequence[: min(SEED_SIDE, height) * min(SEED_SIDE, width)]
    corner = rng.integers(np.array(h.shape[:2]) - SEED_SIDE + 1)
    chances = rng.random(height * width)
    steps = list(_steps(sequence, len(initial), height, width, half_patch, progress))

    # The texture within a frame that is never known, so that every window is whole.
    canvas = np.zeros((height + 2 * half_patch, width + 2 * half_patch, h.shape[2]), np.float32)
    known = np.zeros(canvas.shape[:2], bool)
    copied = np.zeros((height, width, 2), np.intp)
    order = np.empty((height, width), np.intp)
    order.ravel()[sequence] = np.arange(height * width)
    inside = slice(half_patch, half_patch + height), slice(half_patch, half_patch + width)

    def fill(pixels: Index, rows: Index, columns: Index) -> None:
        y, x = np.divmod(pixels, width)
        copied[y, x, 0], copied[y, x, 1] = rows, columns
        canvas[inside][y, x] = h[rows, columns]
        known[inside][y, x] = True

    y, x = np.divmod(initial, width)
    fill(initial, corner[0] + y - y.min(), corner[1] + x - x.min())
    across = np.arange(side)
    window = (across[:, None] * canvas.shape[1] + across).ravel()
    with Team(threads) as team:
        search = WindowSearch(h, half_patch, team, partial(progress, "patches"))
        done = len(initial)
        for step in steps:
            for ranks in np.split(step, range(search.batch, len(step), search.batch)):
                progress("growth", done / len(sequence))
                y, x = np.divmod(sequence[ranks], width)
                around = (y * canvas.shape[1] + x)[:, None] + window
                values, mask = canvas.reshape(-1, h.shape[2])[around], known.ravel()[around]
                drawn = search.draw(values, mask, tolerance, chances[ranks])
                fill(sequence[ranks], *np.divmod(drawn, h.shape[1]))
                done += len(ranks)
    progress("growth", 1.0)
    return Growth(np.ascontiguousarray(canvas[inside]), copied, order)


def growth_order(height: int, width: int, half_patch: int, rng: Generator) -> Index:
    """List the pixels y · width + x in the order in which they are filled, the initial ones first.

    Layer after layer around the initial patch; within a layer those with the most known pixels in their window
    first, as counted when the layer is begun; those with equally many in random order.

    Parameters
    ----------
    height, width : int
        Size of the texture, in pixels.
    half_patch : int
        n ≥ 1; the window has 2n + 1 pixels a side.
    rng : numpy.random.Generator

    Returns
    -------
    ndarray of int, shape (height · width,)

    Examples
    --------
    >>> import numpy as np
    >>> growth_order(3, 5, 1, np.random.default_rng(0))[:9]
    array([ 1,  2,  3,  6,  7,  8, 11, 12, 13])
    """
    y, x = np.ogrid[:height, :width]
    top, left = max(0, (height - SEED_SIDE) // 2), max(0, (width - SEED_SIDE) // 2)
    bottom, right = min(height, top + SEED_SIDE) - 1, min(width, left + SEED_SIDE) - 1
    layer = np.maximum(np.maximum(top - y, y - bottom), np.maximum(left - x, x - right)).clip(0)

    def common(at: Index, first: Index, last: Index) -> Index:
        """Count the rows or columns that windows around ``at`` have in common with first … last."""
        return np.minimum(at + half_patch, last) - np.maximum(at - half_patch, first) + 1

    # What is known when a layer is begun is the rectangle of the layers before.
    before = layer - 1
    rows = common(y, np.maximum(top - before, 0), np.minimum(bottom + before, height - 1))
    columns = common(x, np.maximum(left - before, 0), np.minimum(right + before, width - 1))
    count = np.where(layer > 0, rows * columns, 0)
    chance = np.where(layer > 0, rng.random(layer.shape), 0)
    order: Index = np.lexsort((chance.ravel(), -count.ravel(), layer.ravel()))
    return order


def _steps(
    sequence: Index, first: int, height: int, width: int, half_patch: int, progress: Progress
) -> Iterator[Index]:
    """Yield the ranks of the pixels that grow, from ``first`` on, step by step.

    A pixel's step comes after those of all earlier pixels in its window. Two pixels of one step are not in each
    other's windows, or one of them would be in a later step: neither sees the other.
    """
    side = 2 * half_patch + 1
    step = np.zeros((height + 2 * half_patch, width + 2 * half_patch), np.intp)
    y, x = np.divmod(sequence, width)
    for rank in range(first, len(sequence)):
        if rank % PIXELS == 0:
            progress("order", rank / len(sequence))
        row, column = y[rank], x[rank]
        latest = step[row : row + side, column : column + side].max()
        step[row + half_patch, column + half_patch] = latest + 1
    of_rank = step[y + half_patch, x + half_patch]
    ranks = np.argsort(of_rank, kind="stable")[first:]
    bounds = np.searchsorted(of_rank[ranks], np.arange(1, of_rank.max() + 2))
    for begin, end in pairwise(bounds):
        yield ranks[begin:end]


def verbatim_share(copied: Index) -> float:
    """Compute the percentage of pixels copied together with their left or upper neighbour, from the same side of it.

    Examples
    --------
    >>> import numpy as np
    >>> verbatim_share(np.moveaxis(np.mgrid[3:5, 7:9], 0, 2))  # all but the first
    75.0
    """
    offset = copied - np.moveaxis(np.indices(copied.shape[:2]), 0, 2)
    along = np.zeros(copied.shape[:2], bool)
    along[:, 1:] |= (offset[:, 1:] == offset[:, :-1]).all(2)
    along[1:] |= (offset[1:] == offset[:-1]).all(2)
    return 100 * float(along.mean())


def border_share(growth: Growth, height: int, width: int, half_patch: int) -> float:
    """Compute the percentage of drawn pixels that came from where the sample holds a part of the window only.

    Parameters
    ----------
    growth : Growth
    height, width : int
        Size of the sample, in pixels.
    half_patch : int
        n of `efros_leung`.

    Returns
    -------
    float
        0–100; 0 if no pixel was drawn.

    Examples
    --------
    >>> import numpy as np
    >>> copied, order = np.moveaxis(np.indices((5, 5)), 0, 2), np.arange(25).reshape(5, 5)
    >>> border_share(Growth(np.zeros((5, 5, 1)), copied, order), 5, 5, half_patch=1)  # but for rows 2 and 3: 6 of 16
    62.5
    """
    initial = min(SEED_SIDE, growth.order.shape[0]) * min(SEED_SIDE, growth.order.shape[1])
    drawn = growth.copied[growth.order >= initial]
    if len(drawn) == 0:
        return 0.0
    last = np.array((height, width)) - half_patch - 1
    return 100 * float(((drawn < half_patch) | (drawn > last)).any(1).mean())

"""Texture transfer by patchwork: a pattern rendered in patches of a texture.

Every cell takes the patch of the texture that is nearest to the pattern there, and equation (7) joins them,

    O(x) = Σ_i (I(x − p_i + q_i) − a_i) w_i(x) / sqrt(Σ_i w_i(x)²) + Σ_i a_i w_i(x) / Σ_i w_i(x).

The deviation from the patches' averages a_i is kept in the joins, as in patchwork, and the averages are feathered. An
average is that of the patch, each pixel counted by the cell's share w_i / Σ_j w_j of it: so the patches' deviations,
feathered, have the mean 0. An average over the cell alone would leave a halo around every patch that was chosen for
being lighter or darker than what surrounds it in the texture.

With weights that do not end and a low f a patch has a share of pixels far away, where it shows what it was not chosen
for: its average is drawn to the texture's, and the result away from the pattern. Weights that end keep it local. (At
f = 2, a grid of 16 and 200 candidates, the pavilion in leaves of the method's page differs from its pattern by 43.6
levels with all cells and by 38.7 with near ones.)

References
----------
Harrison, "Patchwork texture synthesis", technical report, Monash University, 2002, section 5.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Checkpoint, Double, Ints, Real
from ..parallel import Work, row_blocks
from .best_places import Matches
from .cell_match import match_cells
from .cells import Cells, Window
from .patchwork import SamplePatches
from .unbounded_cells import Reach, cells_with_reach

BAND, SMALL_BAND, TILE = 128, 64, 512  # rows, rows where all cells count, and columns that are joined at once
TINY = 1e-30  # instead of 0, for a cell whose box holds no pixel that it has a part of


@dataclass(frozen=True)
class Transfer:
    """Result of `transfer`.

    Parameters
    ----------
    output : ndarray of float32, shape (H, W, C)
        The pattern rendered in the texture, values of [0, peak].
    average : ndarray of float32, shape (H, W, C)
        The feathered averages Σ a_i w_i / Σ w_i.
    matches : Matches
        Sources and errors of the cells.
    """

    output: Real
    average: Real
    matches: Matches


def rescale(pattern: Real, texture: Real) -> Real:
    """Give a pattern the mean and the range of a texture, channel by channel.

    Parameters
    ----------
    pattern : ndarray of float32, shape (H, W, C)
    texture : ndarray of float32, shape (H', W', C)

    Returns
    -------
    ndarray of float32, shape (H, W, C)
        Its values may lie outside those of the texture, as its mean need not be in the same place of the range.

    Examples
    --------
    >>> texture = np.array([10, 20, 30, 60], np.float32).reshape(2, 2, 1)
    >>> rescale(np.array([0, 0, 1, 1], np.float32).reshape(2, 2, 1), texture).ravel().tolist()
    [5.0, 5.0, 55.0, 55.0]
    """
    low, high = pattern.min((0, 1)), pattern.max((0, 1))
    scale = np.ptp(texture, (0, 1)) / np.where(high > low, high - low, 1)
    means = pattern.mean((0, 1), dtype=np.float64), texture.mean((0, 1), dtype=np.float64)
    found: Real = ((pattern - means[0]) * scale + means[1]).astype(np.float32)
    return found


def transfer(
    texture: Real,
    pattern: Real,
    cells: Cells,
    *,
    reach: Reach = "near",
    peak: float,
    candidates: int,
    seed: int,
    work: Work,
) -> Transfer:
    """Render a pattern in a texture.

    Parameters
    ----------
    texture : ndarray of float32, shape (H', W', C)
        At least `microtexture.patchwork.jittered_cells.least_sample` pixels a side; values of [0, ``peak``].
    pattern : ndarray of float32, shape (H, W, C)
        The pattern, of the size of the cells' plane; values in the texture's unit.
    cells : Cells
        Cells of a plane, not of a torus, with weights that end.
    reach : {"all", "near"}
        Whether all cells count at a pixel, or the weights end as they do for the search; see
        `microtexture.patchwork.unbounded_cells`.
    peak : float
        Greatest value of the texture.
    candidates : int
        Number of places of the texture, drawn at random, that are compared for each cell; 0 for all.
    seed : int
        Not negative; draws the candidates.
    work : Work
        Its stages ``"matching"``, ``"averages"`` and ``"texture"``.

    Returns
    -------
    Transfer
    """
    matches = match_cells(texture, pattern, cells, peak=peak, candidates=candidates, seed=seed, work=work)
    patches = _LaidPatches(texture, matches.places, cells_with_reach(cells, reach, tileable=False))
    averages = patches.averages(work)
    output, average = np.empty(pattern.shape, np.float32), np.empty(pattern.shape, np.float32)

    def join(window: Window) -> None:
        there = slice(window.top, window.bottom), slice(window.left, window.right)
        deviations, feathered = patches.join(window, averages, work.checkpoint)
        average[there] = feathered.transpose(1, 2, 0)
        feathered += deviations
        output[there] = feathered.transpose(1, 2, 0).clip(0, peak)

    work.run("texture", join, patches.windows)
    return Transfer(output, average, matches)


class _LaidPatches:
    """Patches of a texture, laid over the plane."""

    def __init__(self, texture: Real, sources: Ints, cells: Cells) -> None:
        self._cells, self._channels = cells, texture.shape[2]
        self._patches = SamplePatches(texture.transpose(2, 0, 1), cells, sources)
        self.windows = [
            Window(top, bottom, left, min(left + TILE, cells.width))
            for top, bottom in row_blocks(cells.height, BAND if cells.ends else SMALL_BAND)
            for left in range(0, cells.width, TILE)
        ]

    def averages(self, work: Work) -> Real:
        """Compute every patch's average, shape (centres, C)."""
        found: dict[Window, tuple[list[int], list[Double]]] = {}

        def add(window: Window) -> None:
            parts = self._cells.parts(window)
            total = np.zeros((window.bottom - window.top, window.right - window.left), np.float32)
            for part in parts:
                total[part.rows, part.columns] += part.weight
            sums = []
            for part in parts:
                work.checkpoint()
                share = part.weight / total[part.rows, part.columns]
                of_planes = (self._patches.pixels(part) * share).sum((1, 2), np.float64)
                sums.append(np.append(of_planes, share.sum(dtype=np.float64)))
            found[window] = [part.centre for part in parts], sums

        work.run("averages", add, self.windows)
        totals = np.zeros((len(self._cells.centres), self._channels + 1))
        for window in self.windows:  # in this order, whichever was done first
            centres, sums = found[window]
            totals[centres] += sums
        averages: Real = (totals[:, :-1] / np.maximum(totals[:, -1:], TINY)).astype(np.float32)
        return averages

    def join(self, window: Window, averages: Real, checkpoint: Checkpoint) -> tuple[Real, Real]:
        """Compute the two terms of equation (7), both (C, rows, columns)."""
        shape = (window.bottom - window.top, window.right - window.left)
        deviations, feathered = np.zeros((2, self._channels, *shape), np.float32)
        total, norm = np.zeros((2, *shape), np.float32)
        for part in self._cells.parts(window):
            checkpoint()
            there = (part.rows, part.columns)
            total[there] += part.weight
            norm[there] += np.square(part.weight)
            deviations[:, *there] += self._patches.pixels(part) * part.weight
            feathered[:, *there] += averages[part.centre, :, None, None] * part.weight
        deviations -= feathered
        deviations /= np.sqrt(norm)
        feathered /= total
        return deviations, feathered

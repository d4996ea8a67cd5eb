"""Where each cell of a pattern is best taken from in a texture: a source for every cell.

The patch that is compared is a square about the cell's centre with sides of one and a half spacings: it holds the cell
and where it blends most with its neighbours. Patches chosen for the cell alone stand out from what surrounds them in
the texture, and have a halo in the joins. All of the blend zone lies inside the texture, as for sources that are drawn
at random.

References
----------
Harrison, "Patchwork texture synthesis", technical report, Monash University, 2002, section 5.
"""

import numpy as np

from ..arrays import Ints, Real
from ..parallel import Work
from .best_places import Matches, PatternPatches, best_matches
from .cells import Cells

HALF = 0.75  # of a square's side, in spacings


def match_cells(
    texture: Real, pattern: Real, cells: Cells, *, peak: float, candidates: int, seed: int, work: Work
) -> Matches:
    """The source of every cell that matches the pattern best, among some candidates or all.

    Parameters
    ----------
    texture : ndarray of float32, shape (H', W', C)
        At least `microtexture.patchwork.cells.least_sample` pixels a side.
    pattern : ndarray of float32, shape (H, W, C)
        Of the size of the cells' plane; its values are in the texture's unit.
    cells : Cells
        Of a plane, not of a torus.
    peak : float
        Of the texture's values, which are in [0, ``peak``].
    candidates : int
        How many places are compared for each cell; 0: all. From one seed, more of them include fewer.
    seed : int
    work : Work
        Its stage ``"matching"``.

    Returns
    -------
    Matches
        For each of ``cells.count`` cells.
    """
    boxes = _squares(cells)
    compared = boxes - np.repeat(cells.centres, 2, axis=1)
    seen = np.all(cells.zones[:, ::2] < cells.zones[:, 1::2], axis=1, keepdims=True)
    zones = np.where(seen, cells.zones, compared)
    first = -np.minimum(zones[:, ::2], compared[:, ::2])
    last = np.array(texture.shape[:2]) - np.maximum(zones[:, 1::2], compared[:, 1::2])
    patches = PatternPatches(cells.centres, boxes, first, last)
    return best_matches(texture, pattern, patches, peak=peak, candidates=candidates, seed=seed, work=work)


def _squares(cells: Cells) -> Ints:
    """What is compared of the plane for every cell: what its square has of it, or the border where it is nearest."""
    half = round(HALF * cells.unit)
    size = np.array((cells.height, cells.width))
    boxes = np.empty((cells.count, 4), np.int64)
    boxes[:, ::2] = np.clip(cells.centres - half, 0, np.maximum(size - half - 1, 0))
    boxes[:, 1::2] = np.clip(cells.centres + half + 1, np.minimum(half + 1, size), size)
    return boxes

"""Cell matching: for every cell of a pattern the source in a texture that is nearest to it.

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
    """Find the source of every cell that is nearest to the pattern, among some candidates or all.

    Parameters
    ----------
    texture : ndarray of float32, shape (H', W', C)
        At least `microtexture.patchwork.jittered_cells.least_sample` pixels a side.
    pattern : ndarray of float32, shape (H, W, C)
        The pattern, of the size of the cells' plane; values in the texture's unit.
    cells : Cells
        Cells of a plane, not of a torus.
    peak : float
        Greatest value of the texture; the least is 0.
    candidates : int
        Number of places that are compared for each cell; 0 for all. For one seed, the candidates of a smaller number
        are a subset of those of a larger one.
    seed : int
        Not negative; draws the candidates.
    work : Work
        Its stage ``"matching"``.

    Returns
    -------
    Matches
        One of each of ``cells.count`` cells.
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
    """Cut to the plane every cell's square, about the place of the plane that is nearest to its centre."""
    half = round(HALF * cells.unit)
    size = np.array((cells.height, cells.width))
    boxes = np.empty((cells.count, 4), np.int64)
    boxes[:, ::2] = np.clip(cells.centres - half, 0, np.maximum(size - half - 1, 0))
    boxes[:, 1::2] = np.clip(cells.centres + half + 1, np.minimum(half + 1, size), size)
    return boxes

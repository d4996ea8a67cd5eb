"""Video patchwork with patches that stand still: what stands still in the clip does so in the output.

First stage: every cell has a sequence of its own, made of the clip's frames rearranged in time
(`microtexture.patchwork.transitions`). Second stage: every frame is a patchwork of the sequences' frames with the same
arrangement of cells. The two are combined: no sequence is ever stored. With the weights w_i of the cells, ŵ_i = w_i /
√(Σ w_i²), α and β of the transitions and the average image A,

    O(x, t) = Σ ŵ_i (α I(x_i, t₁) + β I(x_i, t₂) + (1 − α − β) A(x_i) − a_i) + Σ a_i w_i / Σ w_i,   x_i = x − p_i + q_i,

where a_i is the mean colour that patch i varies about: that of the clip in a texture, a local one in a transfer.

References
----------
Harrison, "Patchwork texture synthesis", 2002, sections 4 and 5, equations (2), (6) and (7).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..arrays import Bytes, Ints, PartDone, Real
from ..parallel import Team
from .cells import Cells, Window
from .transitions import Transitions

STRIP = 128  # rows: lower strips hold less outside of the round cells, but take more calls than that saves
TINY = 1e-30  # instead of 0, for a cell that has a part of no pixel


class PaddedClip:
    """Clip as planes with a mirrored margin, and its average image.

    Parameters
    ----------
    video : ndarray of uint8, shape (T, H, W, C)
    margin : int
        Pixels by which patches reach over its border; see `Cells.margin`.

    Attributes
    ----------
    planes : ndarray of uint8, shape (T, C, H + 2 margin, W + 2 margin)
    average : ndarray of float32, shape (C, H + 2 margin, W + 2 margin)
        A(x), the mean of every pixel over time; exact for a video whose frames are all equal.
    margin : int
    """

    def __init__(self, video: Bytes, margin: int = 0) -> None:
        frames, height, width, channels = video.shape
        self.planes = np.empty((frames, channels, height + 2 * margin, width + 2 * margin), np.uint8)
        total = np.zeros(self.planes.shape[1:], np.uint32)
        around = [(0, 0), (margin, margin), (margin, margin)]
        for planes, frame in zip(self.planes, video, strict=True):
            planes[:] = np.pad(frame.transpose(2, 0, 1), around, mode="symmetric")
            total += planes
        self.average: Real = (total / frames).astype(np.float32)
        self.margin = margin


@dataclass(frozen=True)
class _Patch:
    """Place of a cell, or of a part of it, in a frame and in the clip, and its weights, not yet normalised."""

    cell: int
    place: tuple[slice, slice]
    source: tuple[slice, slice]
    weight: Real


class VideoPatchwork:
    """Video patchwork, any frame of which can be computed.

    Parameters
    ----------
    clip : Clip
        With the margin of ``cells`` for these sources.
    cells : Cells
    sources : ndarray of int, shape (count of cells, 2)
        q_i in the clip without its margin.
    transitions : Transitions
        A sequence for each cell.
    means : ndarray of float32, shape (count of cells, C), optional
        a_i; without them the local ones of a transfer, each patch's mean in the average image.
    """

    def __init__(
        self, clip: PaddedClip, cells: Cells, sources: Ints, transitions: Transitions, means: Real | None = None
    ) -> None:
        self._clip, self._transitions = clip, transitions
        self._patches: list[_Patch] = []
        self._norms = np.empty((cells.height, cells.width), np.float32)
        ratios = np.empty_like(self._norms)
        for top in range(0, cells.height, STRIP):
            window = Window(top, min(top + STRIP, cells.height), 0, cells.width)
            strip = slice(top, window.bottom)
            self._lay(cells, window, sources + clip.margin, self._norms[strip], ratios[strip])
        shares = self._norms * ratios
        if means is None:
            means = self._local_means(cells.count, shares)
        self._still: Real = np.zeros((len(clip.average), cells.height, cells.width), np.float32)
        for patch in self._patches:
            self._still[:, *patch.place] += means[patch.cell][:, None, None] * patch.weight
        self._still *= shares - self._norms

    def _lay(self, cells: Cells, window: Window, sources: Ints, norms: Real, ratios: Real) -> None:
        """Lay the patches of a window; set ``norms`` to 1 / √(Σ w_i²) and ``ratios`` to √(Σ w_i²) / Σ w_i."""
        parts = cells.parts(window)
        totals, squares = np.zeros((2, *ratios.shape), np.float32)
        for part in parts:
            totals[part.rows, part.columns] += part.weight
            squares[part.rows, part.columns] += part.weight**2
        np.divide(1, np.sqrt(squares), out=norms)
        np.divide(1, norms * totals, out=ratios)
        for part in parts:
            cell = int(cells.cell[part.centre])
            y, x = (sources[cell] + part.source).tolist()
            rows, columns = part.rows, part.columns
            self._patches.append(
                _Patch(
                    cell,
                    (slice(window.top + rows.start, window.top + rows.stop), columns),
                    (slice(rows.start + y, rows.stop + y), slice(columns.start + x, columns.stop + x)),
                    part.weight,
                )
            )

    def _local_means(self, count: int, per_weight: Real) -> Real:
        """Compute every patch's mean in the average image, each pixel weighted by the patch's share of it."""
        sums = np.zeros((count, len(self._clip.average) + 1))
        for patch in self._patches:
            shares = patch.weight * per_weight[patch.place]
            sums[patch.cell, :-1] += (self._clip.average[:, *patch.source] * shares).sum((1, 2), np.float64)
            sums[patch.cell, -1] += shares.sum(dtype=np.float64)
        means: Real = (sums[:, :-1] / np.maximum(sums[:, -1:], TINY)).astype(np.float32)
        return means

    def frame(self, number: int) -> Real:
        """Compute frame ``number`` of the output, (H, W, C); values may lie outside the clip's range."""
        mix = self._transitions.mix(number)
        planes = np.zeros_like(self._still)
        for patch in self._patches:
            source = slice(None), *patch.source
            alpha, beta = mix.alpha[patch.cell], mix.beta[patch.cell]
            values = self._clip.planes[mix.first[patch.cell]][source] * alpha
            if beta:
                values += self._clip.planes[mix.second[patch.cell]][source] * beta
                values += self._clip.average[source] * (1 - alpha - beta)
            values *= patch.weight
            planes[:, *patch.place] += values
        planes *= self._norms
        planes += self._still
        return planes.transpose(1, 2, 0)


def frames_in_order(frame: Callable[[int], Real], count: int, threads: int, report: PartDone) -> Iterator[Real]:
    """Compute frames 0 … count − 1 and yield them in order; as many are computed, and held, as there are threads.

    Parameters
    ----------
    frame : callable
        Computes the frame of a number.
    count : int
        Number of frames.
    threads : int
        The result does not depend on it.
    report : callable ``(part)``
        Called with the part that is done, 0–1; what it raises stops the work.

    Yields
    ------
    ndarray of float32
    """
    finished: dict[int, Real] = {}

    def compute(number: int) -> None:
        finished[number] = frame(number)

    def report_of(numbers: range, part: float) -> None:
        report((numbers.start + part * len(numbers)) / count)

    with Team(threads) as team:
        for first in range(0, count, threads):
            numbers = range(first, min(first + threads, count))
            team.run(compute, numbers, partial(report_of, numbers))
            for number in numbers:
                yield finished.pop(number)

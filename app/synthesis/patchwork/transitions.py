"""Transitions in time: sequences of any length from the frames of a clip, rearranged in time only.

Frames p_i of the new sequence are frames q_i of the clip, and between p_i and p_{i+1} the part of the clip
around q_i passes over into the part around q_{i+1}:

    N(x, t) = (w₁ I(x, t − p_i + q_i) + w₂ I(x, t − p_{i+1} + q_{i+1}) − A(x)) / √(w₁² + w₂²) + A(x),

with w₁ = ½ + ½ cos(πu), w₂ = ½ − ½ cos(πu), u = (t − p_i) / (p_{i+1} − p_i) and the average image A. As w₁ + w₂ = 1,
what does not move stays; the division keeps the deviation of what does.

References
----------
Harrison, "Patchwork texture synthesis", 2002, section 4, equations (3) to (6).
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Double, Ints, Real


def longest_interval(clip: int, frames: int, loop: bool) -> int:
    """Find the greatest number of frames between transitions for which a clip is long enough.

    Parameters
    ----------
    clip : int
        Frames of the clip, at least 1.
    frames : int
        Frames of the sequence.
    loop : bool
        Whether the sequence is circular.

    Returns
    -------
    int

    Examples
    --------
    >>> longest_interval(72, 72, loop=True), longest_interval(24, 240, loop=False)
    (71, 10)
    """
    return next(interval for interval in range(frames, 0, -1) if _Arrangement(frames, interval, loop).span <= clip)


@dataclass(frozen=True)
class FrameMix:
    """Composition of one frame of each of n sequences: α I(first) + β I(second) + (1 − α − β) A.

    ``first`` and ``second`` are frames of the clip; α² + β² = 1.
    """

    first: Ints
    second: Ints
    alpha: Real
    beta: Real


class Transitions:
    """Transition points of n independent sequences, and the parts of the clip between which each passes over.

    The transition points are jittered: one in the middle half of each of equal parts of the sequence that are at most
    ``interval`` frames long. The clip's frames around them are drawn at random among those for which every frame
    that is used lies inside the clip.

    Parameters
    ----------
    sequences : int
        n, the number of sequences.
    clip : int
        Frames of the clip.
    frames : int
        Frames of a sequence.
    interval : int
        1 ≤ interval ≤ `longest_interval`; 1 makes every frame a frame of the clip at random.
    loop : bool
        Whether the last frame of a sequence continues in its first.
    rng : numpy.random.Generator
    """

    def __init__(
        self, sequences: int, clip: int, frames: int, interval: int, *, loop: bool, rng: np.random.Generator
    ) -> None:
        arrangement = _Arrangement(frames, interval, loop)
        self._edges = arrangement.edges
        p = rng.integers(arrangement.low, arrangement.high, (sequences, len(arrangement.low)))
        if loop:
            p[:, 0], p[:, -1] = p[:, -2] - frames, p[:, 1] + frames
        begin, end = np.zeros_like(p), np.full_like(p, frames - 1)
        begin[:, 1:], end[:, :-1] = p[:, :-1] + 1, p[:, 1:] - 1
        if not loop:
            begin, end = np.maximum(begin, 0), np.minimum(end, frames - 1)
        inner = slice(1, -1) if loop else slice(None)
        q = np.empty_like(p)
        q[:, inner] = rng.integers((p - begin)[:, inner], (clip + p - end)[:, inner])
        if loop:
            q[:, 0], q[:, -1] = q[:, -2], q[:, 1]
        self._p, self._shift = p, q - p

    def mix(self, frame: int) -> FrameMix:
        """Compute the composition of frame number ``frame``, 0 ≤ frame < ``frames``, of every sequence."""
        rows, column = self._interval(frame)
        w1, w2 = self._weights(frame, rows, column)
        scale = 1 / np.hypot(w1, w2)
        first = frame + self._shift[rows, column]
        # Where a sequence is at a transition point, the other part counts for nothing and may lie outside the clip.
        second = np.where(w2 == 0, first, frame + self._shift[rows, column + 1])
        return FrameMix(first, second, (w1 * scale).astype(np.float32), (w2 * scale).astype(np.float32))

    def sources(self, frame: int) -> Double:
        """Compute where in the clip every sequence's frame comes from, w₁ q_i + w₂ q_{i+1}, for pictures."""
        rows, column = self._interval(frame)
        w1, w2 = self._weights(frame, rows, column)
        q = self._p + self._shift
        between: Double = w1 * q[rows, column] + w2 * q[rows, column + 1]
        return between

    def _interval(self, frame: int) -> tuple[Ints, Ints]:
        """Number the sequences, and the transition point that a frame follows in each."""
        part = int(np.searchsorted(self._edges, frame, side="right")) - 1
        return np.arange(len(self._p)), np.where(self._p[:, part] <= frame, part, part - 1)

    def _weights(self, frame: int, rows: Ints, column: Ints) -> tuple[Double, Double]:
        begin, end = self._p[rows, column], self._p[rows, column + 1]
        cosine = np.cos(np.pi * (frame - begin) / (end - begin))
        return 0.5 + 0.5 * cosine, 0.5 - 0.5 * cosine


class _Arrangement:
    """Parts of a sequence, with one before and one after it, and the bounds of the points in them.

    ``edges[k]`` is the first frame of part k; its point lies in ``low[k]`` … ``high[k] − 1``.
    """

    def __init__(self, frames: int, interval: int, loop: bool) -> None:
        count = -(-frames // interval)
        edges = np.arange(-1, count + 2) * frames // count
        lengths = np.diff(edges)
        room = (lengths + 1) // 2
        self.edges = edges[:-1]
        self.low = self.edges + (lengths - room) // 2
        self.high = self.low + room
        self._frames, self._count, self._loop = frames, count, loop

    @property
    def span(self) -> int:
        """Most frames of a clip that are used between two neighbours of a point."""
        if self._loop and self._count < 3:
            return 2 * self._frames // self._count - 1
        first, last = self.low[:-2] + 1, self.high[2:] - 2
        if not self._loop:
            first, last = np.maximum(first, 0), np.minimum(last, self._frames - 1)
        return int((last - first).max()) + 1

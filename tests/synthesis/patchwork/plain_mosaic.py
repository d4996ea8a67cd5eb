"""The three-dimensional patchwork as a plain sum over its points, in double precision."""

import numpy as np

from tests.synthesis.full_sums import mirrored


def points_of(rng, shape, clip, grid, interval, wraps):
    """The points of a mosaic in the output and the places of the clip, as they are drawn: (3, N) and (N, 3)."""
    steps = (interval, grid, grid)
    blocks = np.indices([-(-n // step) for n, step in zip(shape, steps, strict=True)]).reshape(3, -1)
    points, sources = np.empty(blocks.shape, int), np.empty(blocks.shape, int)
    for axis, (length, source, step, circular) in enumerate(zip(shape, clip, steps, wraps, strict=True)):
        count = -(-length // step)
        points[axis] = rng.integers(blocks[axis] * length // count, (blocks[axis] + 1) * length // count)
        most = [(length - 1) // 2, length // 2] if circular else [points[axis], length - 1 - points[axis]]
        before, after = (np.minimum(int(1.75 * step), np.broadcast_to(limit, points[axis].shape)) for limit in most)
        sources[axis] = rng.integers(before, source - after)
    return points, sources.T


def frame_of(video, shape, points, sources, number, *, grid, interval, sharpness, wraps, ends):
    """A frame (H, W) of one channel: Σ w (I − a) / √Σ w² + a with w = d^(−f), less R^(−f) where the weights end."""
    total, squares, mean = np.zeros(shape[1:]), np.zeros(shape[1:]), video.mean()
    for point, source in zip(points.T, sources, strict=True):
        away = [np.array([number]) - point[0], np.arange(shape[1]) - point[1], np.arange(shape[2]) - point[2]]
        for axis, circular in enumerate(wraps):
            if circular:
                back = (shape[axis] - 1) // 2
                away[axis] = (away[axis] + back) % shape[axis] - back
        d = np.sqrt((away[0][0] * grid / interval) ** 2 + away[1][:, None] ** 2 + away[2] ** 2)
        weight = np.maximum(d, 0.03) ** -float(sharpness)
        if ends:
            weight = np.maximum(weight - (1.75 * grid) ** -float(sharpness), 0)
        places = [mirrored(a + q, n) for a, q, n in zip(away, source, video.shape, strict=False)]
        total += (video[np.ix_(*places)][0, :, :, 0] - mean) * weight
        squares += weight**2
    return total / np.sqrt(squares) + mean

"""Samples with near matches and exact ones, and the plain distances of their windows."""

import numpy as np


def sample(height=20, width=23, channels=3, seed=0):
    """Coarse grain of few levels, so that there are near matches and exact ones."""
    rng = np.random.default_rng(seed)
    coarse = np.kron(rng.integers(0, 4, (-(-height // 3), -(-width // 4), 1)) * 60, np.ones((3, 4, 1)))
    return (coarse[:height, :width] + rng.integers(0, 6, (height, width, channels))).astype(np.float32)


def far_from_zero():
    return sample() / 60 + 60000


def of_two_worlds():
    """Fine grain on black and on white: whatever is taken as zero, the squares of one of them are large."""
    h = sample()
    h[:, 12:] += 65535 - 300
    return h


def distances(h, window, known, weights):
    """Of one window, known in part, to that around every pixel of the sample, in double precision; else infinite."""
    n, (height, width) = len(window) // 2, h.shape[:2]
    framed = np.pad(h.astype(np.float64), ((n, n), (n, n), (0, 0)), constant_values=np.nan)
    total = np.zeros((height, width))
    for i, j in np.argwhere(known):
        difference = framed[i : i + height, j : j + width] - window[i, j]
        total += weights[i, j] * np.square(difference).sum(2)
    return np.nan_to_num(total, nan=np.inf)

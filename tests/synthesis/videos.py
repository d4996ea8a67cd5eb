"""Videos to synthesise from, and what several tests measure of them."""

import numpy as np
from scipy.ndimage import gaussian_filter


def noise(frames=40, height=64, width=64, channels=1, seed=0):
    """Independent values of mean 128 and deviation 30, (T, H, W, C) uint8."""
    rng = np.random.default_rng(seed)
    return rng.normal(128, 30, (frames, height, width, channels)).round().clip(0, 255).astype(np.uint8)


def still(frames=40, height=64, width=64, channels=3, seed=0):
    """One frame of noise again and again."""
    return np.broadcast_to(noise(1, height, width, channels, seed), (frames, height, width, channels))


def waves(frames=40, height=64, width=64, seed=0):
    """Every pixel swings with a period of 24 frames, its phase a smooth function of the place."""
    phase = gaussian_filter(np.random.default_rng(seed).normal(0, 200, (height, width)), 8)
    t = np.arange(frames)[:, None, None]
    return np.round(128 + 100 * np.sin(2 * np.pi * t / 24 + phase))[..., None].astype(np.uint8)


def size_of(difference):
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(difference, dtype=np.float64))))


def steps(video, axis):
    """Sizes of the steps from each place along an axis to the next, the last of them back to the first."""
    video = np.moveaxis(np.asarray(video, np.float64), axis, 0)
    return np.array([size_of(here - there) for here, there in zip(video, np.roll(video, -1, 0), strict=True)])

"""Images to synthesise from, and what several tests measure of them."""

import numpy as np
from imagecodecs import imread

from app.settings import ROOT


def image(height, width, channels=3, seed=0):
    """Correlated channels with values of 0–255, (H, W, C) float32."""
    rng = np.random.default_rng(seed)
    common = rng.uniform(0, 100, (height, width, 1))
    return (common + rng.uniform(0, 155, (height, width, channels))).astype(np.float32)


def whole(spot):
    """A spot as an image (H, W, C) in double precision."""
    return spot.rows(0, spot.height).transpose(1, 2, 0).astype(np.float64)


def correlations(picture):
    """(1/MN) Σ_u z_c(u) z_d(u + x) of the centred picture, for all channels c, d and lags x."""
    z = np.fft.fft2(picture - picture.mean((0, 1)), axes=(0, 1))
    products = z.conj()[:, :, :, None] * z[:, :, None, :]
    return np.fft.ifft2(products, axes=(0, 1)).real / (picture.shape[0] * picture.shape[1])


def photograph(name, x, y, side=256):
    """A crop of a bundled photograph."""
    file = next((ROOT / "samples").glob(f"{name}.*"))
    return np.asarray(imread(file))[y : y + side, x : x + side, :3].astype(np.float32)


def covariance(picture):
    """Of the channels of a picture, (C, C)."""
    return np.atleast_2d(np.cov(picture.reshape(-1, picture.shape[2]).T.astype(np.float64), bias=True))


def along_colours(found, wanted):
    """The greatest error of a covariance in units of the deviations along the axes of the wanted one."""
    variances, axes = np.linalg.eigh(wanted)
    there = variances > 1e-8 * variances[-1]
    axes = axes[:, there] / np.sqrt(variances[there])
    return np.abs(axes.T @ (found - wanted) @ axes).max()

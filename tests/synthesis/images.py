"""Images to synthesise from, and what several tests measure of them."""

import numpy as np


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

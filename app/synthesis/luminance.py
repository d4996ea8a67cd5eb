"""Luminance: the grey picture of a colour picture."""

import numpy as np

from .arrays import Real

WEIGHTS = (0.2126, 0.7152, 0.0722)  # of red, green and blue in sRGB (ITU-R BT.709)


def luminance(h: Real) -> Real:
    """Compute the weighted mean of the channels: BT.709's weights for three, the plain mean for any other number.

    Values are taken as they are stored, without undoing the display's gamma.

    Parameters
    ----------
    h : ndarray of float32, shape (H, W) or (H, W, C)

    Returns
    -------
    ndarray of float32, shape (H, W)

    Examples
    --------
    >>> import numpy as np
    >>> luminance(np.array([[[255, 0, 0], [0, 255, 0]]], np.float32)).round().tolist()
    [[54.0, 182.0]]
    """
    if h.ndim == 2:
        return h
    channels = h.shape[2]
    weights = WEIGHTS if channels == len(WEIGHTS) else (1 / channels,) * channels
    grey = h[:, :, 0] * np.float32(weights[0])
    for channel in range(1, channels):
        grey += h[:, :, channel] * np.float32(weights[channel])
    return grey

"""Principal axes of an image's colours: channels that are not correlated, the strongest first."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Double, Real


@dataclass(frozen=True)
class ColourSpace:
    """A rotation of colours about their mean.

    Parameters
    ----------
    mean : ndarray of float64, shape (C,)
    axes : ndarray of float64, shape (C, C)
        Orthonormal rows, each with its coefficient of greatest magnitude above 0.
    variances : ndarray of float64, shape (C,)
        Along the axes, descending.

    Examples
    --------
    >>> import numpy as np
    >>> grey = np.random.default_rng(0).random((8, 8), np.float32)
    >>> space = ColourSpace.from_planes(np.stack([grey, 2 * grey, 2 * grey]))
    >>> np.round(space.axes[0], 4), bool(np.allclose(space.variances[1:], 0))
    (array([0.3333, 0.6667, 0.6667]), True)
    """

    mean: Double
    axes: Double
    variances: Double

    @classmethod
    def from_planes(cls, planes: Real) -> "ColourSpace":
        """Find the principal axes of an image, planes (C, H, W)."""
        mean = planes.mean(axis=(1, 2), dtype=np.float64)
        centred = [plane - np.float32(value) for plane, value in zip(planes, mean, strict=True)]
        # Not a matrix product, whose sum would depend on the number of threads that BLAS takes.
        covariance = np.array([[np.mean(a * b, dtype=np.float64) for b in centred] for a in centred])
        variances, vectors = np.linalg.eigh(covariance)
        axes = vectors.T[::-1]
        signs = np.sign(np.take_along_axis(axes, np.abs(axes).argmax(axis=1)[:, None], axis=1))
        return cls(mean, axes * signs, np.maximum(variances[::-1], 0))

    def forward(self, planes: Real) -> Real:
        """Turn colours (C, H, W) into coordinates along the axes, of mean 0 for the image whose axes they are."""
        return _combine(self.axes, planes, -self.axes @ self.mean)

    def back(self, coordinates: Real) -> Real:
        """Turn coordinates (C, H, W) along the axes back into colours."""
        return _combine(self.axes.T, coordinates, self.mean)


def _combine(weights: Double, planes: Real, offsets: Double) -> Real:
    """``weights @ planes + offsets``, in the calling thread."""
    result = np.empty_like(planes)
    for index, (row, offset) in enumerate(zip(weights.astype(np.float32), offsets.astype(np.float32), strict=True)):
        result[index] = offset
        for weight, plane in zip(row, planes, strict=True):
            result[index] += weight * plane
    return result

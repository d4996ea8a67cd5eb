"""Mosaic of the sub-bands of a steerable pyramid."""

import numpy as np

from app.methods.context import Progress
from app.synthesis.arrays import Real
from app.synthesis.pyramid.heeger_bergen import ChannelBands, Decomposition
from app.synthesis.pyramid.pyramid import Band

CELL = 256  # pixels of a side of what is shown of a sub-band, at most
GAP = 4  # between the sub-bands


def mosaic(plane: Real, decomposition: Decomposition, progress: Progress) -> Real:
    """The bands' upper left corners: a row for each scale, a column for each orientation, the residuals below.

    Coarse bands are enlarged to the image's scale. Mid-grey is a band's mean, black and white are three deviations
    from it.
    """
    channel, scales = ChannelBands(plane, decomposition), range(decomposition.scales)
    rows = [[Band(scale, number) for number in range(decomposition.orientations)] for scale in scales]
    rows.append([Band(0, None), Band(decomposition.scales, None)])
    high, wide = (min(side, CELL) + GAP for side in plane.shape)
    picture = np.full((len(rows) * high, max(2, decomposition.orientations) * wide), 0.25, np.float32)
    for row, bands in enumerate(rows):
        for column, band in enumerate(bands):
            progress("sub-bands", (row + column / len(bands)) / len(rows))
            values = channel.band(band)
            y, x = (np.arange(min(side, CELL)) * n // side for side, n in zip(plane.shape, values.shape, strict=True))
            cell = (values[np.ix_(y, x)] - values.mean()) / (6 * values.std() or 1) + 0.5
            picture[row * high :, column * wide :][: len(y), : len(x)] = cell
    return picture[:-GAP, :-GAP]

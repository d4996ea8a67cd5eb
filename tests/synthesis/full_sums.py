"""Equations (1), (2) and (7) of the report as they stand, in double precision: every cell at every pixel."""

from collections.abc import Iterator
from typing import Any

import numpy as np


def mirrored(places, size):
    """Indices beyond an axis of ``size`` pixels, reflected into it."""
    places = places % (2 * size)
    return np.where(places < size, places, 2 * size - 1 - places)


def offsets(length, centre, tileable, small):
    """From a centre to the places of an axis: once each, or by several turns of a torus that is ``small``."""
    away = np.arange(length) - centre
    if not tileable:
        return [away]
    if small <= length // 2:
        return [(away + length // 2) % length - length // 2]
    turns = [away + turn * length for turn in range(-9, 10)]
    return [turn for turn in turns if (np.abs(turn) <= small).any()]


def cells_at(cells, tileable) -> Iterator[tuple[int, np.ndarray, np.ndarray, np.ndarray]]:
    """Every cell with the distances down and across, and its weights, (H, W)."""
    size = np.array((cells.height, cells.width))
    inside = ((cells.centres >= 0) & (cells.centres < size)).all(1)
    small = int(2 * cells.unit)
    for centre, cell in zip(cells.centres, cells.cell, strict=True):
        if tileable and not inside[(cells.centres == centre).all(1)].any():
            continue
        for down in offsets(cells.height, centre[0], tileable, small):
            for across in offsets(cells.width, centre[1], tileable, small):
                d = np.hypot(down[:, None], across)
                weight = np.maximum(d, 1e-6) ** -cells.sharpness
                if tileable:
                    weight = weight * ((np.abs(down) <= max(small, cells.height // 2))[:, None])
                    weight = weight * (np.abs(across) <= max(small, cells.width // 2))
                yield int(cell), down, across, weight


def patch(picture, source, down, across):
    """What a cell shows of a picture, (H, W, C)."""
    rows, columns = mirrored(down + source[0], picture.shape[0]), mirrored(across + source[1], picture.shape[1])
    return picture[np.ix_(rows, columns)].astype(np.float64)


def patchwork_sum(h: Any, cells: Any, sources: Any, tileable: bool, mean: Any = None) -> Any:
    """Equation (2)."""
    mean = h.mean((0, 1), np.float64) if mean is None else mean
    total, squares = np.zeros((cells.height, cells.width, h.shape[2])), np.zeros((cells.height, cells.width))
    for cell, down, across, weight in cells_at(cells, tileable):
        total += (patch(h, sources[cell], down, across) - mean) * weight[:, :, None]
        squares += weight**2
    return total / np.sqrt(squares)[:, :, None] + mean


def transfer_sum(texture: Any, cells: Any, sources: Any) -> Any:
    """Equation (7), the averages by the shares w_i / Σ w; and the blended averages."""
    every = list(cells_at(cells, tileable=False))
    weights = sum(weight for *_, weight in every)
    squares = sum(weight**2 for *_, weight in every)
    deviations, blended = np.zeros((2, cells.height, cells.width, texture.shape[2]))
    for cell, down, across, weight in every:
        shown, share = patch(texture, sources[cell], down, across), (weight / weights)[:, :, None]
        average = (shown * share).sum((0, 1)) / share.sum()
        deviations += (shown - average) * weight[:, :, None]
        blended += average * share
    return deviations / np.sqrt(squares)[:, :, None] + blended, blended

"""Drawing of the bundled samples that no photograph gives: ours, in the public domain (CC0).

Usage: drawn_samples.py [DIRECTORY]. Each is a function of nothing but the seeds below: anybody can make it again.
"""

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter

SIDE = 256
SAMPLES = Path(__file__).resolve().parent.parent / "samples"

Pixels = NDArray[np.uint8]


def two_sinusoids() -> Pixels:
    """The sum of two oscillations that are periodic on the square: grey, and as sparse a spectrum as can be."""
    y, x = np.mgrid[:SIDE, :SIDE] / SIDE
    waves = np.sin(2 * np.pi * (10 * x + 3 * y)) + np.sin(2 * np.pi * (-4 * x + 11 * y))
    return _levels(127.5 + 56 * waves)


def lit_plaster() -> Pixels:
    """Rough plaster under a light from the right: homogeneous but for a change of brightness from side to side."""
    noise = np.random.default_rng(20).normal(size=(SIDE, SIDE))
    fine, coarse = (_standard(gaussian_filter(noise, deviation, mode="wrap")) for deviation in (1.1, 3.5))
    surface = 150 * (1 + 0.085 * fine + 0.06 * coarse)
    light = np.linspace(0.5, 1.45, SIDE)
    return _levels(surface[:, :, None] * light[None, :, None] * np.array([1.02, 0.98, 0.9]))


def rolled_paint() -> Pixels:
    """Wall paint from a roller, its beads flattened at the top, lit from above on the left."""
    noise = np.random.default_rng(7).normal(size=(SIDE, SIDE))
    beads = _standard(gaussian_filter(noise, 2.0, mode="wrap") - gaussian_filter(noise, 5.0, mode="wrap"))
    height = np.tanh(0.9 * beads)
    slope = sum(np.roll(height, -1, axis) - np.roll(height, 1, axis) for axis in (0, 1))
    shade = 1 + 0.13 * slope + 0.03 * height
    return _levels(168 * shade[:, :, None] * np.array([0.78, 0.98, 0.94]))


DRAWN = {"two_sinusoids": two_sinusoids, "lit_plaster": lit_plaster, "rolled_paint": rolled_paint}


def _standard(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(values / values.std())


def _levels(values: NDArray[np.float64]) -> Pixels:
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


if __name__ == "__main__":
    directory = Path(sys.argv[1]) if len(sys.argv) > 1 else SAMPLES
    for name, draw in DRAWN.items():
        Image.fromarray(draw()).save(directory / f"{name}.png", optimize=True)

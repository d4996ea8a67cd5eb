"""Accuracy of the structure index in telling micro-textures: ``python -m benchmarks.meter`` prints one table.

Crops of 256² of the bundled photographs; a photograph counts as one, however many crops it gives. Micro-textures
against macro-textures and what is structured. Three more columns ask the same of photographs halved in size, with what
is not stationary (a sky, a stained wall) among the structured ones, and with the bark of a fir, whose plates RPN loses,
counted as a macro-texture.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import NDArray
from PIL import Image

from app.samples import read_catalogue
from app.settings import ROOT
from app.synthesis.fourier.periodic import periodic_component
from app.synthesis.gaussian.rpn import rpn
from app.synthesis.luminance import luminance
from app.synthesis.structure import structure_index

Real = NDArray[np.float32]

SIDE = 256
PER_AXIS = 3  # crops along an axis at most, overlapping where the photograph is less than three times as long
DIRECTIONS = 4
DRAWS = 3
RESAMPLED = 2000
METER = "δ, σ = 2 (the meter)"
BARK = "bark_fir"


@dataclass(frozen=True)
class Photograph:
    """One photograph's crops, each with the score of every candidate."""

    name: str
    kind: str
    scores: dict[str, NDArray[np.float64]]


def spectrum(grey: Real) -> NDArray[np.complex128]:
    p = periodic_component(grey).astype(np.float64)
    return np.asarray(scipy.fft.fft2(p - p.mean()))


def frequencies() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    axis = 2 * np.pi * np.fft.fftfreq(SIDE)
    return np.meshgrid(axis, axis)


def lack(filtered: NDArray[np.float64]) -> float:
    """What δ is for the two differences, for one filter: 1 − ‖·‖₁ over its mean for a Gaussian texture."""
    return float(1 - np.sqrt(np.pi / 2) * np.abs(filtered).mean() / np.sqrt(np.square(filtered).mean()))


def along(grey: Real, sigma: float) -> list[float]:
    """Lack of the derivative in each of four directions."""
    x, y = frequencies()
    smooth = spectrum(grey) * np.exp(-(sigma**2) * (x**2 + y**2) / 2)
    angles = np.arange(DIRECTIONS) * np.pi / DIRECTIONS
    return [lack(scipy.fft.ifft2(1j * smooth * (np.cos(angle) * x + np.sin(angle) * y)).real) for angle in angles]


def band(grey: Real, sigma: float) -> NDArray[np.float64]:
    """Difference of Gaussians of deviation σ and 2σ."""
    x, y = frequencies()
    square = sigma**2 * (x**2 + y**2)
    return np.asarray(scipy.fft.ifft2(spectrum(grey) * (np.exp(-square / 2) - np.exp(-2 * square))).real)


def unevenness(grey: Real, sigma: float) -> float:
    """Log of the variation of local energy in a band, over windows of 4σ."""
    x, y = frequencies()
    window = np.exp(-((4 * sigma) ** 2) * (x**2 + y**2) / 2)
    energy = scipy.fft.ifft2(scipy.fft.fft2(np.square(band(grey, sigma))) * window).real
    return float(np.log(energy.std() / energy.mean()))


def uneven(grey: Real, sigma: float) -> float:
    """How much more uneven local energy is than in random phase textures of the crop."""
    draws = [unevenness(rpn(grey, seed=seed), sigma) for seed in range(DRAWS)]
    return unevenness(grey, sigma) - float(np.mean(draws))


def deltas(grey: Real) -> list[float]:
    return [structure_index(grey, sigma).delta for sigma in (1, 2, 4)]


CANDIDATES: dict[str, Callable[[Real], float]] = {
    "δ, σ = 0": lambda grey: structure_index(grey, 0).delta,
    "δ, σ = 1": lambda grey: structure_index(grey, 1).delta,
    METER: lambda grey: structure_index(grey, 2).delta,
    "δ, σ = 4": lambda grey: structure_index(grey, 4).delta,
    "z, σ = 0": lambda grey: structure_index(grey, 0).z,
    "z, σ = 2": lambda grey: structure_index(grey, 2).z,
    "mean δ of σ = 1, 2, 4": lambda grey: float(np.mean(deltas(grey))),
    "greatest δ of σ = 1, 2, 4": lambda grey: max(deltas(grey)),
    "greatest of 4 directions, σ = 1": lambda grey: max(along(grey, 1)),
    "greatest of 4 directions, σ = 2": lambda grey: max(along(grey, 2)),
    "least of 4 directions, σ = 2": lambda grey: min(along(grey, 2)),
    "band of σ = 1 … 2": lambda grey: lack(band(grey, 1)),
    "band of σ = 2 … 4": lambda grey: lack(band(grey, 2)),
    "local energy, σ = 1": lambda grey: uneven(grey, 1),
    "local energy, σ = 2": lambda grey: uneven(grey, 2),
    "δ, σ = 2, and local energy, σ = 1": lambda grey: structure_index(grey, 2).delta + 0.1 * uneven(grey, 1),
}


def crops(image: Image.Image, reduced: int) -> Iterator[Real]:
    """Grey crops of a photograph reduced by a whole number."""
    small = image.convert("RGB").reduce(reduced)
    grey = luminance(np.asarray(small, np.float32))
    tops, lefts = (np.linspace(0, side - SIDE, min(PER_AXIS, -(-side // SIDE))).astype(int) for side in grey.shape)
    for top in tops:
        for left in lefts:
            yield grey[top : top + SIDE, left : left + SIDE]


def photographs(reduced: int = 1) -> list[Photograph]:
    """Every bundled photograph that is large enough; neither scenes nor what was drawn."""
    found = []
    for entry in read_catalogue(ROOT / "samples"):
        image = Image.open(entry.path)
        if entry.kind in ("scene", "drawn") or min(image.size) < SIDE * reduced:
            continue
        greys = list(crops(image, reduced))
        scores = {name: np.array([score(grey) for grey in greys]) for name, score in CANDIDATES.items()}
        found.append(Photograph(entry.id, entry.kind, scores))
    return found


def wins(low: NDArray[np.float64], high: NDArray[np.float64]) -> float:
    """Chance that a crop of one photograph scores higher than one of another."""
    difference = high[:, None] - low
    return float((difference > 0).mean() + (difference == 0).mean() / 2)


def table(low: list[Photograph], high: list[Photograph]) -> dict[str, NDArray[np.float64]]:
    """By candidate: wins of every photograph of ``high`` (columns) over every one of ``low`` (rows)."""
    return {name: np.array([[wins(a.scores[name], b.scores[name]) for b in high] for a in low]) for name in CANDIDATES}


def chosen_inside(tables: dict[str, NDArray[np.float64]]) -> float:
    """AUC of "the best candidate", chosen for each pair of photographs by all the others."""
    stacked = np.stack(list(tables.values()))
    total = 0.0
    for row in range(stacked.shape[1]):
        for column in range(stacked.shape[2]):
            others = np.delete(np.delete(stacked, row, 1), column, 2)
            total += stacked[others.mean((1, 2)).argmax(), row, column]
    return float(total / stacked[0].size)


def cut(low: list[NDArray[np.float64]], high: list[NDArray[np.float64]]) -> float:
    """The threshold with the smallest mean error, a photograph counting as one; the middle of the best ones."""
    values = np.unique(np.concatenate([*low, *high]))
    middles = (values[1:] + values[:-1]) / 2
    wrong = np.mean([(each > middles[:, None]).mean(1) for each in low], 0)
    wrong += np.mean([(each <= middles[:, None]).mean(1) for each in high], 0)
    return float(np.median(middles[wrong <= wrong.min() + 1e-12]))


def left_out(low: list[NDArray[np.float64]], high: list[NDArray[np.float64]]) -> float:
    """Mean share of the crops of a photograph on the wrong side of the threshold that all the others give."""
    below = [(low[i] > cut(low[:i] + low[i + 1 :], high)).mean() for i in range(len(low))]
    above = [(high[i] <= cut(low, high[:i] + high[i + 1 :])).mean() for i in range(len(high))]
    return float((np.mean(below) + np.mean(above)) / 2)


def interval(ours: NDArray[np.float64], theirs: NDArray[np.float64]) -> tuple[float, float]:
    """95 % bootstrap interval, over photographs, of the gain in AUC."""
    rng = np.random.default_rng(0)
    gain = theirs - ours
    rows = rng.integers(0, gain.shape[0], (RESAMPLED, gain.shape[0]))
    columns = rng.integers(0, gain.shape[1], (RESAMPLED, gain.shape[1]))
    drawn = [gain[np.ix_(row, column)].mean() for row, column in zip(rows, columns, strict=True)]
    low, high = np.quantile(drawn, [0.025, 0.975])
    return float(low), float(high)


def kinds(found: list[Photograph], *more: str) -> tuple[list[Photograph], list[Photograph]]:
    """Micro-textures, and macro-textures with what is structured; ``more`` are kinds or names that join the latter."""
    high = [each for each in found if {each.kind, each.name} & {"macro-texture", "structured", *more}]
    return [each for each in found if each.kind == "micro-texture" and each not in high], high


def main() -> None:
    """Print the table."""
    found = photographs()
    micro, macro = kinds(found)
    tables = table(micro, macro)
    halved = table(*kinds(photographs(reduced=2)))
    others = [halved, table(*kinds(found, "non-stationary")), table(*kinds(found, BARK))]
    print(f"{len(micro)} micro-textures, {len(macro)} macro-textures and structured; crops of {SIDE}²")
    print(f"{'':36}{'AUC':>6}{'gain, 95 %':>18}{'left-out error':>16}{'halved':>8}{'sky, stains':>13}{'bark':>7}")
    for name in CANDIDATES:
        low, high = interval(tables[METER], tables[name])
        error = left_out([each.scores[name] for each in micro], [each.scores[name] for each in macro])
        figures = f"{tables[name].mean():6.3f}{f'{low:+.3f} … {high:+.3f}':>18}{error:16.3f}"
        print(
            f"{name:36}{figures}"
            + "".join(f"{each[name].mean():{n}.3f}" for each, n in zip(others, (8, 13, 7), strict=True))
        )
    inside = [chosen_inside(each) for each in (tables, *others)]
    print(
        f"{'the best, as the others choose':36}{inside[0]:6.3f}{'':34}{inside[1]:8.3f}{inside[2]:13.3f}{inside[3]:7.3f}"
    )


if __name__ == "__main__":
    main()

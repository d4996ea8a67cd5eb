"""Deviation of patches from the sums of all cells in double precision: ``python -m benchmarks.deviation``.

Equations (1), (2) and (7) of Harrison's report as they stand, on bundled samples, against what methods make with all
patches and with near ones: root mean square and maximum in levels of 255.
"""

import argparse
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from app.images.decode import Limits, decode
from app.settings import ROOT
from app.synthesis.parallel import Team, Work
from app.synthesis.patchwork.cells import Cells
from app.synthesis.patchwork.jittered_cells import jittered_cells
from app.synthesis.patchwork.patchwork import Patchwork
from app.synthesis.patchwork.transfer import rescale, transfer
from app.synthesis.patchwork.transitions import Transitions
from app.synthesis.patchwork.unbounded_cells import Reach, cells_with_reach
from app.synthesis.patchwork.video_patchwork import PaddedClip, VideoPatchwork
from benchmarks.kernel import THREADS
from tests.synthesis.full_sums import patchwork_sum, transfer_sum

SHARPNESSES = (1.0, 2.0, 3.0, 4.0, 6.0)
GRID, SIDE = 24, 256  # of a patchwork
PAINTED_GRID, PAINTED = 16, 192  # of a transfer

Real = NDArray[np.float32]
Double = NDArray[np.float64]
Made = Callable[[Reach], tuple[Double, Double]]


def crop(name: str, x: int, y: int, side: int) -> Real:
    """A square of a bundled photograph, or of a clip's first frame."""
    found = decode(next((ROOT / "samples").glob(f"{name}.*")), Limits())
    frames = found.pixels.reshape(-1, found.height, found.pixels.shape[-2], found.pixels.shape[-1])
    return frames[0, y : y + side, x : x + side].astype(np.float32)


def cells_of(side: int, grid: int, sharpness: float, tileable: bool) -> Cells:
    """Cells of a square plane."""
    return jittered_cells(side, side, grid=grid, sharpness=sharpness, tileable=tileable, seed=1)


def patchworks(sharpness: float, tileable: bool) -> Made:
    """A patchwork, and its sum."""
    h, near = crop("ballast_railway", 96, 96, 320), cells_of(SIDE, GRID, sharpness, tileable)
    sources = Patchwork(h, near, seed=1).sources
    expected = patchwork_sum(h, near, sources, tileable)

    def synthesize(reach: Reach) -> tuple[Double, Double]:
        work = Patchwork(h, cells_with_reach(near, reach, tileable=tileable), seed=1)
        return work.rows(0, SIDE).transpose(1, 2, 0).astype(np.float64), expected

    return synthesize


def transfers(sharpness: float) -> Made:
    """The pavilion in leaves, and its sum. It depends on the reach, as the averages do not."""
    texture = crop("leaves_forest_floor", 0, 0, 512)
    pattern = rescale(crop("scene_china", 160, 100, PAINTED), texture)
    near = cells_of(PAINTED, PAINTED_GRID, sharpness, False)
    sums: list[Double] = []

    def synthesize(reach: Reach) -> tuple[Double, Double]:
        with Team(THREADS) as team:
            work = Work(team, lambda stage, part: None)
            found = transfer(texture, pattern, near, reach=reach, peak=255, candidates=200, seed=1, work=work)
        if not sums:
            sums.append(transfer_sum(texture, near, found.matches.places)[0].clip(0, 255))
        return found.output.astype(np.float64), sums[0]

    return synthesize


def frames(sharpness: float, local: bool) -> Made:
    """A frame of a video patchwork or transfer of a clip that stands still, and its sum."""
    video = np.repeat(crop("sand_under_water", 0, 0, 320)[None].astype(np.uint8), 6, 0)
    near = cells_of(PAINTED, PAINTED_GRID, sharpness, not local)
    sources = near.sources(320, 320, 1)
    mean = video[0].mean((0, 1), np.float64)
    total = transfer_sum(video[0], near, sources)[0] if local else patchwork_sum(video[0], near, sources, True, mean)
    means = None if local else np.tile(mean.astype(np.float32), (near.count, 1))

    def synthesize(reach: Reach) -> tuple[Double, Double]:
        cells = cells_with_reach(near, reach, tileable=not local)
        transitions = Transitions(near.count, 6, 6, 2, loop=True, rng=np.random.default_rng(0))
        work = VideoPatchwork(PaddedClip(video, cells.margin(sources, 320, 320)), cells, sources, transitions, means)
        return work.frame(3).astype(np.float64), total

    return synthesize


CASES: dict[str, Callable[[float], Made]] = {
    "patchwork, torus": lambda f: patchworks(f, True),
    "patchwork, plane": lambda f: patchworks(f, False),
    "transfer": transfers,
    "video-patchwork, a frame": lambda f: frames(f, False),
    "video-transfer, a frame": lambda f: frames(f, True),
}


def main() -> None:
    """Print the table."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    print("rms and maximum, in levels: near patches; all patches; deviation of the sum itself")
    for name, case in CASES.items():
        for sharpness in SHARPNESSES:
            synthesize = case(sharpness)
            found = []
            for reach in ("near", "all"):
                texture, expected = synthesize(reach)
                off = np.abs(texture - expected)
                found.append(f"{np.sqrt(np.square(off).mean()):7.3f} {off.max():7.2f}")
            print(f"{name:26} f = {sharpness:g}  {'   '.join(found)}   {expected.std():5.1f}", flush=True)


if __name__ == "__main__":
    main()

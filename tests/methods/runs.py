"""Small inputs for any method, and running it on them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from app.methods.context import Context, Progress
from app.methods.model import Clip, Method, Picture, Source
from app.methods.params import StillParams
from app.methods.registry import METHODS

# What methods that copy patches need to run on inputs as small as these.
SMALL: Mapping[str, Mapping[str, Any]] = {
    "patchwork": {"grid": 8},
    "transfer": {"grid": 8, "candidates": 20},
    "video-patchwork": {"grid": 8, "interval": 4},
    "video-transfer": {"grid": 8, "interval": 4, "candidates": 20},
}

# Beside the defaults: what makes more pictures, or fewer; and how many inputs.
VARIANTS: Sequence[tuple[str, Mapping[str, Any], int]] = (
    *((name, {}, len(method.inputs)) for name, method in METHODS.items()),
    ("dsn", {"convergence": True}, 1),
    ("dsn", {"spot": "disc", "radius": 3}, 1),
    ("mix", {"strip": 0}, 2),
    ("mix", {"strip": 3}, 2),
    ("mix", {}, 3),
    ("mix", {}, 4),
    ("heeger-bergen", {"iterations": 1}, 1),
    ("heeger-bergen", {"iterations": 3}, 1),
    ("rpn", {"periodic": False}, 1),
    ("patchwork", {"blend": "sharp"}, 1),
    ("video-patchwork", {"arrangement": "mosaic"}, 1),
)


def a_crop(height: int = 48, width: int = 64, channels: int = 3, peak: int = 255, seed: int = 0) -> Source:
    """Grain of two scales on a slope, so that neither borders nor colours are alike."""
    rng = np.random.default_rng(seed)
    fine = rng.uniform(0.3, 0.6, (height, width, channels))
    coarse = np.kron(rng.uniform(-0.1, 0.1, (-(-height // 8), -(-width // 8), 1)), np.ones((8, 8, 1)))
    slope = np.linspace(0, 0.2, width)[None, :, None]
    return Source(np.round((fine + coarse[:height, :width] + slope) * peak).astype(np.float32), peak)


def a_clip(height: int = 48, width: int = 64, channels: int = 3, frames: int = 12, seed: int = 0) -> Source:
    """The same grain drifting across, and grain that is new in every frame."""
    still = a_crop(height, width + 2 * frames, channels, seed=seed).pixels
    rng = np.random.default_rng(seed + 100)
    film = np.stack([still[:, 2 * t : 2 * t + width] for t in range(frames)])
    film = np.round(film + rng.uniform(-20, 20, film.shape)).clip(0, 255).astype(np.uint8)
    return Source(film[0].astype(np.float32), 255, Clip(film, 12.0))


def sources_for(method: Method, **shape: Any) -> list[Source]:
    """Inputs for a method's slots: a clip where it takes a video, else a crop."""
    makers = [a_clip if slot.moving else a_crop for slot in method.inputs]
    return [maker(**shape, seed=number) for number, maker in enumerate(makers)]


def inputs_of(method: Method, count: int, **shape: Any) -> list[Source]:
    """So many inputs: further ones are the last one again."""
    sources = sources_for(method, **shape)
    return [*sources, *(sources[-1] for _ in range(count - len(sources)))]


def run_small(
    method: Method,
    sources: Sequence[Source],
    *,
    depth: Any = 8,
    threads: int = 2,
    progress: Progress = lambda stage, fraction: None,
    scratch: Path | None = None,
    **parameters: Any,
) -> Iterator[Picture]:
    """Run a method with what it needs for small inputs."""
    context = Context(depth, threads, progress)
    return method.pictures(sources, small(method, **parameters), replace(context, scratch=scratch or context.scratch))


def small(method: Method, **parameters: Any) -> StillParams:
    """A method's parameters for small inputs."""
    return method.params(**{**SMALL.get(method.name, {}), **parameters})

"""A clip, and the page of its upload."""

from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest

from tests.acceptance.clips.page import FRAMES, HEIGHT, RATE, WIDTH


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a visitor uploads: waves that move, 161 × 120 pixels, two seconds, as MP4 of every colour's own place."""
    path = tmp_path_factory.mktemp("clip") / "waves.mp4"
    t, y, x = np.mgrid[0:FRAMES, 0:HEIGHT, 0:WIDTH]
    waves = [128 + 80 * np.sin(x / (7 + i) + y / (11 - i) + 2 * np.pi * t * (i + 1) / FRAMES) for i in range(3)]
    with av.open(path, "w") as file:
        track = file.add_stream("libx264", rate=RATE)
        track.width, track.height, track.pix_fmt = WIDTH, HEIGHT, "yuv444p"
        for frame in np.stack(waves, axis=-1).astype(np.uint8):
            file.mux(track.encode(av.VideoFrame.from_ndarray(frame, "rgb24")))
        file.mux(track.encode(None))
    return path


@pytest.fixture(scope="module")
def uploaded(site: Any, clip: Path) -> str:
    """The address of that clip's page."""
    answer = site.client.post("/api/v1/samples", files={"file": (clip.name, clip.read_bytes())})
    assert answer.status_code == 201, answer.text
    return f"/samples/{answer.json()['id']}"

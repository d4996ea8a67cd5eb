"""Chromium plays the videos as they are written: WebM shows the very pixels, MP4 close ones; no server is needed."""

import base64
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from app.images.video.writers import Kind, write_video
from tests.images.clips import psnr
from tests.images.video.natural import natural_video

# Waits for the first frame on the screen, keeps what a canvas sees of it, and plays to the end.
PLAY = """async ([data, type]) => {
    const bytes = Uint8Array.from(atob(data), letter => letter.charCodeAt(0));
    const video = document.createElement("video");
    video.muted = true;
    const shown = () => new Promise(done => video.requestVideoFrameCallback((now, frame) => done(frame.mediaTime)));
    const happens = name => new Promise((done, fail) => {
        video.addEventListener(name, done, {once: true});
        video.addEventListener("error", () => fail(new Error(video.error.message)), {once: true});
    });
    document.body.append(video);
    const first = shown();
    video.src = URL.createObjectURL(new Blob([bytes], {type}));
    await happens("loadeddata");
    const times = [await first];
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [video.videoWidth, video.videoHeight];
    canvas.getContext("2d").drawImage(video, 0, 0);
    const ended = happens("ended");
    await video.play();
    let playing = true;
    ended.then(() => { playing = false; });
    while (playing) { await Promise.race([shown().then(time => times.push(time)), ended]); }
    return {
        says: video.canPlayType(type), width: video.videoWidth, height: video.videoHeight, duration: video.duration,
        ended: video.currentTime, times, drawn: canvas.toDataURL("image/png").split(",")[1],
    };
}"""


def played(browser: Any, video: np.ndarray, kind: Kind, path: Path, rate: float) -> dict[str, Any]:
    write_video(iter(video), path, kind, count=len(video), rate=rate)
    page = browser.new_page()
    try:
        data = base64.b64encode(path.read_bytes()).decode()
        found: dict[str, Any] = page.evaluate(PLAY, [data, f"video/{kind}"])
    finally:
        page.close()
    found["drawn"] = np.asarray(Image.open(BytesIO(base64.b64decode(found["drawn"]))).convert("RGB"))
    return found


@pytest.mark.parametrize("kind", ["webm", "mp4"])
@pytest.mark.parametrize(
    ("height", "width", "channels", "rate"), [(96, 128, 3, 24.0), (61, 83, 3, 24000 / 1001), (61, 83, 1, 100 / 7)]
)
def test_a_video_is_drawn_as_it_was_and_plays_to_its_end(
    browser: Any, tmp_path: Path, kind: Kind, height: int, width: int, channels: int, rate: float
) -> None:
    video = natural_video(12, height, width, channels)
    found = played(browser, video, kind, tmp_path / "video", rate)
    frame = np.broadcast_to(video[0], (height, width, 3))
    if kind == "webm":
        assert (found["drawn"] == frame).all()
    else:
        assert (found["height"], found["width"]) == (height + height % 2, width + width % 2)
        assert psnr(found["drawn"][:height, :width], frame) >= 38
    assert found["says"]
    assert found["duration"] == pytest.approx(12 / rate, abs=0.002)
    assert found["ended"] == pytest.approx(12 / rate, abs=0.002)
    times = np.array(found["times"]) * rate
    assert times[0] == 0
    assert len(set(times.round())) >= 2  # a busy machine skips frames, but not all
    assert np.abs(times - times.round()).max() < 0.05  # each stands where a frame does

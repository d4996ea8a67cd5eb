"""From a method's frames to its files: their order, their content, and what stays when a run is stopped."""

import threading
import weakref
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from imagecodecs import png_decode
from PIL import Image

from app.images.convert import GROUND
from app.images.video.reader import read_video
from app.methods.context import Context
from app.methods.model import Clip, Source
from app.methods.output.videos import encode_crop, encode_texture, encoding_bytes
from tests.images.clips import psnr
from tests.images.video.memory import printed
from tests.images.video.natural import natural_video
from tests.synthesis.stopping import StopError, stops_at


def context(scratch: Path, progress=lambda stage, part: None) -> Context:
    return Context(8, 2, progress, scratch)


def texture(frames, shape, scratch: Path, progress=lambda stage, part: None):
    count, height, width, channels = shape
    size = {"width": width, "height": height, "channels": channels, "count": count}
    return encode_texture(frames, **size, rate=24.0, context=context(scratch, progress))


def source(film: np.ndarray, rate: float = 24.0) -> Source:
    return Source(film[0].astype(np.float32), 255, Clip(film, rate))


def nothing_stays(scratch: Path) -> bool:
    left = [thread.name for thread in threading.enumerate() if thread.name.startswith("encode")]
    return list(scratch.iterdir()) == left == []


@pytest.mark.parametrize("channels", [1, 3])
def test_a_texture_is_a_film_for_every_use_and_a_cube(tmp_path, channels):
    film = natural_video(12, 61, 83, channels)
    made = {picture.name: picture for picture in texture(iter(film), film.shape, tmp_path)}
    assert list(made) == ["texture", "texture-mp4", "preview", "cube"]
    assert [picture.kind for picture in made.values()] == ["texture", "view", "view", "view"]
    types = ["video/webm", "video/mp4", "image/webp", "image/png"]
    assert [picture.media_type for picture in made.values()] == types
    assert [(picture.frames, picture.rate) for picture in made.values()] == [(12, 24.0)] * 3 + [(1, 0.0)]
    assert [(picture.width, picture.height) for picture in made.values()][:3] == [(83, 61), (84, 62), (83, 61)]
    assert (np.stack(list(read_video(made["texture"].data))) == film).all()
    decoded = np.stack(list(read_video(made["texture-mp4"].data)))[:, :61, :83]
    assert psnr(decoded, np.broadcast_to(film, decoded.shape)) >= 38
    preview: Any
    with Image.open(made["preview"].data) as preview:
        assert (preview.size, preview.n_frames) == ((83, 61), 12)
    cube = png_decode(made["cube"].data)
    assert cube.shape[:2] == (made["cube"].height, made["cube"].width)
    assert (cube[0] == GROUND).all()


def test_values_are_rounded_once_and_cut_off(tmp_path):
    values = np.array([-3.0, 0.4, 0.6, 127.2, 254.4, 300.0], np.float32).reshape(1, 1, 6, 1)
    film = next(texture(np.repeat(values, 2, 0), (2, 1, 6, 1), tmp_path))
    assert next(read_video(film.data))[0, :, 0].tolist() == [0, 0, 1, 127, 254, 255]


def test_a_maker_may_use_the_memory_of_a_frame_again(tmp_path):
    film = natural_video(12, 40, 48)

    def frames():
        kept = np.empty(film.shape[1:], np.float32)
        for frame in film:
            kept[:] = frame
            yield kept

    assert (np.stack(list(read_video(next(texture(frames(), film.shape, tmp_path)).data))) == film).all()


def test_frames_are_asked_for_one_by_one_and_let_go(tmp_path):
    film = natural_video(40, 16, 16)
    given = []

    def frames():
        for frame in film:
            made = frame.astype(np.float32)
            given.append(weakref.ref(made))
            yield made
            del made
            assert all(earlier() is None for earlier in given[:-1])

    assert len(list(texture(frames(), film.shape, tmp_path))) == 4
    assert len(given) == 40


def test_two_runs_give_the_same_bytes(tmp_path):
    film = natural_video(10, 100, 120)
    first, second = (
        [
            picture.data if isinstance(picture.data, bytes) else picture.data.read_bytes()
            for picture in texture(iter(film), film.shape, tmp_path)
        ]
        for _ in range(2)
    )
    assert first == second


def test_an_input_is_shown_exactly_as_it_was_cropped(tmp_path):
    film = natural_video(9, 40, 54)
    calls = []
    progress = lambda stage, part: calls.append((stage, part))  # noqa: E731
    made = {picture.name: picture for picture in encode_crop(source(film, 24000 / 1001), context(tmp_path, progress))}
    assert list(made) == ["crop", "crop-mp4", "crop-cube"]
    assert {picture.kind for picture in made.values()} == {"view"}
    assert (made["crop"].frames, made["crop"].rate) == (9, 24000 / 1001)
    assert (np.stack(list(read_video(made["crop"].data))) == film).all()
    assert {stage for stage, _ in calls} == {"crop"}
    assert calls[0][1] == 0
    assert calls == sorted(calls)
    assert calls[-1][1] == 1


def test_the_taker_owns_a_picture_and_what_is_not_taken_does_not_stay(tmp_path):
    film = natural_video(5, 32, 32)
    pictures = texture(iter(film), film.shape, tmp_path)
    taken = [next(pictures).data, next(pictures).data]
    pictures.close()
    assert sorted(tmp_path.iterdir()) == sorted(taken)
    for path in taken:
        path.unlink()
    assert nothing_stays(tmp_path)


def test_a_run_that_ends_while_frames_are_made_leaves_nothing(tmp_path):
    film = natural_video(12, 64, 64)

    def frames():
        yield from film[:7]
        raise StopError

    with pytest.raises(StopError):
        list(texture(frames(), film.shape, tmp_path))
    assert nothing_stays(tmp_path)


def test_progress_stops_the_encoders_too(tmp_path):
    film = natural_video(6, 64, 64)
    stops_at(1, lambda progress: list(texture(iter(film), film.shape, tmp_path, progress)))
    assert nothing_stays(tmp_path)
    for count in (1, 4, 7):
        stops_at(count, lambda progress: list(encode_crop(source(film), context(tmp_path, progress))))
        assert nothing_stays(tmp_path)


GROWTH = """
import sys
import numpy as np
from pathlib import Path
from app.methods.output.videos import encode_texture
from app.methods.context import Context
side, channels, scratch = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
noise = np.random.default_rng(0).integers(0, 256, (side + 16, side + 16, channels), dtype=np.uint8)
frames = (noise[t : t + side, t : t + side] for t in range(16))
before = peak()
size = {"width": side, "height": side, "channels": channels, "count": 16}
list(encode_texture(frames, **size, rate=24.0, context=Context(8, 2, lambda stage, part: None, scratch)))
print(peak() - before)
"""


@pytest.mark.slow
@pytest.mark.parametrize("channels", [1, 3])
def test_the_memory_it_says_is_enough_and_not_far_too_much(tmp_path, channels):
    grown = printed(GROWTH, 512, channels, tmp_path)
    assert grown < encoding_bytes(512, 512, channels) < 2 * grown

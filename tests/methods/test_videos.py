"""What every method that makes videos promises, whatever it computes."""

from pathlib import Path

import numpy as np
import pytest

from app.errors import CancelledError
from app.images.video.reader import read_video
from app.methods.model import Clip, Method, Picture, Source
from app.methods.registry import METHODS
from tests.methods.runs import run_small, sources_for

MOVING = {name: method for name, method in METHODS.items() if method.moving}
EVERY = pytest.mark.parametrize("method", MOVING.values(), ids=list(MOVING))
FIRST = ["texture", "texture-mp4", "preview", "cube"]
CROPS = ["crop", "crop-mp4", "crop-cube"]


def film_of(picture: Picture) -> np.ndarray:
    assert isinstance(picture.data, Path)
    return np.stack(list(read_video(picture.data)))


@EVERY
def test_its_files_come_in_order_and_only_the_webm_is_the_texture(method: Method, tmp_path: Path) -> None:
    pictures = list(run_small(method, sources_for(method), scratch=tmp_path))
    names = [picture.name for picture in pictures]
    assert names[:4] == FIRST
    assert [name for name in names if name in CROPS] == CROPS
    assert len(set(names)) == len(names)
    assert [picture.name for picture in pictures if picture.kind == "texture"] == ["texture"]
    assert all(picture.frames == 12 and picture.rate == 12 for picture in pictures if "video" in picture.media_type)
    assert all(picture.frames == 1 for picture in pictures if picture.media_type == "image/png")


@EVERY
def test_the_crop_is_the_clip_itself(method: Method, tmp_path: Path) -> None:
    sources = sources_for(method)
    crop = next(picture for picture in run_small(method, sources, scratch=tmp_path) if picture.name == "crop")
    assert sources[0].clip is not None
    assert np.array_equal(film_of(crop), sources[0].clip.frames)


@EVERY
@pytest.mark.parametrize(("height", "width", "frames", "channels"), [(47, 53, 11, 3), (48, 61, 13, 1)])
def test_any_size_length_and_number_of_channels(
    method: Method, height: int, width: int, frames: int, channels: int, tmp_path: Path
) -> None:
    sources = sources_for(method, channels=channels)
    shape = {} if len(sources) > 1 else {"height": height, "width": width}  # a transfer is as large as its pattern
    texture = next(run_small(method, sources, scratch=tmp_path, frames=frames, **shape))
    film = film_of(texture)
    assert film.shape[:3] == (frames, texture.height, texture.width)
    assert not shape or (texture.height, texture.width) == (height, width)
    assert film.std() > 0
    assert channels == 3 or (film == film[..., :1]).all()


@EVERY
def test_the_seed_alone_decides_and_not_the_threads(method: Method, tmp_path: Path) -> None:
    def made(threads: int, seed: int) -> list[bytes]:
        pictures = run_small(method, sources_for(method), scratch=tmp_path, threads=threads, seed=seed)
        return [p.data.read_bytes() if isinstance(p.data, Path) else p.data for p in pictures]

    first, again, other = made(1, 5), made(2, 5), made(2, 6)
    assert first == again
    assert first[0] != other[0]


@EVERY
@pytest.mark.parametrize("part", [0.0, 0.4, 0.7])
def test_what_the_progress_raises_ends_the_run_and_leaves_no_file(method: Method, part: float, tmp_path: Path) -> None:
    """Of pictures that were given back the files belong to who has them; of the others nothing stays."""
    taken: list[Path] = []

    def progress(stage: str, fraction: float) -> None:
        if fraction >= part:
            raise CancelledError("enough")

    pictures = run_small(method, sources_for(method), scratch=tmp_path, progress=progress)
    with pytest.raises(CancelledError, match="enough"):
        taken.extend(picture.data for picture in pictures if isinstance(picture.data, Path))
    assert set(tmp_path.iterdir()) == set(taken)


@EVERY
def test_a_constant_clip_gives_that_constant(method: Method, tmp_path: Path) -> None:
    film = np.full((12, 48, 64, 3), (40, 120, 200), np.uint8)
    constant = Source(film[0].astype(np.float32), 255, Clip(film, 12.0))
    frames = film_of(next(run_small(method, [constant] * len(method.inputs), scratch=tmp_path)))
    assert np.abs(frames.astype(int) - (40, 120, 200)).max() <= 1


@EVERY
def test_it_says_beforehand_how_much_memory_it_needs(method: Method) -> None:
    """More frames in, or more pixels out, never need less."""
    assert method.memory is not None
    sizes = [source.size for source in sources_for(method)]
    longer = [source.size for source in sources_for(method, frames=24)] if len(method.inputs) == 1 else sizes
    params = method.params(width=64, height=48, frames=12)
    larger = method.params(width=128, height=96, frames=12)
    assert 0 < method.memory_of(sizes, params) <= method.memory_of(longer, params)
    assert method.memory_of(sizes, params) <= method.memory_of(sizes, larger)

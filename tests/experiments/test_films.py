"""Videos through the whole service: a clip comes in, is cut, becomes another one, and goes out as files."""

import asyncio
import io
import shutil
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from app.errors import InvalidInputError, TooLargeError
from app.experiments.model import Experiment, Sample, Status
from app.experiments.preparation import NewExperiment, NewInput
from app.experiments.service import Service
from app.images.crop import Frames, Rectangle
from app.images.video.reader import read_video
from app.images.video.writers import write_video
from tests.experiments.running import finished

CROP, TIME = Rectangle(4, 2, 40, 36), Frames(2, 8)


@pytest.fixture
def film() -> np.ndarray:
    return np.random.default_rng(7).integers(0, 256, (12, 48, 64, 3), dtype=np.uint8)


@pytest.fixture
def clip(film: np.ndarray, tmp_path: Path) -> Path:
    path = tmp_path / "clip.webm"
    write_video(film, path, "webm", count=len(film), rate=12.0)
    return path


def copy(path: Path) -> Path:
    """One that the service may take away."""
    return Path(shutil.copy(path, path.with_name("upload")))


@pytest.fixture
def sample(service: Service, clip: Path) -> Sample:
    return service.samples.add(copy(clip), None)


def request(
    sample: Sample, method: str = "video-rpn", time: Frames | None = TIME, **parameters: object
) -> NewExperiment:
    return NewExperiment(method, (NewInput(sample.id, CROP, time),), parameters)


@pytest.fixture
def experiment(service: Service, sample: Sample) -> Experiment:
    made = finished(service, request(sample, frames=10))
    assert made.status is Status.SUCCEEDED, made.error
    return made


def test_a_clip_is_kept_as_it_is(service: Service, sample: Sample, film: np.ndarray) -> None:
    assert (sample.width, sample.height, sample.frames, sample.rate) == (64, 48, 12, 12.0)
    assert sample.media_type == "video/webm"
    path, media_type = service.renditions.video(sample, "webm")
    assert media_type == "video/webm"
    assert np.array_equal(np.stack(list(read_video(path))), film)


def test_the_method_gets_the_crop_of_the_time_range(service: Service, experiment: Experiment, film: np.ndarray) -> None:
    _, path = service.outputs.get(experiment.id, "crop")
    assert np.array_equal(np.stack(list(read_video(path))), film[2:10, 2:38, 4:44])


def test_the_texture_is_a_film_of_the_length_that_was_asked_for(service: Service, experiment: Experiment) -> None:
    output, path = service.outputs.get(experiment.id, "texture")
    assert (output.media_type, output.frames, output.rate) == ("video/webm", 10, 12.0)
    assert len(list(read_video(path))) == 10
    assert experiment.diagnostics["structure"]["outputs"]


def test_a_still_method_works_on_one_frame_of_a_clip(service: Service, sample: Sample, film: np.ndarray) -> None:
    made = finished(service, request(sample, "rpn", Frames(5, 1)))
    _, path = service.outputs.get(made.id, "crop")
    with Image.open(path) as picture:
        assert np.array_equal(np.asarray(picture), film[5, 2:38, 4:44])


def test_a_format_names_one_of_the_two_files(service: Service, experiment: Experiment) -> None:
    for name in ("texture", "texture-mp4"):
        for file_format, codec in ((None, "vp9"), ("webm", "vp9"), ("mp4", "h264")):
            path, media_type = asyncio.run(service.outputs.convert(experiment.id, name, file_format))  # type: ignore[arg-type]
            assert media_type == f"video/{file_format or 'webm'}"
            with av.open(path) as container:
                assert container.streams.video[0].codec_context.name == codec


@pytest.mark.parametrize(
    ("name", "file_format", "depth", "words"),
    [
        ("texture", "png", None, "Ask for webm or mp4"),
        ("texture", "webm", 16, "8 bits per channel"),
        ("preview", "jpeg", None, "only as it is stored"),
        ("cube", "mp4", None, "still picture"),
    ],
)
def test_a_format_that_an_output_has_not_is_refused(
    service: Service, experiment: Experiment, name: str, file_format: str, depth: int | None, words: str
) -> None:
    with pytest.raises(InvalidInputError, match=words):
        asyncio.run(service.outputs.convert(experiment.id, name, file_format, depth))  # type: ignore[arg-type]


def test_it_is_shown_by_first_frames(service: Service, experiment: Experiment) -> None:
    """Thumbnails, link preview and posters are still pictures."""
    for name in (".thumbnail-crop", ".thumbnail-texture", ".preview", ".poster-texture"):
        output, path = service.outputs.get(experiment.id, name)
        with Image.open(path) as picture:
            assert picture.size == (output.width, output.height)
            assert getattr(picture, "n_frames", 1) == 1


@pytest.mark.parametrize("file_format", [None, "webm", "mp4"])
def test_a_video_straight_from_a_clip_is_the_same_and_leaves_nothing(
    service: Service, experiment: Experiment, clip: Path, file_format: str | None
) -> None:
    data, media_type = asyncio.run(
        service.transient.synthesize(
            [copy(clip)],
            method="video-rpn",
            crops=[CROP],
            frames=[TIME],
            parameters={"frames": "10"},
            file_format=file_format,  # type: ignore[arg-type]
        )
    )
    name = "texture-mp4" if file_format == "mp4" else "texture"
    assert media_type == f"video/{file_format or 'webm'}"
    assert data == service.outputs.get(experiment.id, name)[1].read_bytes()
    assert service.experiments.counts()["succeeded"] == 1
    with av.open(io.BytesIO(data)) as container:
        assert sum(1 for _ in container.decode(video=0)) == 10


def test_what_it_would_take_is_known_before_it_is_run(service: Service, sample: Sample) -> None:
    plan = service.submission.check(request(sample, width=50))
    assert (plan.width, plan.height, plan.frames) == (50, 36, 8)
    assert 0 < plan.memory < plan.memory_limit
    with pytest.raises(TooLargeError, match="A texture of 4096 × 17 has 0 megapixels; this service"):
        service.submission.check(request(sample, width=4096, height=17))
    assert service.experiments.counts()["queued"] == 0

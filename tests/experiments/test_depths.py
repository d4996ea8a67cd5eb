"""The bits of an experiment's pictures: those of its deepest sample, or sixteen where they are asked for."""

import asyncio
import shutil
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import imagecodecs
import numpy as np
import pytest

from app.errors import AppError, DeletedError, InvalidInputError
from app.experiments.model import Experiment, Sample
from app.experiments.preparation import NewExperiment, NewInput
from app.experiments.service import Service
from app.images.crop import Rectangle
from app.images.png_writer import encode_png
from app.methods.context import Context
from app.methods.model import Picture
from app.methods.registry import METHODS
from tests.experiments.running import OWNER, finished

PART = Rectangle(0, 0, 24, 20)
PATIENCE = 30.0


@pytest.fixture
def deep_upload(tmp_path: Path) -> Path:
    path = tmp_path / "deep.png"
    path.write_bytes(encode_png(np.random.default_rng(8).integers(0, 65536, (48, 64, 3), dtype=np.uint16)))
    return path


@pytest.fixture
def deep(service: Service, deep_upload: Path) -> Sample:
    return service.samples.add(Path(shutil.copy(deep_upload, deep_upload.with_suffix(".copy"))), None)


def run(service: Service, method: str, *samples: Sample, **parameters: Any) -> Experiment:
    inputs = tuple(NewInput(sample.id, replace(PART, x=9 * place)) for place, sample in enumerate(samples))
    return finished(service, NewExperiment(method, inputs, parameters))


def decoded(path: Path) -> np.ndarray:
    pixels: np.ndarray = imagecodecs.imread(path)
    return pixels


@pytest.mark.parametrize(
    ("method", "count", "parameters", "names"),
    [
        ("modulus-phase", 2, {}, ["texture", "other"]),
        ("mix", 2, {"strip": 3}, ["texture", "mix-1", "mix-2", "mix-3"]),
        ("mix", 3, {}, ["sample-1", "sample-2", "sample-3"]),
        ("dsn", 1, {"convergence": True}, ["dsn-10", "dsn-100000", "adsn"]),
        ("rayleigh", 1, {}, ["texture", "rpn", "adsn"]),
        ("rpn", 1, {}, ["texture", "periodic", "smooth", "spot"]),
    ],
)
def test_every_texture_comes_at_16_bits_and_is_the_same_one(
    service: Service, sample: Sample, method: str, count: int, parameters: dict[str, Any], names: list[str]
) -> None:
    experiment = run(service, method, *[sample] * count, **parameters)
    for name in names:
        path, media_type = asyncio.run(service.outputs.convert(experiment.id, name, "png", 16))
        fine, coarse = decoded(path), decoded(service.outputs.get(experiment.id, name)[1])
        assert (fine.dtype, coarse.dtype, media_type) == (np.uint16, np.uint8, "image/png")
        assert np.abs(fine / 257.0 - coarse).max() <= 0.5 + 1e-3  # 8 bits are the 16 rounded
        assert (fine % 257 != 0).mean() > 0.5, "8-bit values made wider"  # black and white are both
        tiff, _ = asyncio.run(service.outputs.convert(experiment.id, name, "tiff", 16))
        assert np.array_equal(decoded(tiff), fine)


def test_textures_that_were_made_on_the_way_are_kept(service: Service, sample: Sample) -> None:
    experiment = run(service, "mix", sample, sample, strip=3)
    asyncio.run(service.outputs.convert(experiment.id, "mix-2", "png", 16))
    hidden = [output.name for output in service.experiments.get(experiment.id).outputs if not output.listed]
    assert hidden == [".texture-16", ".mix-1-16", ".mix-2-16"]
    asyncio.run(service.outputs.convert(experiment.id, "mix-1", "png", 16))
    assert [output.name for output in service.experiments.get(experiment.id).outputs if not output.listed] == hidden


@pytest.mark.parametrize("name", ["crop", "input-spectrum"])
def test_what_has_no_more_than_8_bits_says_so(service: Service, sample: Sample, name: str) -> None:
    experiment = run(service, "rpn", sample)
    with pytest.raises(InvalidInputError, match="8 bits per channel") as refused:
        asyncio.run(service.outputs.convert(experiment.id, name, "png", 16))
    assert refused.value.field == "depth"


def test_a_sample_of_16_bits_gives_pictures_of_16_bits(service: Service, deep: Sample) -> None:
    """All of them but spectra, without being asked; the crop is the sample's, value by value."""
    experiment = run(service, "rpn", deep)
    assert experiment.depth == 16
    for output in experiment.outputs:
        kind = np.uint8 if output.name.endswith("spectrum") else np.uint16
        assert decoded(service.outputs.get(experiment.id, output.name)[1]).dtype == kind, output.name
    crop = decoded(service.outputs.get(experiment.id, "crop")[1])
    assert np.array_equal(crop, np.random.default_rng(8).integers(0, 65536, (48, 64, 3), dtype=np.uint16)[:20, :24])
    stored = service.outputs.get(experiment.id, "texture")[1]
    for file_format in (None, "png"):
        assert asyncio.run(service.outputs.convert(experiment.id, "texture", file_format, 16))[0] == stored
    assert not [output for output in service.experiments.get(experiment.id).outputs if not output.listed]
    tiff, _ = asyncio.run(service.outputs.convert(experiment.id, "texture", "tiff"))
    assert np.array_equal(decoded(tiff), decoded(stored))


@pytest.mark.parametrize("file_format", ["png", "tiff"])
def test_8_bits_of_it_are_still_to_be_had(service: Service, deep: Sample, file_format: Any) -> None:
    experiment = run(service, "rpn", deep)
    path, _ = asyncio.run(service.outputs.convert(experiment.id, "texture", file_format, 8))
    coarse, fine = decoded(path), decoded(service.outputs.get(experiment.id, "texture")[1])
    assert coarse.dtype == np.uint8
    assert np.abs(fine / 257.0 - coarse).max() <= 0.51


@pytest.mark.parametrize("file_format", ["jpeg", "webp"])
def test_formats_without_16_bits_have_8(service: Service, deep: Sample, file_format: Any) -> None:
    experiment = run(service, "rpn", deep)
    path, _ = asyncio.run(service.outputs.convert(experiment.id, "texture", file_format))
    assert decoded(path).dtype == np.uint8


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_the_deepest_of_several_samples_decides(
    service: Service, sample: Sample, deep: Sample, order: tuple[int, int]
) -> None:
    samples = [(sample, deep)[place] for place in order]
    experiment = run(service, "mix", *samples, strip=2)
    assert experiment.depth == 16
    assert decoded(service.outputs.get(experiment.id, "mix-2")[1]).dtype == np.uint16


@pytest.mark.parametrize("depth", [None, 8, 16])
@pytest.mark.parametrize("output", ["texture", "periodic"])
def test_straight_from_a_file_it_is_the_same_file(
    service: Service, deep: Sample, deep_upload: Path, depth: Any, output: str
) -> None:
    experiment = run(service, "rpn", deep)
    data, _ = asyncio.run(
        service.transient.synthesize(
            [deep_upload], method="rpn", crops=[PART], parameters={}, output=output, file_format="png", depth=depth
        )
    )
    assert data == asyncio.run(service.outputs.convert(experiment.id, output, "png", depth))[0].read_bytes()


Broken = Callable[[Exception], None]


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> Broken:
    """Let rpn raise what is given in runs at 16 bits."""

    def breaking(error: Exception) -> None:
        original = METHODS["rpn"]

        def failing(sources: Any, params: Any, context: Context) -> Iterator[Picture]:
            if context.depth == 16:
                raise error
            yield from original.run(sources, params, context)

        monkeypatch.setitem(METHODS, "rpn", replace(original, run=failing))

    return breaking


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (MemoryError(), "not enough memory"),
        (ZeroDivisionError(), "fault of the service"),
        (AppError("The stars are against it."), "stars are against it"),
    ],
)
def test_what_goes_wrong_at_16_bits_is_said_in_the_words_of_an_experiment(
    service: Service, sample: Sample, broken: Broken, error: Exception, words: str
) -> None:
    experiment = run(service, "rpn", sample)
    broken(error)
    with pytest.raises(AppError, match=words):
        asyncio.run(service.outputs.convert(experiment.id, "texture", "png", 16))


def test_deleting_the_experiment_ends_its_run_at_16_bits(
    service: Service, sample: Sample, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of whichever output it is; who waits for it learns that it was deleted."""
    experiment = run(service, "modulus-phase", sample, sample)
    original, running, stopped = METHODS["modulus-phase"], threading.Event(), threading.Event()

    def endless(sources: Any, params: Any, context: Context) -> Iterator[Picture]:
        try:
            while True:
                running.set()
                context.progress("swap", 0.5)
        finally:
            stopped.set()
        yield

    monkeypatch.setitem(METHODS, "modulus-phase", replace(original, run=endless))

    async def waiting() -> None:
        download = asyncio.create_task(service.outputs.convert(experiment.id, "other", "png", 16))
        assert await asyncio.to_thread(running.wait, PATIENCE)
        await asyncio.to_thread(service.experiments.cancel_or_delete, experiment.id, OWNER)
        assert await asyncio.to_thread(stopped.wait, PATIENCE)
        with pytest.raises(DeletedError, match="This experiment was deleted by its owner"):
            await download

    asyncio.run(waiting())

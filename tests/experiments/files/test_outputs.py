"""The files of an experiment: as stored, converted, at 16 bits, and renditions of samples."""

import asyncio
import shutil
from pathlib import Path
from typing import Any

import imagecodecs
import numpy as np
import pytest
from PIL import Image

from app.errors import (
    InvalidInputError,
    NotFoundError,
)
from app.experiments.model import Sample
from app.experiments.service import Service
from tests.experiments.running import a_request, finished


def test_the_texture_at_16_bits_is_the_same_one_and_made_once(service: Service, sample: Sample) -> None:
    experiment = finished(service, a_request(sample))
    path, media_type = asyncio.run(service.outputs.convert(experiment.id, "texture", "png", 16))
    deep = imagecodecs.png_decode(path.read_bytes())
    shallow = imagecodecs.png_decode(service.outputs.get(experiment.id, "texture")[1].read_bytes())
    assert (deep.dtype, media_type) == (np.uint16, "image/png")
    assert np.abs(deep / 257.0 - shallow).max() <= 0.5 + 1e-3  # 8 bits are the 16 rounded
    assert asyncio.run(service.outputs.convert(experiment.id, "texture", "png", 16))[0] == path
    assert [output.name for output in service.experiments.get(experiment.id).outputs].count(".texture-16") == 1
    tiff, _ = asyncio.run(service.outputs.convert(experiment.id, "texture", "tiff", 16))
    assert np.array_equal(imagecodecs.imread(tiff), deep)


@pytest.mark.parametrize(("name", "file_format"), [("texture", "jpeg"), ("texture", "webp"), ("crop", "png")])
def test_what_has_no_16_bits_says_so(service: Service, sample: Sample, name: str, file_format: Any) -> None:
    experiment = finished(service, a_request(sample))
    with pytest.raises(InvalidInputError, match=r"(16|8) bits") as refusal:
        asyncio.run(service.outputs.convert(experiment.id, name, file_format, 16))
    assert refusal.value.field == "depth"


@pytest.mark.parametrize("file_format", ["png", "jpeg", "webp", "tiff"])
def test_outputs_come_in_every_format_and_are_kept(service: Service, sample: Sample, file_format: Any) -> None:
    experiment = finished(service, a_request(sample))
    path, media_type = asyncio.run(service.outputs.convert(experiment.id, "texture", file_format))
    assert media_type == f"image/{file_format}"
    with Image.open(path) as image:
        assert image.format == file_format.upper()
    assert asyncio.run(service.outputs.convert(experiment.id, "texture", file_format)) == (path, media_type)


def test_an_output_that_is_not_there_says_what_is(service: Service, sample: Sample) -> None:
    experiment = finished(service, a_request(sample))
    with pytest.raises(NotFoundError, match="texture, crop"):
        service.outputs.get(experiment.id, "nothing")


def test_the_full_rendition_is_the_stored_file_and_small_ones_are_bounded(service: Service, tmp_path: Path) -> None:
    pixels = np.random.default_rng(2).integers(0, 256, (300, 600, 3), dtype=np.uint8)
    Image.fromarray(pixels).save(tmp_path / "large.png")
    sample = service.samples.add(tmp_path / "large.png", None)
    full, media_type = service.renditions.image(sample, None)
    assert media_type == "image/png"
    assert np.array_equal(imagecodecs.png_decode(full.read_bytes()), pixels)
    small, media_type = service.renditions.image(sample, 200)
    assert media_type == "image/jpeg"
    with Image.open(small) as image:
        assert image.size == (256, 128)
    shutil.rmtree(small.parent)
    assert service.renditions.image(sample, 200)[0].exists()

"""What is measured of an experiment."""

import asyncio
from pathlib import Path

import numpy as np
import pytest

from app.experiments.diagnostics import diagnose
from app.experiments.preparation import NewExperiment, NewInput
from app.experiments.service import Service
from app.images.png_writer import encode_png
from app.methods.model import Fact, Picture, Source
from app.synthesis.structure import measure_delta, structure_index

SECONDS = 30.0


def bars(height: int, width: int) -> np.ndarray:
    """A structured picture: bright bars on dark ground."""
    rows = (np.arange(height) // 16 % 2).astype(np.uint8) * 150 + 50
    return np.repeat(rows[:, None, None], width, axis=1) + np.zeros((1, 1, 3), np.uint8)


def staged(tmp_path: Path, pixels: np.ndarray, **said: object) -> tuple[Picture, Path]:
    name = f"picture-{len(list(tmp_path.iterdir()))}"
    path = tmp_path / name
    path.write_bytes(encode_png(pixels))
    return Picture(name, name, pixels.shape[1], pixels.shape[0], b"", **said), path  # type: ignore[arg-type]


def silent(stage: str, fraction: float) -> None:
    pass


def test_inputs_and_textures_are_measured_and_views_are_not(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (128, 96, 3), dtype=np.uint8)
    pictures = [
        staged(tmp_path, noise, kind="texture"),
        staged(tmp_path, noise),
        staged(tmp_path, bars(128, 96), kind="texture"),
    ]
    sources = [Source(bars(64, 80).astype(np.float32), 255), Source(noise.astype(np.float32), 255)]
    found = diagnose(sources, pictures, silent)["structure"]
    expected = [structure_index(source.pixels).delta for source in sources]
    assert found["inputs"] == pytest.approx(expected, abs=1e-6)
    assert found["outputs"] == pytest.approx(
        [structure_index(pixels.astype(np.float32)).delta for pixels in (noise, bars(128, 96))], abs=1e-6
    )
    assert abs(found["outputs"][0]) < 0.1 < found["outputs"][1]


@pytest.mark.parametrize(("size", "known"), [((1, 1), False), ((3, 1), False), ((31, 32), False), ((32, 32), True)])
def test_of_a_few_pixels_there_is_no_index(tmp_path: Path, size: tuple[int, int], known: bool) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (*size, 3), dtype=np.uint8)
    pictures = [staged(tmp_path, noise, kind="texture")]
    found = diagnose([Source(noise.astype(np.float32), 255)], pictures, silent)["structure"]
    assert [delta is not None for delta in (*found["inputs"], *found["outputs"])] == [known, known]


def test_of_a_large_texture_the_same_centre_is_measured_as_of_an_array(tmp_path: Path) -> None:
    noise = np.random.default_rng(2).integers(0, 256, (1101, 1300, 1), dtype=np.uint8)
    (found,) = diagnose([], [staged(tmp_path, noise, kind="texture")], silent)["structure"]["outputs"]
    assert found == pytest.approx(measure_delta(noise.astype(np.float32)), abs=1e-6)


def test_facts_are_kept_with_the_name_of_their_output(tmp_path: Path) -> None:
    fact = Fact("radius-50", "Radius of half the energy", 2.5, "pixels")
    picture = staged(tmp_path, bars(32, 32), facts=(fact,))
    (found,) = diagnose([], [picture], silent)["facts"]
    assert found == {
        "output": picture[0].name, "name": "radius-50", "title": fact.title, "value": 2.5, "unit": "pixels",
    }  # fmt: skip


def test_every_experiment_has_diagnostics(service: Service, photograph: Path) -> None:
    """White noise is its own random phase texture: δ of the sample and of the texture is near 0."""
    sample = service.samples.add(photograph, None)
    experiment = service.submission.submit(
        NewExperiment("rpn", (NewInput(sample.id),), {"width": 128, "height": 128}), "token"
    )
    found = asyncio.run(service.watching.wait(experiment.id, SECONDS)).diagnostics
    assert [len(found["structure"][side]) for side in ("inputs", "outputs")] == [1, 1]
    assert max(abs(delta) for side in found["structure"].values() for delta in side) < 0.1
    assert found["facts"] == []

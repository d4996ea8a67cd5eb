"""The use cases, with real backends and an engine in this process."""

import asyncio
import shutil
from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from typing import Any

import imagecodecs
import numpy as np
import pytest
from PIL import Image

from app.errors import BrokenFileError, BusyError, DeletedError, ForbiddenError, InvalidInputError, NotFoundError
from app.experiments.model import Sample, Snapshot, Status
from app.experiments.preparation import NewExperiment, NewInput
from app.experiments.service import Service
from app.images.crop import Rectangle
from app.settings import Settings
from tests.experiments.running import OWNER, SECONDS, a_request, finished

Stored = Callable[[], set[str]]


def test_a_photograph_becomes_a_texture(service: Service, sample: Sample) -> None:
    experiment = finished(service, a_request(sample, width=70, seed=3))
    assert (experiment.status, experiment.error) == (Status.SUCCEEDED, None)
    assert experiment.parameters["width"] == 70
    assert experiment.parameters["height"] == 36
    listed = [output.name for output in experiment.outputs if output.listed]
    assert listed == ["texture", "crop", "periodic", "smooth", "spot", "input-spectrum", "output-spectrum"]
    for output in experiment.outputs:
        path = service.outputs.get(experiment.id, output.name)[1]
        assert path.stat().st_size == output.bytes
        if output.listed:
            with Image.open(path) as image:
                assert image.size == (output.width, output.height)
    texture = service.outputs.get(experiment.id, "texture")[0]
    assert (texture.width, texture.height) == (70, 36)
    assert "texture" in experiment.timings
    assert all(seconds >= 0 for seconds in experiment.timings.values())


def test_the_crop_output_is_the_samples_pixels(service: Service, sample: Sample, photograph: Path) -> None:
    experiment = finished(service, a_request(sample))
    crop = imagecodecs.png_decode(service.outputs.get(experiment.id, "crop")[1].read_bytes())
    assert np.array_equal(crop, imagecodecs.png_decode(photograph.read_bytes())[2:38, 4:44])


def test_the_same_experiment_gives_the_same_bytes_and_shares_the_file(service: Service, sample: Sample) -> None:
    one, other = (finished(service, a_request(sample, seed=5)) for _ in range(2))
    assert service.outputs.get(one.id, "texture")[1] == service.outputs.get(other.id, "texture")[1]
    assert (
        service.outputs.get(finished(service, a_request(sample, seed=6)).id, "texture")[1]
        != service.outputs.get(one.id, "texture")[1]
    )


def test_identifiers_are_long_and_never_look_like_an_option(service: Service, sample: Sample) -> None:
    identifiers = {finished(service, a_request(sample)).id for _ in range(3)}
    assert len(identifiers) == 3
    assert all(len(each) >= 16 and not each.startswith("-") for each in identifiers)


def test_thumbnails_are_hidden_and_a_preview_is_made_when_asked_for(service: Service, sample: Sample) -> None:
    experiment = finished(service, a_request(sample))
    for name in (".thumbnail-crop", ".thumbnail-texture"):
        output, path = service.outputs.get(experiment.id, name)
        assert not output.listed
        with Image.open(path) as image:
            assert max(image.size) <= 320
        with Image.open(path) as image:
            assert image.size == (output.width, output.height)
    output, path = service.outputs.get(experiment.id, ".preview")
    with Image.open(path) as image:
        assert image.size == (output.width, output.height) == (1200, 630)


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"method": "nothing"}, None, "no method"),
        ({"inputs": ()}, "inputs", "1 input"),
        ({"inputs": (NewInput("nothing"),)}, None, "no such photograph"),
        ({"crop": Rectangle(30, 0, 40, 10)}, "inputs.0.crop", "outside"),
        ({"crop": Rectangle(0, 0, 0, 10)}, "inputs.0.crop", "at least"),
        ({"parameters": {"alpha": 7}}, "parameters.alpha", "from 0 to 0.5; got 7"),
        ({"parameters": {"alpha": "wide"}}, "parameters.alpha", 'got "wide"'),
        ({"parameters": {"seed": -1}}, "parameters.seed", "got -1"),
        ({"parameters": {"seed": 1 << 53}}, "parameters.seed", "got 9007199254740992"),
        ({"parameters": {"colour": 1}}, "parameters.colour", 'no parameter "colour"'),
        ({"parameters": {"width": 1 << 12, "height": 1 << 12}}, None, "smaller"),
        ({"parameters": {"add_smooth": True, "width": 50}}, "parameters.add_smooth", "own size"),
    ],
)
def test_what_cannot_run_is_refused_with_words(
    service: Service, sample: Sample, change: dict[str, Any], field: str | None, words: str
) -> None:
    request = a_request(sample)
    if "crop" in change:
        change = {"inputs": (NewInput(sample.id, change["crop"]),)}
    with pytest.raises(Exception) as refusal:  # noqa: PT011 - its class is asserted below
        service.submission.submit(replace(request, **change), OWNER)
    assert getattr(refusal.value, "field", None) == field
    assert words in str(refusal.value)
    assert sum(service.experiments.counts().values()) == 0


def test_a_crop_with_transparent_pixels_is_refused_and_an_opaque_one_runs(service: Service, tmp_path: Path) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (40, 40, 4), dtype=np.uint8)
    pixels[..., 3] = 255
    pixels[:5, :5, 3] = 100
    Image.fromarray(pixels).save(tmp_path / "hole.png")
    sample = service.samples.add(tmp_path / "hole.png", None)
    assert sample.transparent
    with pytest.raises(InvalidInputError, match="transparent") as refusal:
        service.submission.submit(NewExperiment("rpn", (NewInput(sample.id),), {}), OWNER)
    assert refusal.value.field == "inputs.0.crop"
    opaque = NewExperiment("rpn", (NewInput(sample.id, Rectangle(5, 5, 35, 35)),), {})
    assert finished(service, opaque).status is Status.SUCCEEDED


def test_an_upload_is_gone_whatever_comes_of_it(service: Service, upload: Path, stored: Stored) -> None:
    service.samples.add(upload, None)
    assert not upload.exists()
    upload.write_bytes(b"\x89PNG\r\n\x1a\n and no more")
    before = stored()
    with pytest.raises(BrokenFileError, match="This PNG file is damaged or incomplete"):
        service.samples.add(upload, None)
    assert not upload.exists()
    assert stored() == before


def test_only_its_owner_and_the_operator_may_change_an_experiment(
    service: Service, sample: Sample, settings: Settings
) -> None:
    experiment = finished(service, a_request(sample))
    assert settings.operator_token is not None
    operator = settings.operator_token.get_secret_value()
    for stranger in (None, "", "another token", experiment.owner, "\ud800"):
        with pytest.raises(ForbiddenError, match="Only the owner of this experiment may do this"):
            service.experiments.cancel_or_delete(experiment.id, stranger)
        with pytest.raises(ForbiddenError, match="Only the owner of this experiment may do this"):
            service.experiments.set_listed(experiment.id, False, stranger)
    service.experiments.set_listed(experiment.id, False, OWNER)
    assert service.experiments.page().experiments == ()
    service.experiments.set_listed(experiment.id, True, operator)
    assert [each.id for each in service.experiments.page().experiments] == [experiment.id]
    assert OWNER not in repr(experiment)


def test_deleting_removes_what_nothing_else_refers_to(
    service: Service, sample: Sample, stored: Stored, photograph: Path
) -> None:
    before = stored()
    assert len(before) == 1
    one, twin = (finished(service, a_request(sample, seed=1)) for _ in range(2))
    asyncio.run(service.outputs.convert(one.id, "texture", "tiff", 16))
    service.outputs.get(one.id, ".preview")
    service.renditions.image(sample, 100)
    service.experiments.cancel_or_delete(one.id, OWNER)
    with pytest.raises(DeletedError, match="This experiment was deleted by its owner"):
        service.experiments.get(one.id)
    assert service.outputs.get(twin.id, "texture")[1].exists()
    service.experiments.cancel_or_delete(twin.id, OWNER)
    with pytest.raises(NotFoundError, match="There is no such photograph"):
        service.samples.get(sample.id)
    assert stored() == set()


def test_deleting_keeps_a_sample_that_another_experiment_uses(service: Service, sample: Sample) -> None:
    one, other = (finished(service, a_request(sample, seed=seed)) for seed in (1, 2))
    service.experiments.cancel_or_delete(one.id, OWNER)
    assert service.samples.get(sample.id) == sample
    assert service.outputs.get(other.id, "texture")[1].exists()


def test_cancelling_stops_what_runs_and_what_waits(service: Service, sample: Sample) -> None:
    long = {"width": 256, "height": 256}
    running, waiting = (service.submission.submit(a_request(sample, **long), OWNER) for _ in range(2))
    service.experiments.cancel_or_delete(waiting.id, OWNER)
    service.experiments.cancel_or_delete(running.id, OWNER)
    assert service.experiments.get(waiting.id).status is Status.CANCELLED
    assert service.watching.snapshot(waiting.id).status is Status.CANCELLED
    ended = asyncio.run(service.watching.wait(running.id, SECONDS))
    assert ended.status in {Status.CANCELLED, Status.SUCCEEDED}  # it may have been faster
    assert finished(service, a_request(sample)).status is Status.SUCCEEDED


def test_one_too_many_is_told_to_come_back(
    settings: Settings, upload: Path, make_service: Callable[..., Service]
) -> None:
    service = make_service()
    sample = service.samples.add(upload, None)
    waiting = [service.submission.submit(a_request(sample), OWNER) for _ in range(settings.queue_limit)]
    with pytest.raises(BusyError, match="Try again in a minute"):
        service.submission.submit(a_request(sample), OWNER)
    assert [service.watching.snapshot(each.id).position for each in waiting] == [1, 2, 3]
    service.start()
    for each in waiting:
        assert asyncio.run(service.watching.wait(each.id, SECONDS)).status is Status.SUCCEEDED


def test_what_was_accepted_is_finished_after_a_restart(upload: Path, make_service: Callable[..., Service]) -> None:
    before = make_service()
    accepted = before.submission.submit(a_request(before.samples.add(upload, None)), OWNER)
    before.close()
    after = make_service()
    assert after.experiments.get(accepted.id).status is Status.QUEUED
    after.start()
    assert asyncio.run(after.watching.wait(accepted.id, SECONDS)).status is Status.SUCCEEDED


def test_waiting_returns_in_time_even_if_nothing_happens(upload: Path, make_service: Callable[..., Service]) -> None:
    service = make_service()
    experiment = service.submission.submit(a_request(service.samples.add(upload, None)), OWNER)
    assert asyncio.run(service.watching.wait(experiment.id, 0.05)).status is Status.QUEUED


def test_watching_ends_with_the_finished_state(service: Service, sample: Sample) -> None:
    async def watched() -> list[Snapshot]:
        experiment = service.submission.submit(a_request(sample, width=256, height=256), OWNER)
        return [snapshot async for snapshot in service.watching.watch(experiment.id)]

    seen = asyncio.run(watched())
    assert seen[-1].status is Status.SUCCEEDED
    assert seen[-1].fraction == 1.0
    assert not any(snapshot.status.finished for snapshot in seen[:-1])
    fractions = [snapshot.fraction for snapshot in seen]
    assert fractions == sorted(fractions)


def test_an_experiment_that_another_process_finishes_is_noticed(
    upload: Path, make_service: Callable[..., Service]
) -> None:
    """Both if it never heard of the experiment, and if it waits for its own engine to get to it."""
    idle, working = make_service(), make_service()
    sample = working.samples.add(upload, None)
    accepted = idle.submission.submit(a_request(sample), OWNER)
    working.start()
    unheard_of = working.submission.submit(a_request(sample), OWNER)

    async def watched(experiment_id: str) -> list[Snapshot]:
        return [snapshot async for snapshot in idle.watching.watch(experiment_id)]

    for experiment in (accepted, unheard_of):
        assert asyncio.run(watched(experiment.id))[-1].status is Status.SUCCEEDED
        assert asyncio.run(idle.watching.wait(experiment.id, SECONDS)).status is Status.SUCCEEDED


def test_a_failed_run_says_why(service: Service, sample: Sample, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr("app.experiments.computation.read_crop", failing)
    experiment = finished(service, a_request(sample))
    assert experiment.status is Status.FAILED
    assert experiment.error is not None
    assert "memory" in experiment.error
    with pytest.raises(NotFoundError, match="This experiment has no output 'texture'"):
        service.outputs.get(experiment.id, "texture")


def test_pruning_removes_old_experiments_and_strays_only(
    service: Service, sample: Sample, settings: Settings, stored: Stored
) -> None:
    experiment = finished(service, a_request(sample))
    stray = settings.data_dir / "files" / "00" / ("00" * 32)
    stray.parent.mkdir(exist_ok=True)
    stray.write_bytes(b"stray")
    kept = service.housekeeping.prune(timedelta(days=1))
    assert (kept.experiments, kept.samples, kept.files) == (0, 0, 1)
    gone = service.housekeeping.prune(timedelta(0))
    assert gone.experiments == 1
    with pytest.raises(DeletedError, match="This experiment was deleted by its owner"):
        service.experiments.get(experiment.id)
    assert stored() == set()


@pytest.mark.slow
def test_bundled_photographs_are_taken_in_once(settings: Settings, make_service: Callable[..., Service]) -> None:
    settings = settings.model_copy(update={"samples_dir": Path("samples").resolve()})
    first = make_service(settings)
    first.start()
    first._background[0].join()
    found = first.samples.bundled()
    assert len(found) >= 20
    assert all(sample.bundled and sample.title for sample in found)
    first.close()
    second = make_service(settings)
    second.start()
    second._background[0].join()
    assert second.samples.bundled() == found
    assert second.housekeeping.prune(timedelta(0)).samples == 0


def _copied(service: Service, photograph: Path) -> Sample:
    return service.samples.add(Path(shutil.copy(photograph, photograph.with_suffix(".copy"))), None)

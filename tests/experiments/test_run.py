"""A job ends in a record whatever goes wrong: people get a sentence, the operator a log line, the disk is clean."""

import errno
import logging
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.errors import AppError, CancelledError, TimeLimitError
from app.experiments import run
from app.experiments.model import Experiment, ExperimentInput, Sample, Status, deep_job
from app.experiments.run import MAX_ATTEMPTS, run_job
from app.images.crop import Rectangle
from app.images.png_writer import encode_png
from app.methods.context import Context
from app.methods.model import Picture
from app.methods.registry import METHODS
from app.store.blobs import FileBlobs
from app.store.sql import SqlStore
from tests.store.records import a_sample, an_experiment

FULL = OSError(errno.ENOSPC, "No space left on device")
CROP = Rectangle(2, 3, 20, 16)


def silent(stage: str, fraction: float) -> None:
    pass


@pytest.fixture
def store(tmp_path: Path) -> SqlStore:
    return SqlStore(f"sqlite:///{tmp_path}/texture.sqlite3")


@pytest.fixture
def blobs(tmp_path: Path) -> FileBlobs:
    return FileBlobs(tmp_path / "files")


@pytest.fixture
def sample(store: SqlStore, blobs: FileBlobs) -> Sample:
    pixels = np.random.default_rng(1).integers(0, 256, (24, 32, 3), dtype=np.uint8)
    sample = replace(a_sample(), width=32, height=24, digest=blobs.put(encode_png(pixels)))
    store.add_sample(sample)
    return sample


@pytest.fixture
def submitted(store: SqlStore, sample: Sample) -> Callable[..., Experiment]:
    def submit(**values: Any) -> Experiment:
        inputs = (ExperimentInput(sample.id, CROP),)
        parameters = METHODS["rpn"].params(width=24, height=18, seed=1).model_dump(mode="json")
        experiment = an_experiment(sample, inputs=inputs, parameters=parameters, **values)
        store.add(experiment)
        return experiment

    return submit


@pytest.fixture
def experiment(submitted: Callable[..., Experiment]) -> Experiment:
    return submitted()


Breaking = Callable[[BaseException], None]


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> Breaking:
    """Let the method raise what is given, after its first picture."""
    original = METHODS["rpn"]

    def breaking(error: BaseException) -> None:
        def failing(sources: Any, params: Any, context: Context) -> Iterator[Picture]:
            yield next(iter(original.run(sources, params, context)))
            raise error

        monkeypatch.setitem(METHODS, "rpn", replace(original, run=failing))

    return breaking


def left_over(blobs: FileBlobs) -> list[Path]:
    return list(blobs.temporary_directory.iterdir())


def test_a_job_is_recorded_with_what_it_made(
    store: SqlStore, blobs: FileBlobs, experiment: Experiment, caplog: pytest.LogCaptureFixture
) -> None:
    run_job(store, blobs, experiment.id, silent, threads=1)
    made = store.get(experiment.id)
    assert (made.status, made.error, made.attempts) == (Status.SUCCEEDED, None, 1)
    assert made.outputs[0].name == "texture"
    for output in made.outputs:
        assert blobs.path(output.digest).stat().st_size == output.bytes
    assert left_over(blobs) == []
    assert caplog.records == []


# What goes wrong


@pytest.mark.parametrize(
    ("error", "words", "logged"),
    [
        (FULL, "could not read or write its files. Its operator finds the reason in the log", True),
        (ZeroDivisionError("not for people"), "Something went wrong inside the method", True),
        (RuntimeError("not for people"), "This is a fault of the service, not yours", True),
        (MemoryError(), "not enough memory for this experiment: try a smaller width", False),
        (AppError("The stars are against it."), "The stars are against it.", False),
        (TimeLimitError("This run took longer than 3 seconds."), "took longer than 3 seconds", False),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, Exception) else None,
)
def test_a_fault_is_recorded_in_words_and_logged_where_people_cannot_mend_it(
    store: SqlStore,
    blobs: FileBlobs,
    experiment: Experiment,
    broken: Breaking,
    caplog: pytest.LogCaptureFixture,
    error: Exception,
    words: str,
    logged: bool,
) -> None:
    broken(error)
    run_job(store, blobs, experiment.id, silent, threads=1)
    failed = store.get(experiment.id)
    assert failed.status is Status.FAILED
    assert failed.finished_at is not None
    assert failed.error is not None
    assert words in failed.error
    assert "not for people" not in failed.error
    assert failed.outputs == ()
    assert left_over(blobs) == []
    assert [(record.levelno, record.message) for record in caplog.records] == (
        [(logging.ERROR, f"job {experiment.id} failed")] if logged else []
    )
    if logged:
        assert caplog.records[0].exc_info is not None
        assert caplog.records[0].exc_info[1] is error


@pytest.mark.parametrize("where", ["temporary", "put_file", "path", "lease"])
def test_a_disk_that_fails_anywhere_fails_the_experiment_and_is_logged(
    store: SqlStore,
    blobs: FileBlobs,
    experiment: Experiment,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    where: str,
) -> None:
    """Else it would stay "running" for ever."""

    def full(*_: Any) -> Any:
        raise FULL

    monkeypatch.setattr(blobs, where, full)
    run_job(store, blobs, experiment.id, silent, threads=1)
    failed = store.get(experiment.id)
    assert failed.status is Status.FAILED
    assert "operator finds the reason in the log" in (failed.error or "")
    assert "No space left on device" in caplog.text
    monkeypatch.undo()
    assert left_over(blobs) == []


def test_the_second_of_two_pictures_that_finds_the_disk_full_leaves_nothing(
    store: SqlStore, blobs: FileBlobs, experiment: Experiment, monkeypatch: pytest.MonkeyPatch
) -> None:
    temporary, count = blobs.temporary, iter(range(9))

    def full(data: bytes) -> Path:
        if next(count):
            raise FULL
        return temporary(data)

    monkeypatch.setattr(blobs, "temporary", full)
    run_job(store, blobs, experiment.id, silent, threads=1)
    assert store.get(experiment.id).status is Status.FAILED
    assert left_over(blobs) == []


def test_a_cancelled_job_records_nothing_and_leaves_nothing(
    store: SqlStore, blobs: FileBlobs, experiment: Experiment, broken: Breaking, caplog: pytest.LogCaptureFixture
) -> None:
    """Whoever cancelled it has recorded that before."""
    broken(CancelledError("The experiment was cancelled."))
    run_job(store, blobs, experiment.id, silent, threads=1)
    found = store.get(experiment.id)
    assert (found.status, found.error, found.outputs) == (Status.RUNNING, None, ())
    assert left_over(blobs) == []
    assert caplog.records == []


@pytest.mark.parametrize("end", ["cancel", "delete"])
def test_what_was_ended_before_is_not_run(
    store: SqlStore, blobs: FileBlobs, experiment: Experiment, broken: Breaking, end: str
) -> None:
    broken(AssertionError("it ran"))
    getattr(store, end)(experiment.id)
    run_job(store, blobs, experiment.id, silent, threads=1)
    if end == "cancel":
        assert store.get(experiment.id).status is Status.CANCELLED


@pytest.mark.parametrize("earlier", [MAX_ATTEMPTS - 1, MAX_ATTEMPTS])
def test_an_experiment_that_ends_its_worker_again_and_again_fails(
    store: SqlStore, blobs: FileBlobs, experiment: Experiment, earlier: int
) -> None:
    """It is begun as often as is allowed, and once more to be told why it is not."""
    for _ in range(earlier):
        store.start(experiment.id)
    run_job(store, blobs, experiment.id, silent, threads=1)
    ended = store.get(experiment.id)
    assert ended.attempts == earlier + 1
    if earlier < MAX_ATTEMPTS:
        assert ended.status is Status.SUCCEEDED
    else:
        assert ended.status is Status.FAILED
        assert "again and again: try a smaller width and height" in (ended.error or "")


# At 16 bits


@pytest.fixture
def made(store: SqlStore, blobs: FileBlobs, experiment: Experiment) -> Experiment:
    run_job(store, blobs, experiment.id, silent, threads=1)
    return store.get(experiment.id)


@pytest.mark.parametrize(
    ("error", "words", "logged"),
    [
        (FULL, "could not read or write its files", True),
        (ZeroDivisionError("not for people"), "Something went wrong inside the method", True),
        (MemoryError(), "not enough memory", False),
        (AppError("The stars are against it."), "The stars are against it.", False),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, Exception) else None,
)
def test_a_fault_at_16_bits_is_raised_in_words_and_leaves_the_experiment_as_it_is(
    store: SqlStore,
    blobs: FileBlobs,
    made: Experiment,
    broken: Breaking,
    caplog: pytest.LogCaptureFixture,
    error: Exception,
    words: str,
    logged: bool,
) -> None:
    broken(error)
    with pytest.raises(AppError, match=words):
        run_job(store, blobs, deep_job(made.id, "periodic"), silent, threads=1)
    assert store.get(made.id) == made
    assert left_over(blobs) == []
    assert [record.message for record in caplog.records] == [f"job {made.id}@16:periodic failed"] * logged
    assert all(record.exc_info is not None and record.exc_info[1] is error for record in caplog.records)


def test_a_cancelled_job_at_16_bits_stays_cancelled(
    store: SqlStore, blobs: FileBlobs, made: Experiment, broken: Breaking, caplog: pytest.LogCaptureFixture
) -> None:
    broken(CancelledError("The experiment was cancelled."))
    with pytest.raises(CancelledError):
        run_job(store, blobs, deep_job(made.id, "periodic"), silent, threads=1)
    assert store.get(made.id) == made
    assert caplog.records == []


def test_the_output_at_16_bits_is_made_once_with_the_textures_before_it(
    store: SqlStore, blobs: FileBlobs, made: Experiment, broken: Breaking
) -> None:
    run_job(store, blobs, deep_job(made.id, "periodic"), silent, threads=1)
    found = store.get(made.id)
    assert [output.name for output in found.outputs if not output.listed] == [".texture-16", ".periodic-16"]
    assert left_over(blobs) == []
    broken(AssertionError("it ran again"))
    run_job(store, blobs, deep_job(made.id, "periodic"), silent, threads=1)
    assert store.get(made.id) == found


@pytest.mark.parametrize("state", ["unknown", "deleted", "failed"])
def test_nothing_is_made_at_16_bits_of_what_is_not_there(
    store: SqlStore, blobs: FileBlobs, experiment: Experiment, broken: Breaking, state: str
) -> None:
    broken(AssertionError("it ran"))
    if state == "deleted":
        store.delete(experiment.id)
    elif state == "failed":
        store.fail(experiment.id, "a reason")
    name = "unknown" if state == "unknown" else experiment.id
    run_job(store, blobs, deep_job(name, "texture"), silent, threads=1)
    assert left_over(blobs) == []


# For one answer


def test_a_transient_experiment_keeps_the_output_that_is_wanted_and_measures_nothing(
    store: SqlStore, blobs: FileBlobs, submitted: Callable[..., Experiment]
) -> None:
    experiment = submitted(transient=True, wanted="periodic")
    run_job(store, blobs, experiment.id, silent, threads=1)
    made = store.get(experiment.id)
    assert [output.name for output in made.outputs] == ["periodic"]
    assert made.diagnostics == {}
    assert left_over(blobs) == []


def test_pictures_before_the_wanted_one_are_removed_and_later_ones_not_made(tmp_path: Path) -> None:
    files = [tmp_path / name for name in ("first", "second", "third")]

    def pictures() -> Iterator[Picture]:
        for path in files:
            path.touch()
            yield Picture(path.name, path.name, 1, 1, path)

    assert [picture.name for picture in run.pick(pictures(), "second")] == ["second"]
    assert [path.exists() for path in files] == [False, True, False]


# Seconds by stage


class Clock:
    """A clock that stands still but for what is added."""

    def __init__(self) -> None:
        self.now = 1000.0

    def perf_counter(self) -> float:
        return self.now


def test_the_seconds_of_a_stage_are_those_between_its_first_call_and_the_next_stages(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A stage that comes again goes on; what is before the first one counts nowhere."""
    clock = Clock()
    monkeypatch.setattr(run, "time", clock)
    passed: list[tuple[str, float]] = []
    stages = run.StageTimer(lambda stage, fraction: passed.append((stage, fraction)))
    clock.now += 100
    calls = [
        ("reading", 0.0, 1.0),
        ("spot", 0.1, 2.0),
        ("spot", 0.2, 4.0),
        ("reading", 0.5, 8.0),
        ("writing", 1.0, 16.0),
    ]
    for stage, fraction, seconds in calls:
        stages(stage, fraction)
        clock.now += seconds
    assert stages.seconds() == {"reading": 9.0, "spot": 6.0, "writing": 16.0}
    assert passed == [(stage, fraction) for stage, fraction, _ in calls]
    clock.now += 32
    assert stages.seconds() == {"reading": 9.0, "spot": 6.0, "writing": 48.0}


def test_the_seconds_before_any_stage_are_nobodys(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(run, "time", clock)
    stages = run.StageTimer(silent)
    clock.now += 5
    assert stages.seconds() == {}


def test_the_recorded_timings_are_the_seconds_of_the_stages_in_their_order(
    store: SqlStore, blobs: FileBlobs, experiment: Experiment, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a clock that every call of progress moves on by a second, a stage has as many seconds as calls."""
    clock = Clock()
    monkeypatch.setattr(run, "time", clock)
    calls: dict[str, int] = {}

    def progress(stage: str, fraction: float) -> None:
        calls[stage] = calls.get(stage, 0) + 1
        last.append((stage, fraction))

    last: list[tuple[str, float]] = []

    class Ticking(run.StageTimer):
        def __call__(self, stage: str, fraction: float) -> None:
            super().__call__(stage, fraction)
            clock.now += 1

    monkeypatch.setattr(run, "StageTimer", Ticking)
    run_job(store, blobs, experiment.id, progress, threads=1)
    assert list(store.get(experiment.id).timings.items()) == [(stage, float(count)) for stage, count in calls.items()]
    assert last[0] == ("reading the crop", 0.0)
    assert last[-1] == ("writing", 1.0)
    fractions = [fraction for _, fraction in last]
    assert fractions == sorted(fractions)
    assert all(0 <= fraction <= 1 for fraction in fractions)

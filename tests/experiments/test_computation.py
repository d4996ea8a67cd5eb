"""What a run records: outputs, at 16 bits too, only the wanted one for one answer, and the seconds of its stages."""

import pytest

from app.errors import AppError, CancelledError
from app.experiments import computation, stage_timer
from app.experiments.model import Experiment, deep_job
from app.store.blobs import FileBlobs
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.experiments.jobs import Breaking, lease_of, left_over, run, submit
from tests.still_clock import Clock


@pytest.fixture
def made(store: SqlStore, blobs: FileBlobs, queued: Experiment) -> Experiment:
    run(store, blobs, queued.id)
    return store.get(queued.id)


@pytest.mark.parametrize(
    ("error", "words", "logged"),
    [
        (ZeroDivisionError("not for people"), "Something went wrong inside the method", True),
        (MemoryError(), "not enough memory", False),
        (AppError("The stars are against it."), "The stars are against it.", False),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, Exception) else None,
)
def test_a_fault_at_16_bits_is_kept_in_words_and_leaves_the_experiment_as_it_is(
    store: SqlStore,
    blobs: FileBlobs,
    made: Experiment,
    broken: Breaking,
    caplog: pytest.LogCaptureFixture,
    error: Exception,
    words: str,
    logged: bool,
) -> None:
    """Every process finds the words, until it is asked for again."""
    broken(error)
    job = deep_job(made.id, "periodic")
    run(store, blobs, job)
    queue = SqlQueue(store.database)
    assert words in (queue.failure(job) or "")
    assert store.get(made.id) == made
    assert left_over(blobs) == []
    assert [record.message for record in caplog.records] == [f"job {made.id}@16:periodic failed"] * logged
    assert all(record.exc_info is not None and record.exc_info[1] is error for record in caplog.records)
    queue.enqueue(job, "tests")
    assert queue.failure(job) is None


def test_a_cancelled_job_at_16_bits_stays_cancelled(
    store: SqlStore, blobs: FileBlobs, made: Experiment, broken: Breaking, caplog: pytest.LogCaptureFixture
) -> None:
    broken(CancelledError("The experiment was cancelled."))
    run(store, blobs, deep_job(made.id, "periodic"))
    assert store.get(made.id) == made
    assert caplog.records == []


def test_the_output_at_16_bits_is_made_once_with_the_textures_before_it(
    store: SqlStore, blobs: FileBlobs, made: Experiment, broken: Breaking
) -> None:
    run(store, blobs, deep_job(made.id, "periodic"))
    found = store.get(made.id)
    assert [output.name for output in found.outputs if not output.listed] == [".texture-16", ".periodic-16"]
    assert left_over(blobs) == []
    broken(AssertionError("it ran again"))
    run(store, blobs, deep_job(made.id, "periodic"))
    assert store.get(made.id) == found


@pytest.mark.parametrize("state", ["unknown", "deleted", "failed"])
def test_nothing_is_made_at_16_bits_of_what_is_not_there(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, broken: Breaking, state: str
) -> None:
    broken(AssertionError("it ran"))
    if state == "deleted":
        store.delete(queued.id)
    elif state == "failed":
        store.fail(lease_of(store, queued.id), "a reason")
    else:
        store.cancel(queued.id)
    name = "unknown" if state == "unknown" else queued.id
    run(store, blobs, deep_job(name, "texture"))
    assert left_over(blobs) == []


def test_a_transient_experiment_keeps_the_output_that_is_wanted_and_measures_nothing(
    store: SqlStore, blobs: FileBlobs
) -> None:
    experiment = submit(store, blobs, transient=True, wanted="periodic")
    run(store, blobs, experiment.id)
    made = store.get(experiment.id)
    assert [output.name for output in made.outputs] == ["periodic"]
    assert made.diagnostics == {}
    assert left_over(blobs) == []


def test_the_recorded_timings_are_the_seconds_of_the_stages_in_their_order(
    store: SqlStore, blobs: FileBlobs, queued: Experiment, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a clock that every call of progress moves on by a second, a stage has as many seconds as calls."""
    clock = Clock()
    monkeypatch.setattr(stage_timer, "time", clock)
    calls: dict[str, int] = {}
    last: list[tuple[str, float]] = []

    class Ticking(stage_timer.StageTimer):
        def __call__(self, stage: str, fraction: float) -> None:
            super().__call__(stage, fraction)
            calls[stage] = calls.get(stage, 0) + 1
            last.append((stage, fraction))
            clock.now += 1

    monkeypatch.setattr(computation, "StageTimer", Ticking)
    run(store, blobs, queued.id)
    assert list(store.get(queued.id).timings.items()) == [(stage, float(count)) for stage, count in calls.items()]
    assert last[0] == ("reading the crop", 0.0)
    assert last[-1] == ("writing", 1.0)
    fractions = [fraction for _, fraction in last]
    assert fractions == sorted(fractions)
    assert all(0 <= fraction <= 1 for fraction in fractions)

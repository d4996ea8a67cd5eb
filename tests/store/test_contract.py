"""What every experiment store promises, whatever database is below it."""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.errors import ConflictError, DeletedError, InvalidInputError, NotFoundError
from app.experiments.model import Experiment, ExperimentInput, Lease, Sample, Status, deep_job
from app.images.crop import Frames, Rectangle
from app.store.sql import SqlStore
from tests.profiles import examples
from tests.store.records import START, a_sample, an_experiment, an_output, lease_of, started, succeeded


def test_gives_samples_back_as_they_were(store: SqlStore) -> None:
    sample = a_sample(transparent=True, channels=1, depth=16, title="Sand — fine", bundled=True)
    store.add_sample(sample, owner="someone")
    assert store.sample(sample.id) == sample
    assert store.bundled_samples() == [sample]


def test_gives_videos_back_as_they_were(store: SqlStore) -> None:
    """A clip as a sample, a part of it as an input, and a film as an output: frames, rates and types."""
    sample = a_sample(frames=72, rate=24000 / 1001, media_type="video/webm")
    store.add_sample(sample)
    assert store.sample(sample.id) == sample
    part = ExperimentInput(sample.id, Rectangle(1, 2, 30, 40), Frames(12, 48))
    experiment = an_experiment(sample, inputs=(part,))
    store.add(experiment)
    lease = started(store, experiment)
    film = an_output(media_type="video/mp4", frames=96, rate=100 / 7)
    store.succeed(lease, [film], {}, {}, {})
    found = store.get(experiment.id)
    assert (found.inputs, found.outputs) == ((part,), (film,))


def test_gives_experiments_back_as_they_were(store: SqlStore, sample: Sample) -> None:
    experiment = an_experiment(sample, listed=False, transient=True)
    store.add(experiment)
    assert store.get(experiment.id) == experiment


def test_replaces_an_experiment_its_outputs_and_its_tombstone(store: SqlStore, sample: Sample) -> None:
    made = succeeded(store, sample)
    anew = an_experiment(sample, id=made.id, method="adsn")
    store.replace(anew)
    assert store.get(made.id) == anew
    store.delete(made.id)
    store.replace(anew)
    assert store.get(made.id) == anew
    other = an_experiment(sample)
    store.replace(other)
    assert store.get(other.id) == other


def test_survives_reopening(store: SqlStore, sample: Sample, open_store: Callable[[], SqlStore]) -> None:
    experiment = succeeded(store, sample)
    assert open_store().get(experiment.id) == experiment


@pytest.mark.parametrize("name", ["", "nothing", "with\0nul", "\ud800", "x" * 10_000])
def test_says_that_it_does_not_know_a_name(store: SqlStore, name: str) -> None:
    with pytest.raises(NotFoundError, match="There is no such experiment"):
        store.get(name)
    with pytest.raises(NotFoundError, match="There is no such photograph"):
        store.sample(name)
    assert store.page(limit=3, method=name).experiments == ()


def test_refuses_an_experiment_of_a_sample_that_is_gone(store: SqlStore) -> None:
    with pytest.raises(NotFoundError, match="There is no such photograph"):
        store.add(an_experiment(a_sample()))


def test_refuses_the_same_identifier_twice(store: SqlStore, sample: Sample) -> None:
    experiment = an_experiment(sample)
    store.add(experiment)
    with pytest.raises(ConflictError, match="An experiment with this identifier exists already"):
        store.add(experiment)


def test_success_is_recorded_with_its_outputs_in_order(store: SqlStore, sample: Sample) -> None:
    experiment = succeeded(store, sample)
    assert experiment.status is Status.SUCCEEDED
    assert [output.name for output in experiment.outputs] == ["texture", "crop", ".thumbnail-crop"]
    assert list(experiment.timings.items()) == [("b", 0.5), ("a", 0.25)]
    assert experiment.outputs[0].bytes == 5 << 30
    assert experiment.started_at is not None
    assert experiment.finished_at is not None
    assert experiment.attempts == ()


def test_the_first_end_is_the_one_that_counts(store: SqlStore, sample: Sample) -> None:
    ends: dict[Status, Callable[[Lease], bool]] = {
        Status.SUCCEEDED: lambda lease: store.succeed(lease, [an_output()], {}, {}, {}),
        Status.FAILED: lambda lease: store.fail(lease, "too large"),
        Status.CANCELLED: lambda lease: store.cancel(lease.job),
    }
    for first, end in ends.items():
        experiment = an_experiment(sample)
        store.add(experiment)
        lease = started(store, experiment)
        assert end(lease)
        recorded = store.get(experiment.id)
        assert recorded.status is first
        assert not any(other(lease) for other in ends.values())
        assert store.get(experiment.id) == recorded


def test_only_a_running_experiment_succeeds(store: SqlStore, sample: Sample) -> None:
    experiment = an_experiment(sample)
    store.add(experiment)
    assert not store.succeed(lease_of(store, experiment.id), [an_output()], {}, {}, {})
    assert store.get(experiment.id) == experiment


def test_what_waits_can_fail_and_be_cancelled(store: SqlStore, sample: Sample) -> None:
    failing, cancelled = an_experiment(sample), an_experiment(sample)
    for experiment in (failing, cancelled):
        store.add(experiment)
    assert store.fail(lease_of(store, failing.id), "a reason")
    assert store.cancel(cancelled.id)
    assert store.get(failing.id).error == "a reason"
    assert store.counts() == {"queued": 0, "running": 0, "succeeded": 0, "failed": 1, "cancelled": 1}


def test_an_output_can_be_added_and_replaced(store: SqlStore, sample: Sample) -> None:
    experiment = succeeded(store, sample)
    lease = lease_of(store, deep_job(experiment.id, "texture"))
    for output in (an_output(".texture-16"), an_output(".texture-16")):
        assert store.add_output(lease, output)
        assert store.get(experiment.id).outputs == (*experiment.outputs, output)


def test_an_unfinished_experiment_takes_no_output(store: SqlStore, sample: Sample) -> None:
    experiment = an_experiment(sample)
    store.add(experiment)
    lease = lease_of(store, deep_job(experiment.id, "texture"))
    with pytest.raises(ConflictError, match="Only an experiment that succeeded has outputs"):
        store.add_output(lease, an_output())


def test_listing_can_be_changed(store: SqlStore, sample: Sample) -> None:
    experiment = succeeded(store, sample)
    store.set_listed(experiment.id, False)
    assert not store.get(experiment.id).listed
    assert store.page(limit=5).experiments == ()
    store.set_listed(experiment.id, True)
    assert [found.id for found in store.page(limit=5).experiments] == [experiment.id]
    with pytest.raises(NotFoundError, match="There is no such experiment"):
        store.set_listed("nothing", True)


def test_a_deleted_experiment_leaves_a_tombstone_and_nothing_else(store: SqlStore, sample: Sample) -> None:
    experiment = succeeded(store, sample)
    digests = {output.digest for output in experiment.outputs}
    assert store.used(digests) == digests
    for _ in range(2):
        store.delete(experiment.id)
    with pytest.raises(DeletedError, match="This experiment was deleted by its owner"):
        store.get(experiment.id)
    assert store.used(digests) == set()
    assert store.page(limit=5).experiments == ()


def test_a_transient_experiment_leaves_no_tombstone(store: SqlStore, sample: Sample) -> None:
    experiment = an_experiment(sample, transient=True)
    store.add(experiment)
    assert store.transient_before(START + timedelta(seconds=1)) == [experiment.id]
    store.delete(experiment.id)
    with pytest.raises(NotFoundError, match="There is no such experiment"):
        store.get(experiment.id)


def test_only_unused_old_uploads_are_removed(store: SqlStore, sample: Sample) -> None:
    unused, other, young = a_sample(), a_sample(), a_sample(created_at=START + timedelta(days=2))
    bundled = a_sample(title="Sand", bundled=True)
    for each in (unused, other, young, bundled):
        store.add_sample(each)
    experiment = an_experiment(sample)
    store.add(experiment)
    later = START + timedelta(days=1)
    assert store.remove_unused_samples(later, [sample.id, unused.id]) == [unused]
    assert store.remove_unused_samples(later) == [other]
    store.delete(experiment.id)
    assert store.remove_unused_samples(later) == [sample]
    assert store.used([unused.digest, sample.digest, young.digest, bundled.digest]) == {young.digest, bundled.digest}


@settings(max_examples=examples(15), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(ages=st.lists(st.integers(0, 4), max_size=12), limit=st.integers(1, 5))
def test_paging_shows_every_experiment_once_newest_first(store: SqlStore, ages: list[int], limit: int) -> None:
    for experiment in store.page(limit=100).experiments:
        store.delete(experiment.id)
    sample = a_sample()
    store.add_sample(sample)
    made = [succeeded(store, sample, created_at=START + timedelta(microseconds=age)) for age in ages]
    store.add(an_experiment(sample))
    succeeded(store, sample, listed=False)
    seen: list[Experiment] = []
    cursor = None
    while True:
        page = store.page(limit=limit, cursor=cursor)
        seen += page.experiments
        assert len(page.experiments) <= limit
        cursor = page.cursor
        if cursor is None:
            break
        assert len(page.experiments) == limit
    assert sorted(each.id for each in seen) == sorted(each.id for each in made)
    assert [each.created_at for each in seen] == sorted((each.created_at for each in made), reverse=True)


def test_pages_can_be_of_one_method(store: SqlStore, sample: Sample) -> None:
    adsn = succeeded(store, sample, method="adsn")
    succeeded(store, sample)
    assert [each.id for each in store.page(limit=5, method="adsn").experiments] == [adsn.id]


@pytest.mark.parametrize("cursor", ["", "nonsense", "AAAA", "OTk5OTk5OTk5OTk5OTk5OTk5OTk5LmE", "é", "MS4A", "\ud800"])
def test_a_cursor_of_nobody_is_refused(store: SqlStore, cursor: str) -> None:
    with pytest.raises(InvalidInputError, match="no such cursor"):
        store.page(limit=5, cursor=cursor)


def test_finds_what_finished_before_a_moment(store: SqlStore, sample: Sample) -> None:
    before = datetime.now(UTC)
    experiment = succeeded(store, sample)
    store.add(an_experiment(sample))
    assert store.finished_before(before) == []
    assert store.finished_before(datetime.now(UTC) + timedelta(seconds=1)) == [experiment.id]

"""What every experiment store promises to several processes and threads at once."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta

from app.errors import NotFoundError
from app.experiments.model import Sample, Status
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.records import START, a_sample, an_experiment, an_output, started


def test_a_sample_is_never_lost_to_a_new_experiment(store: SqlStore, open_store: Callable[[], SqlStore]) -> None:
    """Removing unused samples while experiments of them are added: whichever comes first, both agree."""
    other = open_store()
    samples = [a_sample() for _ in range(20)]
    for sample in samples:
        store.add_sample(sample)

    def adding(sample: Sample) -> bool:
        try:
            other.add(an_experiment(sample))
        except NotFoundError:
            return False
        return True

    with ThreadPoolExecutor(2) as pool:
        removing = pool.submit(store.remove_unused_samples, START + timedelta(days=1))
        added = list(pool.map(adding, reversed(samples)))
        removed = {sample.id for sample in removing.result()}
    assert {sample.id for sample, kept in zip(reversed(samples), added, strict=True) if not kept} == removed


def test_several_processes_may_make_the_schema_at_once(store_url: str) -> None:
    with ThreadPoolExecutor(6) as pool:
        stores = list(pool.map(lambda _: SqlStore(store_url), range(6)))
    for each in stores:
        each.add_sample(a_sample())
        each.close()


def test_writers_wait_for_one_another(store: SqlStore, sample: Sample, open_store: Callable[[], SqlStore]) -> None:
    experiments = [an_experiment(sample) for _ in range(40)]
    stores = [store, open_store()]

    def whole_life(number: int) -> bool:
        mine = stores[number % 2]
        mine.add(experiments[number])
        lease = SqlQueue(mine.database).lease("tests", alone=True)
        assert lease is not None
        mine.start(lease)
        return mine.succeed(lease, [an_output()], {}, {}, {})

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(whole_life, range(40)))
    assert store.counts()["succeeded"] == 40


def test_one_of_two_simultaneous_ends_wins(store: SqlStore, sample: Sample, open_store: Callable[[], SqlStore]) -> None:
    other = open_store()
    for _ in range(10):
        experiment = an_experiment(sample)
        store.add(experiment)
        lease = started(store, experiment)
        with ThreadPoolExecutor(2) as pool:
            success = pool.submit(store.succeed, lease, [an_output()], {}, {}, {})
            cancel = pool.submit(other.cancel, experiment.id)
            assert success.result() != cancel.result()
        recorded = store.get(experiment.id)
        assert (recorded.status is Status.SUCCEEDED) == success.result() == bool(recorded.outputs)

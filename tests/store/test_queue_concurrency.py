"""What the job queue promises to several processes and threads at once."""

import multiprocessing
import threading
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import psycopg
import pytest
import sqlalchemy as sa

from app.experiments.model import Lease, Sample, Status
from app.store.queue import SqlQueue
from app.store.schema import jobs
from app.store.sql import SqlStore
from tests.store.records import an_experiment, an_output

JOBS, WORKERS = 60, 6


def drain(url: str, holder: str) -> list[tuple[str, bool]]:
    """Lease, start and finish until nothing waits: each job with whether its success was recorded."""
    store = SqlStore(url)
    queue = SqlQueue(store.database)
    done = []
    while (lease := queue.lease(holder, alone=True)) is not None:
        started = store.start(lease)
        assert started is not None
        queue.renew(lease, "texture", 0.5)
        done.append((lease.job, store.succeed(lease, [an_output(digest=f"{holder}{lease.job}")], {}, {}, {})))
    store.close()
    return done


def fill(store: SqlStore, sample: Sample, count: int) -> list[str]:
    experiments = [an_experiment(sample) for _ in range(count)]
    for number, experiment in enumerate(experiments):
        store.add(experiment, f"client{number % 7}")
    return [experiment.id for experiment in experiments]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["threads", "processes"])
def test_no_job_is_run_twice_and_none_is_left(store: SqlStore, sample: Sample, store_url: str, kind: str) -> None:
    names = fill(store, sample, JOBS)
    context = multiprocessing.get_context("forkserver")
    pool = ThreadPoolExecutor(WORKERS) if kind == "threads" else ProcessPoolExecutor(WORKERS, context)
    with pool:
        runs = [run for part in pool.map(drain, [store_url] * WORKERS, map(str, range(WORKERS))) for run in part]
    assert Counter(name for name, _ in runs) == Counter(names)
    assert all(recorded for _, recorded in runs)
    assert store.counts()["succeeded"] == JOBS
    assert {len(store.get(name).outputs) for name in names} == {1}


def test_of_simultaneous_ends_one_wins(store: SqlStore, sample: Sample, open_store: Callable[[], SqlStore]) -> None:
    """Success, failure, cancellation, release, lapse: whichever it was, record and queue agree on it."""
    stores = [store, *(open_store() for _ in range(4))]
    queues = [SqlQueue(each.database) for each in stores]
    for _ in range(12):
        [name] = fill(store, sample, 1)
        lease = queues[0].lease("engine", alone=True)
        assert lease is not None
        assert store.start(lease) is not None
        together = threading.Barrier(5)

        def end(number: int, lease: Lease = lease, together: threading.Barrier = together) -> bool:
            ends: list[Callable[[], bool]] = [
                lambda: stores[0].succeed(lease, [an_output()], {}, {}, {}),
                lambda: stores[1].fail(lease, "a reason"),
                lambda: stores[2].cancel(lease.job),
                lambda: queues[3].release(lease, "It was killed."),
                lambda: queues[4].lapse(lease.job, lease.fence, 0),
            ]
            together.wait(20)
            return ends[number]()

        with ThreadPoolExecutor(5) as pool:
            success, failure, cancelled, released, lapsed = pool.map(end, range(5))
        # What was put back could be cancelled after.
        assert success + failure + (released or lapsed or cancelled) == 1
        record, job = store.get(name), queues[0].states([name])
        ended = {Status.SUCCEEDED: success, Status.FAILED: failure, Status.CANCELLED: cancelled}
        expected = next((status for status, won in ended.items() if won), Status.QUEUED)
        assert record.status is expected
        assert bool(record.outputs) == success
        assert len(record.attempts) == released
        assert bool(job) == (expected is Status.QUEUED)
        store.cancel(name)


def test_an_engine_does_not_wait_for_the_job_that_another_one_takes(
    postgresql_server: str, request: pytest.FixtureRequest
) -> None:
    """On PostgreSQL it skips the row that is locked, and takes the next one at once."""
    name = f"texture_{id(request)}"
    with psycopg.connect(f"{postgresql_server.replace('+psycopg', '')}/postgres", autocommit=True) as connection:
        connection.execute(f'CREATE DATABASE "{name}"')
    store = SqlStore(f"{postgresql_server}/{name}")
    queue = SqlQueue(store.database)
    for job in ("a@16:texture", "b@16:texture"):
        queue.enqueue(job, "ann")
    with store.database.writing() as connection:
        connection.execute(sa.select(jobs).where(jobs.c.id == "a@16:texture").with_for_update())
        lease = queue.lease("engine", alone=True)
        assert lease is not None
        assert lease.job == "b@16:texture"
    store.close()


def test_of_those_who_ask_for_the_same_output_at_once_one_queues_it(
    store: SqlStore, open_store: Callable[[], SqlStore]
) -> None:
    queues = [SqlQueue(each.database) for each in (store, *(open_store() for _ in range(3)))]
    for number in range(10):
        together = threading.Barrier(4)

        def ask(queue: SqlQueue, job: str = f"{number}@16:texture", together: threading.Barrier = together) -> None:
            together.wait(20)
            queue.enqueue(job, "ann")

        with ThreadPoolExecutor(4) as pool:
            list(pool.map(ask, queues))
        assert queues[0].waiting() == number + 1

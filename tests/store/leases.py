"""Jobs in a queue, and what leases them."""

from app.experiments.model import Lease, Sample
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.records import an_experiment

ENGINE = "tcp://127.0.0.1:1#1"


def queued(store: SqlStore, sample: Sample, client: str = "ann") -> str:
    experiment = an_experiment(sample)
    store.add(experiment, client)
    return experiment.id


def leased(queue: SqlQueue, *, alone: bool = True) -> Lease:
    lease = queue.lease(ENGINE, alone=alone)
    assert lease is not None
    return lease


def order(queue: SqlQueue) -> list[str]:
    found = []
    while (lease := queue.lease(ENGINE, alone=True)) is not None:
        found.append(lease.job)
    return found

"""Turns of places: who asks under many names from one place gets no more of them than anybody else."""

import random
from collections import Counter, defaultdict

import pytest

from app.experiments.model import Sample
from app.experiments.queue_port import PLACE
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.leases import leased, order, queued

HOME, OFFICE = "h" * PLACE, "o" * PLACE


def test_made_up_names_have_the_turns_of_one_place(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    flood = [queued(store, sample, f"{OFFICE}{number}") for number in range(6)]
    one = [queued(store, sample, f"{HOME}ann") for _ in range(3)]
    assert order(queue) == [flood[0], one[0], flood[1], one[1], flood[2], one[2], *flood[3:]]


def test_within_a_place_people_take_turns(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    ann = [queued(store, sample, f"{OFFICE}ann") for _ in range(3)]
    bob = queued(store, sample, f"{OFFICE}bob")
    elsewhere = [queued(store, sample, f"{HOME}cat") for _ in range(2)]
    assert order(queue) == [ann[0], elsewhere[0], bob, elsewhere[1], ann[1], ann[2]]


def test_what_runs_counts_for_the_person_and_for_the_place(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    ann = [queued(store, sample, f"{OFFICE}ann") for _ in range(2)]
    assert leased(queue).job == ann[0]
    bob = queued(store, sample, f"{OFFICE}bob")
    cat = queued(store, sample, f"{HOME}cat")
    assert order(queue) == [cat, bob, ann[1]]


def test_who_waits_is_counted_by_person_and_by_place(store: SqlStore, sample: Sample, queue: SqlQueue) -> None:
    for name in (f"{OFFICE}ann", f"{OFFICE}ann", f"{OFFICE}bob", f"{HOME}ann", f"{OFFICE[:-1]}%"):
        queued(store, sample, name)
    assert [queue.waiting_of(name) for name in (f"{OFFICE}ann", OFFICE, HOME, f"{OFFICE[:-1]}%")] == [2, 3, 1, 1]


@pytest.mark.parametrize("seed", range(3))
def test_the_order_is_that_of_a_game_with_two_rounds(
    store: SqlStore, sample: Sample, queue: SqlQueue, seed: int
) -> None:
    """Played with plain lists: every place deals its people's jobs out in turn, and the places deal in turn."""
    chance = random.Random(seed)
    names = [f"{chance.choice((HOME, OFFICE, 'x' * PLACE))}{chance.choice('abc')}" for _ in range(14)]
    came = {queued(store, sample, name): (number, name) for number, name in enumerate(names)}
    of_person: Counter[str] = Counter()
    dealt: dict[str, list[tuple[int, int, str]]] = defaultdict(list)
    for job, (number, name) in came.items():
        of_person[name] += 1
        dealt[name[:PLACE]].append((of_person[name], number, job))
    rounds = [(turn, number, job) for jobs in dealt.values() for turn, (_, number, job) in enumerate(sorted(jobs), 1)]
    assert order(queue) == [job for _, _, job in sorted(rounds)]

"""One client takes a share of the queue, one place at most half of it, and the others find room."""

import pytest

from app.errors import QuotaError
from app.experiments.model import deep_job
from app.experiments.queue_port import PLACE
from app.experiments.shares import LEAST, Shares
from app.settings import Settings
from app.store.queue import SqlQueue
from app.store.sql import SqlStore

HOME, OFFICE = "h" * PLACE, "o" * PLACE


@pytest.fixture
def queue(store: SqlStore) -> SqlQueue:
    return SqlQueue(store.database)


def fill(shares: Shares, queue: SqlQueue, client: str, at_most: int = 1000) -> int:
    """Queue jobs of a client until it is refused; how many were taken."""
    for number in range(at_most):
        try:
            shares.check(client)
        except QuotaError:
            return number
        queue.enqueue(deep_job(f"{client}-{number}", "texture"), client)
    return at_most


def test_one_client_takes_its_share_and_another_finds_room(queue: SqlQueue) -> None:
    shares = Shares(queue, Settings(limits=True, queue_limit=50, queue_share=0.2))
    assert fill(shares, queue, f"{OFFICE}ann") == 10
    assert fill(shares, queue, f"{HOME}bob") == 10
    assert fill(shares, queue, f"{OFFICE}cat") == 10


def test_made_up_names_take_no_more_than_half_of_the_queue(queue: SqlQueue) -> None:
    shares = Shares(queue, Settings(limits=True, queue_limit=50, queue_share=0.2))
    assert sum(fill(shares, queue, f"{OFFICE}{number}") for number in range(9)) == 25
    assert fill(shares, queue, f"{HOME}bob") == 10


def test_an_address_may_have_fewer_shares(queue: SqlQueue) -> None:
    shares = Shares(queue, Settings(limits=True, queue_limit=100, queue_share=0.1, limit_address=2))
    assert sum(fill(shares, queue, f"{OFFICE}{number}") for number in range(9)) == 20


def test_what_has_begun_gives_room(queue: SqlQueue) -> None:
    shares = Shares(queue, Settings(limits=True, queue_limit=50, queue_share=0.2))
    fill(shares, queue, f"{OFFICE}ann")
    assert queue.lease("engine", alone=True) is not None
    shares.check(f"{OFFICE}ann")


def test_a_share_of_a_short_queue_is_a_few(queue: SqlQueue) -> None:
    shares = Shares(queue, Settings(limits=True, queue_limit=3, queue_share=0.2))
    assert fill(shares, queue, f"{OFFICE}ann") == LEAST


def test_the_refusal_says_how_many_and_when_to_come_back(queue: SqlQueue) -> None:
    shares = Shares(queue, Settings(limits=True, queue_limit=50, queue_share=0.2))
    fill(shares, queue, f"{OFFICE}ann")
    with pytest.raises(QuotaError, match="10 of them wait already, and one client") as refusal:
        shares.check(f"{OFFICE}ann")
    assert refusal.value.retry_after > 0


@pytest.mark.parametrize(("limits", "client"), [(False, f"{OFFICE}ann"), (True, "")])
def test_a_private_host_and_the_service_itself_have_the_whole_queue(queue: SqlQueue, limits: bool, client: str) -> None:
    shares = Shares(queue, Settings(limits=limits, queue_limit=10))
    assert fill(shares, queue, client, 30) == 30

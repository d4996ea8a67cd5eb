"""A connection to a cluster: what of it fails is logged and let go, and nothing is left open."""

import asyncio
import logging
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest

from app.executor import engine, tasks
from app.executor.engine import Engine
from app.experiments.model import Lease
from app.settings import Settings

RUN = lambda settings, lease: None  # noqa: E731 - it is only passed on


class Cluster:
    """An embedded cluster with two nannies, whose closing may fail."""

    def __init__(self, error: Exception | None = None) -> None:
        self.error = error
        self.done: list[str] = []
        self.workers = {name: self._nanny(name, lost=name == "lost") for name in ("lost", "there")}

    def _nanny(self, name: str, *, lost: bool) -> Any:
        process = (
            None if lost else SimpleNamespace(process=SimpleNamespace(kill=lambda: self.done.append(f"kill {name}")))
        )
        return SimpleNamespace(close_gracefully=lambda: self.done.append(f"retire {name}"), process=process)

    def close(self, timeout: float) -> None:
        self.done.append("close")
        if self.error is not None:
            raise self.error


class Client:
    """A client that notes what it is asked, and fails where it is told to."""

    failing: tuple[str, ...] = ()
    made: ClassVar[list["Client"]] = []

    def __init__(self, address: Any, **_: Any) -> None:
        if "open" in self.failing:
            raise OSError("no scheduler answers")
        self.address = address
        self.status = "running"
        self.done: list[Any] = []
        self.made.append(self)

    def subscribe_topic(self, topic: str, handler: Any) -> None:
        self.done.append(("subscribe", topic.split("-", maxsplit=1)[0]))

    def unsubscribe_topic(self, topic: str) -> None:
        if "unsubscribe" in self.failing:
            raise OSError("it is broken")

    def submit(self, function: Any, *arguments: Any, **options: Any) -> Any:
        self.done.append((function, arguments, options))
        return SimpleNamespace(key=options["key"])

    def close(self, timeout: float) -> None:
        self.done.append("close")

    async def _run(self, function: Any, *arguments: Any, **options: Any) -> None:
        self.done.append((function.__name__, arguments, options))
        if function is tasks.kill_worker and "nanny" in self.failing:
            raise OSError("the nanny is gone")


@pytest.fixture
def client(monkeypatch: pytest.MonkeyPatch) -> type[Client]:
    monkeypatch.setattr(Client, "failing", ())
    monkeypatch.setattr(Client, "made", [])
    monkeypatch.setattr(engine, "Client", Client)
    return Client


@pytest.fixture
def cluster(monkeypatch: pytest.MonkeyPatch) -> Cluster:
    cluster = Cluster()
    monkeypatch.setattr(engine, "_local_cluster", lambda settings, run: cluster)
    return cluster


def opened(**settings: Any) -> Engine:
    return Engine(Settings(data_dir=Path("unused"), **settings), RUN, on_workers=lambda: None)


def test_a_cluster_whose_client_does_not_come_up_is_closed(
    client: type[Client], cluster: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else its processes would stay, once for every attempt to open the engine."""
    monkeypatch.setattr(client, "failing", ("open",))
    with pytest.raises(OSError, match="no scheduler answers"):
        opened()
    assert cluster.done == ["retire lost", "retire there", "kill there", "close"]


def test_closing_kills_the_workers_and_starts_no_others(client: type[Client], cluster: Cluster) -> None:
    """One whose process is gone already keeps no other from being killed."""
    made = opened()
    made.close()
    assert client.made[0].done[-1] == "close"
    assert cluster.done == ["retire lost", "retire there", "kill there", "close"]


def test_a_broken_client_keeps_the_cluster_from_nothing(
    client: type[Client], cluster: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = opened()
    monkeypatch.setattr(client, "failing", ("unsubscribe",))
    made.close()
    assert cluster.done[-1] == "close"


def test_a_cluster_that_does_not_close_in_order_is_logged(
    client: type[Client], cluster: Cluster, caplog: pytest.LogCaptureFixture
) -> None:
    made = opened()
    cluster.error = TimeoutError("it hangs")
    made.close()
    assert [(each.levelno, each.message) for each in caplog.records] == [
        (logging.WARNING, "the engine did not close in order")
    ]
    assert "it hangs" in caplog.text


def test_an_external_scheduler_is_left_running(client: type[Client], cluster: Cluster) -> None:
    made = opened(scheduler="tcp://elsewhere:8786")
    assert client.made[0].address == "tcp://elsewhere:8786"
    made.close()
    assert cluster.done == []


@pytest.mark.parametrize("answers", [True, False])
def test_a_worker_whose_nanny_does_not_answer_is_asked_to_leave(
    client: type[Client],
    cluster: Cluster,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    answers: bool,
) -> None:
    made = opened()
    if not answers:
        monkeypatch.setattr(client, "failing", ("nanny",))
    asyncio.run(made._kill("tcp://worker"))
    asked = [entry for entry in client.made[0].done if isinstance(entry, tuple) and len(entry) == 3]
    killing = ("kill_worker", (), {"workers": ["tcp://worker"], "nanny": True})
    leaving = ("leave", (), {"workers": ["tcp://worker"], "on_error": "ignore"})
    assert asked == ([killing] if answers else [killing, leaving])
    words = "the nanny of tcp://worker did not answer; its worker is asked to leave"
    assert [(each.levelno, each.message) for each in caplog.records] == [(logging.WARNING, words)] * (not answers)


def test_every_lease_of_a_job_is_a_task_of_its_own(client: type[Client], cluster: Cluster) -> None:
    """As long as a scheduler may remember the run before."""
    made = opened()
    leases = [Lease("a", 1), Lease("a", 2), Lease("b", 1)]
    assert [made.submit(lease, "tcp://worker").key[1:] for lease in leases] == [("a", 1), ("a", 2), ("b", 1)]


def test_a_worker_is_not_given_the_operators_token(client: type[Client], cluster: Cluster) -> None:
    opened(operator_token="the operator's own token").submit(Lease("a", 1), "tcp://worker")
    function, arguments, options = client.made[0].done[-1]
    assert function is tasks.work
    assert arguments[1].operator_token is None
    assert (options["workers"], options["allow_other_workers"], options["pure"]) == (["tcp://worker"], False, False)

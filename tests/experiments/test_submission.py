"""What is accepted is on disk and queued; the same press of a button gives the same experiment, however often."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from app.errors import BusyError, ConflictError, DeletedError, InvalidInputError
from app.experiments.model import Experiment, Sample, Status
from app.experiments.service import Service
from app.experiments.tokens import token_digest
from app.settings import Settings
from tests.experiments.running import OWNER, a_request

PRESS = "a secret of one press"


@pytest.fixture
def idle(make_service: Callable[..., Service]) -> Service:
    """A service whose engine does not run, so that everything waits."""
    return make_service()


@pytest.fixture
def waiting(idle: Service, upload: Path) -> Sample:
    return idle.samples.add(upload, None)


def test_what_is_accepted_is_on_disk_and_queued(idle: Service, waiting: Sample) -> None:
    experiment = idle.submission.submit(a_request(waiting), OWNER)
    assert idle.experiments.get(experiment.id) == experiment
    assert (experiment.status, experiment.transient, experiment.listed) == (Status.QUEUED, False, True)
    assert experiment.owner == token_digest(OWNER)
    assert idle.watching.snapshot(experiment.id).position == 1


def test_the_last_place_of_the_queue_is_given_and_the_next_is_refused(
    idle: Service, waiting: Sample, settings: Settings
) -> None:
    for place in range(1, settings.queue_limit + 1):
        experiment = idle.submission.submit(a_request(waiting, seed=place), OWNER)
        assert idle.watching.snapshot(experiment.id).position == place
    with pytest.raises(BusyError, match=r"^Try again in a minute: too many experiments wait already\.$"):
        idle.submission.submit(a_request(waiting, seed=99), OWNER)
    assert idle.experiments.counts()["queued"] == settings.queue_limit


def test_checking_says_what_would_be_made_and_keeps_nothing(idle: Service, waiting: Sample) -> None:
    plan = idle.submission.check(a_request(waiting, width=50, height=70))
    assert (plan.width, plan.height, plan.frames) == (50, 70, 1)
    assert plan.memory_limit > 0
    assert sum(idle.experiments.counts().values()) == 0
    assert idle.waiting == 0
    with pytest.raises(InvalidInputError, match="Width is a whole number from 1 to 1000000; got 0"):
        idle.submission.check(a_request(waiting, width=0))


def test_the_same_press_gives_the_same_experiment_even_if_the_queue_is_full(
    idle: Service, waiting: Sample, settings: Settings
) -> None:
    first = idle.submission.submit(a_request(waiting), OWNER, PRESS)
    for seed in range(1, settings.queue_limit):
        idle.submission.submit(a_request(waiting, seed=seed), OWNER)
    assert idle.submission.submit(a_request(waiting), OWNER, PRESS) == first
    assert idle.waiting == settings.queue_limit


@pytest.mark.parametrize("other", ["press", "owner", "request"])
def test_another_press_owner_or_request_is_another_experiment(idle: Service, waiting: Sample, other: str) -> None:
    first = idle.submission.submit(a_request(waiting), OWNER, PRESS)
    second = idle.submission.submit(
        a_request(waiting, seed=int(other == "request")),
        "another token" if other == "owner" else OWNER,
        "another press" if other == "press" else PRESS,
    )
    assert second.id != first.id


def test_a_press_whose_experiment_was_deleted_makes_a_new_one(idle: Service, waiting: Sample) -> None:
    idle.submission.submit(a_request(waiting), OWNER)  # keeps the sample
    first = idle.submission.submit(a_request(waiting), OWNER, PRESS)
    idle.experiments.discard(first)
    again = idle.submission.submit(a_request(waiting), OWNER, PRESS)
    assert again.id != first.id
    with pytest.raises(DeletedError, match="This experiment was deleted by its owner"):
        idle.experiments.get(first.id)


def test_of_two_presses_at_once_the_slower_gets_the_fasters_experiment(
    idle: Service, waiting: Sample, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The other one is stored between the look and the insertion; it is not queued twice."""
    faster: list[Experiment] = []
    add = idle._store.add

    def raced(experiment: Experiment, client: str) -> None:
        faster.append(replace(experiment, depth=16))
        add(faster[0], client)
        add(experiment, client)

    monkeypatch.setattr(idle._store, "add", raced)
    assert idle.submission.submit(a_request(waiting), OWNER, PRESS) == faster[0]
    assert idle.waiting == 1  # it is queued by who was faster


def test_an_identifier_that_is_taken_without_a_press_is_an_error(
    idle: Service, waiting: Sample, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.experiments.submission.new_identifier", lambda: "taken")
    idle.submission.submit(a_request(waiting), OWNER)
    with pytest.raises(ConflictError, match="send it again"):
        idle.submission.submit(a_request(waiting), OWNER)
    assert idle.waiting == 1


def test_a_transient_experiment_belongs_to_nobody_who_is_known(idle: Service, waiting: Sample) -> None:
    first, second = (idle.submission.submit_transient(a_request(waiting)) for _ in range(2))
    assert first.transient
    assert second.transient
    assert first.owner != second.owner

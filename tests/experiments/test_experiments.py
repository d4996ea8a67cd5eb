"""Who may do what with an experiment; what is cancelled or deleted is so in the store and in the engine."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from app.errors import DeletedError, ForbiddenError, NotFoundError
from app.experiments.model import Experiment, Sample, Status, deep_job
from app.experiments.service import Service
from app.settings import Settings
from tests.experiments.running import OWNER, a_request, finished

OPERATOR = "the operator's own token"


@pytest.mark.parametrize(
    ("token", "expected"),
    [(OWNER, True), (OPERATOR, True), ("another", False), ("", False), (None, False), (OWNER + " ", False)],
)
def test_an_experiment_belongs_to_its_owner_and_to_the_operator(
    make_service: Callable[..., Service], upload: Path, token: str | None, expected: bool
) -> None:
    service = make_service()
    experiment = service.submission.submit(a_request(service.samples.add(upload, None)), OWNER)
    assert service.experiments.owns(experiment, token) is expected


def test_without_an_operator_nobody_is_one(
    make_service: Callable[..., Service], settings: Settings, upload: Path
) -> None:
    service = make_service(settings.model_copy(update={"operator_token": None}))
    experiment = service.submission.submit(a_request(service.samples.add(upload, None)), OWNER)
    assert service.experiments.owns(experiment, OWNER)
    assert not any(service.experiments.owns(experiment, token) for token in (OPERATOR, "", None, "None"))


@pytest.mark.parametrize("token", ["another", "", None])
def test_what_a_stranger_asks_for_is_refused_and_changes_nothing(
    make_service: Callable[..., Service], upload: Path, token: str | None
) -> None:
    service = make_service()
    experiment = service.submission.submit(a_request(service.samples.add(upload, None)), OWNER)
    with pytest.raises(ForbiddenError, match="Only the owner"):
        service.experiments.cancel_or_delete(experiment.id, token)
    with pytest.raises(ForbiddenError, match="Only the owner"):
        service.experiments.set_listed(experiment.id, False, token)
    assert service.experiments.get(experiment.id) == experiment
    assert service.watching.snapshot(experiment.id).position == 1


def test_deleting_an_experiment_cancels_the_job_of_every_output_at_16_bits(
    service: Service, sample: Sample, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After the record is gone: who waits for one then learns why it does not come."""
    experiment = finished(service, a_request(sample))
    told: list[str] = []
    monkeypatch.setattr(service.watching, "notify", told.append)
    jobs = [deep_job(experiment.id, output.name) for output in experiment.outputs]
    queue: Any = service._queue
    monkeypatch.setattr(service._executor, "wake", lambda: None)
    for job in jobs:
        queue.enqueue(job, "tests")
    service.experiments.cancel_or_delete(experiment.id, OWNER)
    assert queue.states(jobs) == {}
    assert told == jobs
    with pytest.raises(DeletedError, match="This experiment was deleted by its owner"):
        service.experiments.get(experiment.id)


def test_an_experiment_that_waits_is_cancelled_everywhere(
    make_service: Callable[..., Service], upload: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    service = make_service()
    told: list[str] = []
    monkeypatch.setattr(service.watching, "notify", told.append)
    experiment = service.submission.submit(a_request(service.samples.add(upload, None)), OWNER)
    service.experiments.cancel_or_delete(experiment.id, OWNER)
    assert service.experiments.get(experiment.id).status is Status.CANCELLED
    assert service.waiting == 0
    assert told == [experiment.id]


def test_one_that_ends_before_it_is_cancelled_is_left_as_it_ended(
    make_service: Callable[..., Service], upload: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was read as running; the end came in between."""
    service = make_service()
    told: list[str] = []
    monkeypatch.setattr(service.watching, "notify", told.append)
    experiment = service.submission.submit(a_request(service.samples.add(upload, None)), OWNER)
    get = service._store.get

    def raced(experiment_id: str) -> Experiment:
        found = get(experiment_id)
        lease = service._queue.lease("tests", alone=True)
        assert lease is not None
        service._store.fail(lease, "a reason")
        return found

    monkeypatch.setattr(service._store, "get", raced)
    service.experiments.cancel_or_delete(experiment.id, OWNER)
    monkeypatch.undo()
    assert service.experiments.get(experiment.id).error == "a reason"
    assert told == []


def test_discarding_stops_what_runs_and_leaves_nothing(
    make_service: Callable[..., Service], upload: Path, stored: Callable[[], set[str]]
) -> None:
    service = make_service()
    experiment = service.submission.submit_transient(a_request(service.samples.add(upload, None)))
    service.experiments.discard(experiment)
    with pytest.raises(NotFoundError, match="There is no such experiment"):
        service.experiments.get(experiment.id)
    assert service.waiting == 0
    assert stored() == set()

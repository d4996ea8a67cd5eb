"""The records of the API say what the domain's objects hold, field by field."""

from datetime import UTC, datetime
from typing import Any

import pytest

from app.experiments.files.versions import made_version
from app.experiments.model import Experiment, ExperimentInput, Output, Sample, Snapshot, Status
from app.images.crop import Frames, Rectangle
from app.web.api.records import ExperimentRecord, OutputRecord, ProgressRecord, SampleRecord

NOW = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)
VIDEO = Output(
    "texture", "Texture", 40, 30, kind="texture", media_type="video/webm", frames=5, rate=12.5, bytes=7, digest="d"
)


def experiment(**changed: Any) -> Experiment:
    source = ExperimentInput("sand", Rectangle(1, 2, 3, 4), Frames(5, 6))
    parts: dict[str, Any] = {"id": "e", "method": "rpn", "inputs": (source,), "parameters": {"seed": 7}}
    return Experiment(**parts | {"listed": True, "owner": "o", "created_at": NOW} | changed)


def test_a_sample_says_its_media_and_where_it_is() -> None:
    sample = Sample(48, 40, 3, 16, True, 6, 10.0, "video/webm", id="a", digest="0", created_at=NOW, title="Sand")
    assert SampleRecord.of(sample, "http://x").model_dump(mode="json") == {
        "id": "a",
        "width": 48,
        "height": 40,
        "channels": 3,
        "depth": 16,
        "frames": 6,
        "rate": 10.0,
        "media_type": "video/webm",
        "title": "Sand",
        "transparent": True,
        "created_at": "2026-01-02T03:04:05Z",
        "url": "http://x/api/v1/samples/a",
        "image": "http://x/api/v1/samples/a/image",
        "version": made_version("0"),
    }


def test_an_output_says_its_file_but_not_its_digest() -> None:
    assert OutputRecord.of(VIDEO, "http://x/e").model_dump(mode="json") == {
        "name": "texture",
        "title": "Texture",
        "kind": "texture",
        "media_type": "video/webm",
        "width": 40,
        "height": 30,
        "bytes": 7,
        "frames": 5,
        "rate": 12.5,
        "url": "http://x/e/outputs/texture",
    }


@pytest.mark.parametrize(
    ("snapshot", "state"),
    [
        (Snapshot(Status.QUEUED, position=3), ("queued", 0.0, None, 3)),
        (Snapshot(Status.RUNNING, fraction=0.25, stage="spot", elapsed=2.5), ("running", 0.25, "spot", None)),
        (None, ("queued", 0.0, None, None)),
    ],
)
def test_an_unfinished_experiment_is_as_far_as_its_snapshot(snapshot: Snapshot | None, state: tuple[Any, ...]) -> None:
    record = ExperimentRecord.of(experiment(), snapshot, "http://x")
    assert (record.status, record.progress, record.stage, record.position) == state


def test_a_snapshot_that_is_ahead_of_the_record_does_not_finish_it() -> None:
    """What succeeded shows its outputs."""
    record = ExperimentRecord.of(experiment(status=Status.RUNNING), Snapshot(Status.SUCCEEDED, fraction=1.0), "")
    assert (record.status, record.progress, record.outputs) == ("running", 0.0, [])


def test_a_finished_experiment_is_wholly_done_only_where_it_succeeded() -> None:
    progress = {
        status: ExperimentRecord.of(experiment(status=status), None, "").progress
        for status in (Status.SUCCEEDED, Status.FAILED, Status.CANCELLED)
    }
    assert progress == {"succeeded": 1.0, "failed": 0.0, "cancelled": 0.0}


def test_an_experiment_says_its_inputs_and_listed_outputs_and_no_owner() -> None:
    hidden = Output(".preview", "Preview", 1, 1, bytes=1, digest="p")
    made = experiment(status=Status.SUCCEEDED, outputs=(VIDEO, hidden), timings={"spot": 0.12345678})
    record = ExperimentRecord.of(made, None, "http://x").model_dump(mode="json", exclude_unset=True)
    source = {"sample": "sand", "crop": {"x": 1, "y": 2, "width": 3, "height": 4}, "frames": {"first": 5, "count": 6}}
    assert record["inputs"] == [source]
    assert [output["name"] for output in record["outputs"]] == ["texture"]
    assert record["timings"] == {"spot": 0.123457}
    assert (record["diagnostics"], record["environment"], record["started_at"]) == (None, None, None)
    assert record["page"] == "http://x/experiments/e"
    assert not {"owner", "owner_token"} & set(record)


def test_an_event_says_the_state_and_the_seconds_to_a_thousandth() -> None:
    snapshot = Snapshot(Status.RUNNING, fraction=0.25, stage="spot", elapsed=1.23456)
    assert list(ProgressRecord.of(snapshot).model_dump(mode="json").items()) == [
        ("status", "running"),
        ("position", None),
        ("progress", 0.25),
        ("stage", "spot"),
        ("elapsed", 1.235),
    ]

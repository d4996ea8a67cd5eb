"""Conversion between the domain's records and the database's rows; and the archive's cursor."""

import base64
import binascii
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from datetime import UTC, datetime, timedelta
from typing import Any

from app.errors import InvalidInputError
from app.experiments.model import Attempt, Experiment, ExperimentInput, Lease, Output, Sample, Status
from app.images.crop import Frames, Rectangle
from app.store.schema import EPOCH

Row = Any  # rows of SQLAlchemy have their columns as attributes, unknown to a type checker


def row_of_sample(sample: Sample, owner: str | None) -> dict[str, Any]:
    return {**asdict(sample), "owner": owner}


def sample_of(row: Row) -> Sample:
    values = dict(row._mapping)
    values.pop("owner")
    return Sample(**values)


def row_of_experiment(experiment: Experiment) -> dict[str, Any]:
    row = {name: value for name, value in vars(experiment).items() if name not in {"inputs", "outputs"}}
    row["parameters"] = dict(experiment.parameters)
    row["timings"] = dict(experiment.timings)
    row["diagnostics"] = dict(experiment.diagnostics)
    row["environment"] = dict(experiment.environment)
    row["charges"] = attempt_values(row.pop("attempts"))
    return row


def attempt_values(attempts: Sequence[Attempt]) -> list[dict[str, str]]:
    """Attempts as JSON: moments by ISO 8601, in UTC."""
    return [{"at": attempt.at.astimezone(UTC).isoformat(), "cause": attempt.cause} for attempt in attempts]


def attempts_of(values: Sequence[Mapping[str, str]]) -> tuple[Attempt, ...]:
    return tuple(Attempt(datetime.fromisoformat(value["at"]), value["cause"]) for value in values)


def lease_of(row: Row) -> Lease:
    return Lease(row.id, row.fence, attempts_of(row.attempts))


def input_rows(experiment: Experiment) -> list[dict[str, Any]]:
    return [
        {"experiment": experiment.id, "place": place, "sample": item.sample, **asdict(item.crop), **asdict(item.frames)}
        for place, item in enumerate(experiment.inputs)
    ]


def output_row(experiment_id: str, place: int, output: Output) -> dict[str, Any]:
    return {"experiment": experiment_id, "place": place, **asdict(output)}


def experiments_of(rows: Sequence[Row], input_rows: Sequence[Row], output_rows: Sequence[Row]) -> list[Experiment]:
    """Assemble experiments in the order of their rows; inputs and outputs come in order within each experiment."""
    inputs: dict[str, list[ExperimentInput]] = defaultdict(list)
    for row in input_rows:
        crop = Rectangle(row.x, row.y, row.width, row.height)
        frames = Frames(row.first, row._mapping["count"])  # a row is a tuple, which has a method of that name
        inputs[row.experiment].append(ExperimentInput(row.sample, crop, frames))
    outputs: dict[str, list[Output]] = defaultdict(list)
    for row in output_rows:
        values = dict(row._mapping)
        del values["experiment"], values["place"]
        outputs[row.experiment].append(Output(**values))
    return [
        Experiment(
            **{
                **{name: value for name, value in row._mapping.items() if name != "charges"},
                "status": Status(row.status),
                "attempts": attempts_of(row.charges),
                "inputs": tuple(inputs[row.id]),
                "outputs": tuple(outputs[row.id]),
            }
        )
        for row in rows
    ]


def cursor_after(experiment: Experiment) -> str:
    """Encode the place in the archive right after this experiment, as text for an address."""
    moment = (experiment.created_at - EPOCH) // timedelta(microseconds=1)
    return base64.urlsafe_b64encode(f"{moment}.{experiment.id}".encode()).decode().rstrip("=")


def parse_cursor(cursor: str) -> tuple[datetime, str]:
    """Decode moment and id of the last experiment that was seen.

    Raises
    ------
    InvalidInputError
        If it is not one that `cursor_after` made.
    """
    try:
        text = base64.urlsafe_b64decode(cursor + "=" * (-len(cursor) % 4)).decode()
        moment, dot, experiment_id = text.partition(".")
        if not dot or not experiment_id.isprintable():
            raise ValueError(text)
        return EPOCH + timedelta(microseconds=int(moment)), experiment_id
    except (ValueError, OverflowError, binascii.Error):
        raise InvalidInputError(
            "This page of the archive has no such cursor: start from the first page.", "cursor"
        ) from None

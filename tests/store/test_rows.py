"""Rows hold all that records do, and the archive's cursor comes back as it went."""

import base64
from datetime import UTC, datetime, timedelta

import pytest

from app.errors import InvalidInputError
from app.store.rows import cursor_after, parse_cursor, row_of_sample
from tests.store.records import START, a_sample, an_experiment


@pytest.mark.parametrize(
    "moment", [START, datetime(1969, 12, 31, 23, 59, 59, 999_999, UTC), datetime(9999, 12, 31, tzinfo=UTC)]
)
@pytest.mark.parametrize("name", ["plain", "with.dots.", "_-"])
def test_a_cursor_names_the_moment_and_the_experiment(moment: datetime, name: str) -> None:
    cursor = cursor_after(an_experiment(a_sample(), id=name, created_at=moment))
    assert parse_cursor(cursor) == (moment, name)
    assert cursor.replace("-", "").replace("_", "").isalnum()


@pytest.mark.parametrize(
    "text", ["", "no dot", "1", ".x", "one.x", "1.\n", f"{10**40}.x", "é"], ids=lambda text: repr(text)[:12]
)
def test_a_cursor_that_was_not_made_here_is_refused_at_its_field(text: str) -> None:
    cursor = base64.urlsafe_b64encode(text.encode("latin-1")).decode().rstrip("=")
    with pytest.raises(InvalidInputError, match="start from the first page") as refused:
        parse_cursor(cursor)
    assert refused.value.field == "cursor"


def test_a_row_of_a_sample_knows_its_owner_and_its_record_does_not() -> None:
    sample = a_sample(created_at=START + timedelta(days=1))
    assert row_of_sample(sample, "someone") == {**vars(sample), "owner": "someone"}

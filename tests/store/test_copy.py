"""A copied database holds what the first one held; one that holds something already is refused."""

from collections.abc import Callable
from pathlib import Path

import pytest

from app.errors import ConflictError
from app.store.copy import copy_database
from app.store.queue import SqlQueue
from app.store.sql import SqlStore
from tests.store.records import a_sample, an_experiment, succeeded


@pytest.mark.parametrize("back", [False, True])
def test_all_records_are_copied_into_an_empty_database_only(
    store: SqlStore, tmp_path: Path, open_store: Callable[[], SqlStore], back: bool
) -> None:
    other = SqlStore(f"sqlite:///{tmp_path}/other.sqlite3")
    source, target = (store, other) if back else (other, store)
    sample = a_sample()
    source.add_sample(sample, "ann")
    made, waiting = succeeded(source, sample), an_experiment(sample)
    source.add(waiting, "ann")
    copied = copy_database(source, target)
    assert copied == {"samples": 1, "experiments": 2, "inputs": 2, "outputs": 3, "deleted": 0, "jobs": 1}
    assert (target.sample(sample.id), target.get(made.id), target.get(waiting.id)) == (sample, made, waiting)
    assert SqlQueue(target.database).waiting_of("ann") == 1
    with pytest.raises(ConflictError, match="Choose a database that is empty"):
        copy_database(source, target)
    other.close()

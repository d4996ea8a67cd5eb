"""Nothing that was accepted is lost, whatever happens to processes, database, storage, disk and clock.

The short form runs with all tests; ``make chaos`` runs the long one, whose numbers `tests.chaos.faults.LONG` has.
"""

import os
import random
from pathlib import Path

import pytest

from tests.chaos import faults
from tests.chaos.audit import Findings, audit, audit_files
from tests.chaos.faults import LONG, SIZE, Fault
from tests.chaos.host import FAKETIME, Kind, running
from tests.chaos.ledger import Ledger
from tests.chaos.processes import until
from tests.chaos.traffic import readiness, traffic

pytestmark = pytest.mark.chaos

SQLITE, TWO_SQLITE = Kind(), Kind(webs=2)
TWO_POSTGRESQL = Kind("postgresql", webs=2)
EXTERNAL = Kind("postgresql", engine="external", webs=2)
EMBEDDED_KILLS = [faults.one_server, faults.one_worker, faults.all_workers, faults.fork_server, faults.decoder]
EXTERNAL_KILLS = [faults.one_server, faults.one_worker, faults.all_workers, faults.nanny, faults.scheduler]
BACKLOG = 8  # experiments that were accepted before the first fault


Scenarios = dict[str, tuple[Kind, list[Fault]]]
IN_SHORT: Scenarios = {
    "SQLite": (SQLITE, EMBEDDED_KILLS),
    "PostgreSQL": (TWO_POSTGRESQL, [faults.postgresql_stopped, faults.one_server, faults.one_worker]),
    "external engine": (EXTERNAL, [faults.one_worker, faults.nanny, faults.scheduler]),
    "disk full": (SQLITE, [faults.disk_full]),
}
AT_LENGTH: Scenarios = {
    "kills on SQLite": (SQLITE, EMBEDDED_KILLS),
    "kills on PostgreSQL": (TWO_POSTGRESQL, EMBEDDED_KILLS),
    "kills of an external engine": (EXTERNAL, EXTERNAL_KILLS),
    "PostgreSQL stopped": (TWO_POSTGRESQL, [faults.postgresql_stopped]),
    "SQLite locked": (TWO_SQLITE, [faults.sqlite_locked]),
    "disk full": (SQLITE, [faults.disk_full]),
    "disk full beside PostgreSQL": (TWO_POSTGRESQL, [faults.disk_full]),
    "storage away": (SQLITE, [faults.directory_gone]),
    "storage away beside PostgreSQL": (TWO_POSTGRESQL, [faults.directory_gone]),
    "clock set": (SQLITE, [faults.clock_set]),
    "clock set beside PostgreSQL": (TWO_POSTGRESQL, [faults.clock_set]),
    "restarts": (SQLITE, [faults.restarted]),
    "restarts beside PostgreSQL": (TWO_POSTGRESQL, [faults.restarted]),
}
SCENARIOS = AT_LENGTH if SIZE is LONG else IN_SHORT


@pytest.mark.parametrize("name", SCENARIOS)
def test_nothing_that_was_accepted_is_lost(
    name: str, tmp_path: Path, record_figures, request: pytest.FixtureRequest
) -> None:
    kind, what = SCENARIOS[name]
    if faults.clock_set in what and FAKETIME is None:
        pytest.fail("libfaketime is not installed: scripts/test-packages installs it")
    if faults.disk_full in what:
        if os.geteuid() != 0:
            pytest.skip("only root may mount a small file system")
        request.getfixturevalue("small_disk")
    found = suffer(kind, what, tmp_path, record_figures)
    assert {fault: words for fault, words in found.faults.items() if words} == {}


def suffer(kind: Kind, what: list[Fault], directory: Path, record_figures) -> Findings:
    """Run a host under traffic through the faults, one after the other, and audit it."""
    ledger = Ledger()
    with running(kind, directory) as host:
        with readiness(host.addresses, ledger):
            with traffic(host.addresses, ledger, seed=11):
                until(lambda: len(ledger.experiments) >= BACKLOG and ledger.uploads, "work was accepted")
                for fault in what:
                    fault(host, ledger, random.Random(11))
            found = audit(host, ledger)
        host.stop()
        audit_files(host, found)
    record_figures(kind, ledger, found)
    return found

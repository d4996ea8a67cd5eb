"""Audit: whether a service kept what it accepted, and told the truth about itself meanwhile."""

import hashlib
import io
import sqlite3
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import httpx
import numpy as np
from PIL import Image

from tests.chaos.faults import SIZE
from tests.chaos.host import Host
from tests.chaos.ledger import Ledger
from tests.chaos.runs import double_runs
from tests.chaos.traffic import SIDE

NOTICE_SECONDS = 8.0  # until a part that is away must be told: a lock is waited for five seconds
JPEG_LEVELS = 12.0  # mean difference that a JPEG may make; of two uploads it is above 50
UNFINISHED = {"queued", "running"}


@dataclass
class Findings:
    """What an audit counted, and in ``faults`` what should not be: kind → what was found."""

    counts: Counter[str] = field(default_factory=Counter)
    faults: dict[str, list[str]] = field(default_factory=lambda: defaultdict(list))


def audit(host: Host, ledger: Ledger) -> Findings:
    """Wait until nothing is under way, then look at everything that was accepted; the host must still run."""
    found = Findings()
    with httpx.Client(base_url=host.addresses[0], timeout=30) as client:
        records = _finish(client, ledger, found)
        _audit_outputs(client, ledger, records, found)
        for sample, pixels in ledger.uploads.items():
            _audit_upload(client, sample, pixels, found)
    found.counts["experiments"], found.counts["uploads"] = len(ledger.experiments), len(ledger.uploads)
    found.counts["refused"] = ledger.answers["503"]
    found.faults["wrong answers"] += ledger.wrong
    found.faults["ran twice"] += double_runs(host.lines(), found.counts)
    _audit_readiness(host, ledger, found)
    return found


def audit_files(host: Host, found: Findings) -> None:
    """Look at the database and at what is left on disk; the host must have ended."""
    if host.kind.database == "sqlite":
        connection = sqlite3.connect(host.data / "microtexture.sqlite3")
        (words,) = connection.execute("PRAGMA integrity_check").fetchone()
        connection.close()
        if words != "ok":
            found.faults["database"].append(words)
    found.faults["left in incoming"] += [path.name for path in (host.data / "incoming").glob("*")]
    for path in (host.data / "files").glob("[0-9a-f][0-9a-f]/*"):
        if hashlib.sha256(path.read_bytes()).hexdigest() != path.name:
            found.faults["altered files"].append(path.name)


def _finish(client: httpx.Client, ledger: Ledger, found: Findings) -> dict[str, dict[str, Any]]:
    """Wait for every experiment; what does not move for long is stuck."""
    records: dict[str, dict[str, Any]] = {}
    moved = max(ledger.healed, time.monotonic())
    while left := [experiment for experiment in ledger.experiments if experiment not in records]:
        for experiment in left:
            try:
                answer = client.get(f"/api/v1/experiments/{experiment}")
            except httpx.HTTPError:
                continue
            if answer.status_code == 404:
                found.faults["experiments lost"].append(experiment)
                records[experiment] = {"status": "lost", "outputs": []}
            elif answer.status_code == 200 and answer.json()["status"] not in UNFINISHED:
                records[experiment], moved = answer.json(), time.monotonic()
        if time.monotonic() - moved > SIZE.recovery_seconds:
            found.faults["stuck"] += left
            break
        time.sleep(0.2)
    for experiment, record in records.items():
        if record["status"] != "succeeded":
            found.faults["failed"].append(f"{experiment}: {record['status']}, {record.get('error')}")
        found.counts["charged attempts"] += len(record["attempts"]) if isinstance(record.get("attempts"), list) else 0
    return records


def _audit_outputs(client: httpx.Client, ledger: Ledger, records: dict[str, dict[str, Any]], found: Findings) -> None:
    """Read every output: its bytes have the digest that its ETag names, and what was asked twice is the same."""
    same: dict[str, set[str]] = defaultdict(set)
    for experiment, record in records.items():
        for output in record["outputs"]:
            answer = client.get(output["url"])
            digest = hashlib.sha256(answer.content).hexdigest()
            found.counts["outputs"] += 1
            if answer.status_code != 200 or digest not in answer.headers.get("ETag", ""):
                found.faults["bad digests"].append(output["url"])
            if output["name"] == "texture":
                same[ledger.experiments[experiment]].add(digest)
    found.counts["asked again"] = len(records) - len(same)
    found.faults["other bytes"] += [asked for asked, digests in same.items() if len(digests) > 1]


def _audit_upload(client: httpx.Client, sample: str, pixels: bytes, found: Findings) -> None:
    answer = client.get(f"/api/v1/samples/{sample}/image")
    if answer.status_code != 200:
        found.faults["uploads lost"].append(f"{sample}: {answer.status_code} {answer.text[:200]}")
        return
    seen = np.asarray(Image.open(io.BytesIO(answer.content)).convert("RGB"), dtype=np.float64)
    sent = np.frombuffer(pixels, dtype=np.uint8).reshape(SIDE, SIDE, 3)
    if seen.shape != sent.shape or float(np.abs(seen - sent).mean()) > JPEG_LEVELS:
        found.faults["uploads lost"].append(f"{sample}: other pixels")


def _audit_readiness(host: Host, ledger: Ledger, found: Findings) -> None:
    """Compare what `/readyz` said with what was so: never ready without a part, and ready again soon."""
    for outage in ledger.outages:
        for answer in ledger.readiness:
            # One that was asked before the end may be answered after it.
            if outage.began + NOTICE_SECONDS < answer.at < outage.ended - 1 and answer.status == 200:
                found.faults["ready without " + outage.part].append(f"{answer.at - outage.began:.1f} s after its start")
    for web in range(len(host.addresses)):
        last = [answer for answer in ledger.readiness if answer.web == web][-1]
        if last.status != 200:
            found.faults["not ready"].append(f"web {web}: {last.status} {last.words}")
    if any(answer.status is not None and answer.status not in {200, 503} for answer in ledger.readiness):
        found.faults["readiness"].append("answers that are neither 200 nor 503")
    found.counts["slowest ready again, s"] = round(max(_gaps(ledger), default=0.0))
    found.counts["looks at /readyz"] = len(ledger.readiness)


def _gaps(ledger: Ledger) -> Iterator[float]:
    """Seconds that each web process was not ready at a stretch; of an outage, those after its end only."""
    began: dict[int, float] = {}
    for answer in ledger.readiness:
        if answer.status != 200:
            began.setdefault(answer.web, answer.at)
        elif answer.web in began:
            start = began.pop(answer.web)
            ends = [outage.ended for outage in ledger.outages if outage.began - 1 <= start <= outage.ended]
            yield max(0.0, answer.at - max([start, *ends]))

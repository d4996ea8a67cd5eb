"""Traffic on a service: clients that upload and submit experiments, and one that asks whether it is ready."""

import hashlib
import io
import json
import random
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import httpx
import numpy as np
from PIL import Image

from tests.chaos.ledger import Answer, Ledger

SIDE = 96  # of an upload, in pixels
OUTPUT = 768  # of a texture
SEEDS = 12  # few, so that the same texture is asked for again and again
CLIENTS = 2
PAUSE_SECONDS = 0.4  # between two requests of a client: more would only fill the queue
LOOK_SECONDS = 0.25
PATIENCE_SECONDS = 20.0  # the service waits five for a lock


def an_upload(number: int) -> tuple[bytes, bytes]:
    """Make a small PNG, and its pixels: smooth ones, which a JPEG of them keeps nearly."""
    coarse = np.random.default_rng(number).integers(0, 256, (8, 8, 3), dtype=np.uint8)
    picture = Image.fromarray(coarse).resize((SIDE, SIDE), Image.Resampling.BICUBIC)
    file = io.BytesIO()
    picture.save(file, "PNG")
    return file.getvalue(), picture.tobytes()


@contextmanager
def traffic(webs: list[str], ledger: Ledger, seed: int) -> Iterator[None]:
    """Send requests to all web processes meanwhile."""
    stop = threading.Event()
    clients = [threading.Thread(target=_client, args=(webs, ledger, stop, seed + i)) for i in range(CLIENTS)]
    for client in clients:
        client.start()
    try:
        yield
    finally:
        stop.set()
        for client in clients:
            client.join()


@contextmanager
def readiness(webs: list[str], ledger: Ledger) -> Iterator[None]:
    """Ask every web process all the time whether it is ready."""
    stop = threading.Event()
    watchers = [threading.Thread(target=_watch, args=(i, web, ledger, stop)) for i, web in enumerate(webs)]
    for watcher in watchers:
        watcher.start()
    try:
        yield
    finally:
        stop.set()
        for watcher in watchers:
            watcher.join()


def _client(webs: list[str], ledger: Ledger, stop: threading.Event, seed: int) -> None:
    chance = random.Random(seed)
    samples: list[str] = []
    with httpx.Client(timeout=PATIENCE_SECONDS, headers={"Authorization": f"Bearer chaos-{seed:016}"}) as client:
        while not stop.wait(PAUSE_SECONDS * chance.uniform(0.5, 1.5)):
            web = chance.choice(webs)
            if not samples or chance.random() < 0.25:
                _upload(client, web, ledger, samples, chance.randrange(1 << 30))
            else:
                _submit(client, web, ledger, samples[-1 - chance.randrange(min(3, len(samples)))], chance)


def _upload(client: httpx.Client, web: str, ledger: Ledger, samples: list[str], number: int) -> None:
    content, pixels = an_upload(number)
    record = _send(client, f"{web}/api/v1/samples", ledger, 201, files={"file": (f"{number}.png", content)})
    if record is not None:
        with ledger.lock:
            ledger.uploads[record["id"]] = pixels
        samples.append(record["id"])


def _submit(client: httpx.Client, web: str, ledger: Ledger, sample: str, chance: random.Random) -> None:
    parameters = {"width": OUTPUT, "height": OUTPUT, "seed": chance.randrange(SEEDS)}
    body = {"method": "rpn", "inputs": [{"sample": sample}], "parameters": parameters}
    record = _send(client, f"{web}/api/v1/experiments", ledger, 202, json=body)
    if record is not None:
        asked = hashlib.sha256(json.dumps(body, sort_keys=True).encode()).hexdigest()
        with ledger.lock:
            ledger.experiments[record["id"]] = asked


def _send(client: httpx.Client, address: str, ledger: Ledger, accepted: int, **body: Any) -> dict[str, Any] | None:
    """Send one request; its record if it was accepted."""
    try:
        answer = client.post(address, **body)
    except httpx.HTTPError:
        with ledger.lock:
            ledger.answers["none"] += 1  # the process was killed, or is not back yet
        return None
    with ledger.lock:
        ledger.answers[f"{answer.status_code}"] += 1
        if answer.status_code == 503 and "Retry-After" not in answer.headers:
            ledger.wrong.append(f"503 without Retry-After: {answer.text[:200]}")
        elif answer.status_code not in {accepted, 503}:
            ledger.wrong.append(f"{answer.status_code} from {httpx.URL(address).path}: {answer.text[:200]}")
    return dict(answer.json()) if answer.status_code == accepted else None


def _watch(number: int, web: str, ledger: Ledger, stop: threading.Event) -> None:
    with httpx.Client(timeout=10) as client:
        while not stop.wait(LOOK_SECONDS):
            asked = time.monotonic()
            try:
                answer = client.get(f"{web}/readyz")
                found = Answer(number, asked, answer.status_code, answer.text[:200])
            except httpx.HTTPError as error:
                found = Answer(number, asked, None, repr(error))
            with ledger.lock:
                ledger.readiness.append(found)

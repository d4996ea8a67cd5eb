"""A service under sustained load: it stays up, answers in words, finishes what it accepted and does not grow."""

import threading
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx
import pytest

from benchmarks.served import Served, served

pytestmark = pytest.mark.load

SAMPLE = "scene_china"
CLIENTS, EACH = 12, 25
QUEUE = 8  # short, so that the load meets its end
GROWTH = 150 << 20  # bytes; far more than caches and pools take, far less than a picture kept per experiment would
MARGIN_SECONDS = 300.0


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("load"), workers=2, threads=1, queue_limit=QUEUE) as found:
        found.wait_for_sample(SAMPLE)
        yield found


def body(seed: int) -> dict[str, Any]:
    crop = {"x": 0, "y": 0, "width": 64, "height": 64}
    return {"method": "rpn", "inputs": [{"sample": SAMPLE, "crop": crop}], "parameters": {"seed": seed}}


def test_a_full_queue_is_said_and_everything_accepted_succeeds(service: Served) -> None:
    answers: Counter[int] = Counter()
    accepted: list[str] = []
    lock = threading.Lock()
    service.finish(body(0))
    before = service.process.memory_info().rss

    def client(number: int) -> None:
        with httpx.Client(base_url=service.client.base_url, timeout=120) as own:
            for attempt in range(EACH):
                answer = own.post("/api/v1/experiments", json=body(1 + number * EACH + attempt))
                reading = own.get("/archive" if attempt % 2 else "/api/v1/experiments?limit=10")
                with lock:
                    answers[answer.status_code] += 1
                    answers[reading.status_code] += 1
                if answer.status_code == 503:
                    assert int(answer.headers["Retry-After"]) >= 1
                    assert answer.json()["detail"]
                else:
                    accepted.append(answer.json()["url"])

    with ThreadPoolExecutor(CLIENTS) as clients:
        list(clients.map(client, range(CLIENTS)))

    assert set(answers) <= {200, 202, 503}, answers
    assert answers[503] > 0, "the load did not reach the queue's end: it says nothing"
    deadline = time.monotonic() + MARGIN_SECONDS
    for url in accepted:
        while (record := service.client.get(url).json())["status"] in {"queued", "running"}:
            assert time.monotonic() < deadline, "the queue does not empty"
            time.sleep(0.05)
        assert record["status"] == "succeeded", record["error"]
    assert service.client.get("/readyz").status_code == 200
    assert service.process.memory_info().rss - before < GROWTH


def test_uploads_at_the_same_time_all_get_an_answer(service: Served) -> None:
    photo = (Path(__file__).parents[2] / "samples" / "scene_china.jpg").read_bytes()

    def upload(number: int) -> int:
        content = photo if number % 2 else photo[: 1000 + number]  # every other one is broken
        return service.client.post("/api/v1/samples", files={"file": ("photo.jpg", content)}).status_code

    with ThreadPoolExecutor(8) as clients:
        answers = list(clients.map(upload, range(40)))
    assert answers == [201 if number % 2 else 422 for number in range(40)]

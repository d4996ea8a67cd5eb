"""Pages beside watchers: ``python -m benchmarks.watchers``.

How long ``/archive`` takes while hundreds follow a running experiment by server-sent events, beside the same with
nobody following it, in turn on one service.
"""

import asyncio
import multiprocessing
import statistics
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.sharedctypes import Synchronized
from multiprocessing.synchronize import Event
from pathlib import Path

import psutil

from benchmarks.served import Served, served
from benchmarks.timing import seconds

WATCHERS = 400
ROUNDS = 3
REQUESTS = 40
PAUSE = 0.1  # seconds between requests
SAMPLE = "gravel_gray"
SMALL = {"x": 0, "y": 0, "width": 96, "height": 96}
LONG = {"width": 800, "height": 800}  # runs longer than a round
SETTINGS = {"workers": 1, "threads": 1, "time_limit": 3600}


def watch(host: str, port: int, path: str, opened: Event, done: Event, rate: "Synchronized[float]") -> None:
    """Follow an experiment on many connections, and read all that comes; a process of its own does this."""

    async def follow(number: int) -> None:
        reader, writer = await asyncio.open_connection(host, port)
        writer.write(f"GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
        while not done.is_set():
            try:
                async with asyncio.timeout(0.5):
                    counts[number] += (await reader.read(1 << 16)).count(b"event: progress")
            except TimeoutError:
                continue
        writer.close()

    async def all_of_them() -> None:
        tasks = [asyncio.create_task(follow(number)) for number in range(WATCHERS)]
        while not all(counts):
            await asyncio.sleep(0.05)
        before, began = sum(counts), time.monotonic()
        opened.set()
        await asyncio.gather(*tasks)
        rate.value = (sum(counts) - before) / (time.monotonic() - began)

    counts = [0] * WATCHERS
    asyncio.run(all_of_them())


@contextmanager
def watched(service: Served, path: str, rates: list[float]) -> Iterator[None]:
    """Have the events of a path followed within the block; note how many came a second."""
    context = multiprocessing.get_context("spawn")
    opened, done, rate = context.Event(), context.Event(), context.Value("d", 0.0)
    url = service.client.base_url
    process = context.Process(target=watch, args=(url.host, url.port, path, opened, done, rate))
    process.start()
    opened.wait()
    try:
        yield
    finally:
        done.set()
        process.join()
        rates.append(rate.value)


def archive(service: Served) -> tuple[list[float], float]:
    """Milliseconds of requests one after the other, and the share of a core that the web process took meanwhile."""
    times = []
    before, began = _cpu(service.process), time.perf_counter()
    for _ in range(REQUESTS):
        times.append(1e3 * seconds(lambda: service.client.get("/archive").raise_for_status()))
        time.sleep(PAUSE)
    return times, (_cpu(service.process) - before) / (time.perf_counter() - began)


def _cpu(process: psutil.Process) -> float:
    used = process.cpu_times()
    return float(used.user + used.system)


def show(name: str, rounds: list[tuple[list[float], float]]) -> None:
    times = sorted(one for each, _ in rounds for one in each)
    share = statistics.median(part for _, part in rounds)
    last = times[int(0.95 * len(times))]
    print(
        f"| {name} | {statistics.median(times):.0f} | {last:.0f} | {times[-1]:.0f} | {100 * share:.0f} % |", flush=True
    )


def main() -> None:
    """Print the table."""
    crop = {"x": 0, "y": 0, "width": 256, "height": 256}
    with (
        tempfile.TemporaryDirectory(prefix="microtexture-bench-") as directory,
        served(Path(directory), **SETTINGS) as service,
    ):
        service.wait_for_sample(SAMPLE)
        for seed in range(24):
            service.finish(
                {
                    "method": "rpn",
                    "inputs": [{"sample": SAMPLE, "crop": crop}],
                    "parameters": {"seed": seed},
                    "listed": True,
                }
            )
        archive(service)
        alone, beside, rates = [], [], list[float]()
        for seed in range(ROUNDS):
            body = {"method": "efros-leung", "inputs": [{"sample": SAMPLE, "crop": SMALL}]}
            answer = service.client.post("/api/v1/experiments", json={**body, "parameters": {"seed": seed, **LONG}})
            record = f"/api/v1/experiments/{answer.raise_for_status().json()['id']}"
            alone.append(archive(service))
            with watched(service, f"{record}/events", rates):
                beside.append(archive(service))
            if service.client.get(record).json()["status"] != "running":
                raise RuntimeError("The run that was followed ended too soon.")
            service.client.delete(record).raise_for_status()
        print("`/archive` with 24 experiments, ms")
        print("| followed by | median | 95 % | slowest | web process, of a core |\n|---|---|---|---|---|")
        show("nobody", alone)
        show(f"{WATCHERS}, {statistics.median(rates):.0f} events a second", beside)


if __name__ == "__main__":
    main()

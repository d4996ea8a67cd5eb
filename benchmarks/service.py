"""Overhead of the service over the methods: ``python -m benchmarks.service``.

A service is started on the loopback with the settings of the environment, and driven over REST.
"""

import multiprocessing
import statistics
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

import psutil

from app.images.crop import Rectangle
from app.images.read import read_crop
from app.methods.context import Context
from app.methods.model import Source
from app.methods.registry import method
from app.settings import Settings
from benchmarks.served import Served, served
from benchmarks.timing import seconds

SAMPLE = "rock_mountain"
CROP = Rectangle(0, 0, 512, 512)
SINGLE_RUNS = 20
MANY = 60
CLIENTS = 4
MEGABYTE = 1_000_000


def body(seed: int, **parameters: object) -> dict[str, Any]:
    """Write an experiment of 512² as it is sent."""
    return {
        "method": "rpn",
        "inputs": [{"sample": SAMPLE, "crop": vars(CROP)}],
        "parameters": {"seed": seed, **parameters},
        "listed": True,
    }


def directly(photo: Path, seed: int, threads: int) -> int:
    """Compute what a worker does for an experiment: the crop and every picture; return the bytes made."""
    rpn = method("rpn")
    source = Source(read_crop(photo, CROP), 255)
    context = Context(8, threads, lambda stage, fraction: None)
    pictures = rpn.pictures([source], rpn.params(seed=seed), context)
    return sum(len(picture.data) for picture in pictures if isinstance(picture.data, bytes))


def kernel(photo: Path, seed: int, threads: int) -> None:
    """Compute the texture alone, crop in memory, to its PNG."""
    rpn = method("rpn")
    source = Source(read_crop(photo, CROP), 255)
    next(rpn.pictures([source], rpn.params(seed=seed), Context(8, threads, lambda stage, fraction: None)))


def line(name: str, value: float, unit: str, aim: float | None = None, *, least: bool = False, note: str = "") -> None:
    """Print one line of the table."""
    sign = "≥" if least else "≤"
    aim_text = "–" if aim is None else f"{sign} {aim:g}"
    met = aim is not None and (value >= aim if least else value <= aim)
    verdict = "" if aim is None else "ok" if met else "MISSED"
    print(f"{name:52} {value:8.2f} {unit:4} {aim_text:8} {verdict:7} {note}", flush=True)


def overhead(service: Served, photo: Path, threads: int) -> None:
    """One experiment at a time: what is not the kernel, and where it goes."""
    totals, faults, kernels, directs, stages = [], [], [], [], list[dict[str, float]]()
    for seed in range(SINGLE_RUNS):
        before = _page_faults(service)
        start = time.perf_counter()
        record = service.finish(body(seed))
        totals.append(time.perf_counter() - start)
        faults.append(_page_faults(service) - before)
        stages.append(record["timings"])
        kernels.append(seconds(lambda seed=seed: kernel(photo, seed, threads)))  # type: ignore[misc]
        directs.append(seconds(lambda seed=seed: directly(photo, seed, threads)))  # type: ignore[misc]
    total, texture, work = (1e3 * statistics.median(times) for times in (totals, kernels, directs))
    line("one experiment of 512², request to finished record", total, "ms")
    line("  its kernel, called directly: the texture as PNG", texture, "ms")
    line("  minus the kernel", total - texture, "ms", 80)
    line("  its page faults, in the workers", statistics.median(faults), "", 1000)
    line("  of which the steps and spectra", work - texture, "ms", note="the same calls made directly")
    computed = 1e3 * statistics.median(sum(each.values()) for each in stages)
    line("  of which web, database, engine, files", total - work, "ms", note=f"{computed:.0f} ms pass in the worker")
    for stage in stages[0]:
        line(f"    stage “{stage}”", 1e3 * statistics.median(each[stage] for each in stages), "ms")


def throughput(service: Served, photo: Path, settings: Settings) -> None:
    """Many experiments at once against the same work called directly on as many processes."""
    service_rates, direct_rates = [], []
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(settings.workers, mp_context=context) as processes, ThreadPoolExecutor(CLIENTS) as clients:
        list(
            processes.map(
                directly, [photo] * settings.workers, range(settings.workers), [settings.threads] * settings.workers
            )
        )

        def direct() -> None:
            list(processes.map(directly, [photo] * MANY, range(MANY), [settings.threads] * MANY))

        def over_rest() -> None:
            list(clients.map(lambda seed: service.finish(body(seed)), range(1000, 1000 + MANY)))

        for _ in range(3):
            direct_rates.append(MANY / seconds(direct))
            service_rates.append(MANY / seconds(over_rest))
    ratio = statistics.median(a / b for a, b in zip(service_rates, direct_rates, strict=True))
    note = f"{statistics.median(service_rates):.1f} against {statistics.median(direct_rates):.1f} a second"
    processes_note = f"{settings.workers} processes of {settings.threads} threads, {CLIENTS} clients"
    line("throughput of 512² experiments ÷ directly", ratio, "", 0.7, least=True, note=f"{note}; {processes_note}")


def pages(service: Served) -> None:
    """How long the pages take, over a kept connection."""
    experiment = service.finish(body(7))["id"]
    for path in ("/", f"/samples/{SAMPLE}", f"/experiments/{experiment}", "/archive"):
        get: Callable[[], object] = lambda path=path: service.client.get(path).raise_for_status()  # type: ignore[misc] # noqa: E731
        get()
        times = [1e3 * seconds(get) for _ in range(30)]
        shown = path.replace(experiment, "{id}")
        line(f"page {shown}", statistics.median(times), "ms", 30, note=f"slowest of 30: {max(times):.0f} ms")


def memory(service: Served) -> None:
    """What idle processes take, and how much more the worker does at the peak of a run of 4096² than before it."""
    for seed in range(8):
        service.finish(body(50 + seed))  # every worker has loaded what it loads once
    family = [service.process, *service.process.children(recursive=True)]
    line("idle service after runs of 512², its share of memory", sum(map(_share, family)) / MEGABYTE, "MB")
    idle = {}
    for process in family:
        Path(f"/proc/{process.pid}/clear_refs").write_text("5", encoding="ascii")  # resets the peak
        idle[process.pid] = process.memory_info().rss
    took = time.perf_counter()
    service.finish(body(7, width=4096, height=4096))
    took = time.perf_counter() - took
    above = {process: _peak(process) - idle[process.pid] for process in family if process.is_running()}
    hungriest = max(above, key=lambda process: above[process])
    note = f"the worker's idle {idle[hungriest.pid] / MEGABYTE:.0f} MB; {took:.1f} s"
    line("peak memory of 512² → 4096² RGB above idle", above[hungriest] / MEGABYTE, "MB", 300, note=note)
    line("idle service after it, its share of memory", sum(map(_share, family)) / MEGABYTE, "MB")


def _page_faults(service: Served) -> int:
    """Pages that the system had to put in place, without a disk, for the processes below the service's own."""
    total = 0
    for process in service.process.children(recursive=True):
        with suppress(FileNotFoundError):  # it has ended meanwhile
            after_name = Path(f"/proc/{process.pid}/stat").read_text(encoding="ascii").rpartition(")")[2]
            total += int(after_name.split()[7])
    return total


def _share(process: psutil.Process) -> int:
    """Bytes that a process holds, pages shared with others divided by their number (PSS); 0 once it has ended."""
    try:
        return int(process.memory_full_info().pss)
    except psutil.NoSuchProcess:
        return 0


def _peak(process: psutil.Process) -> int:
    status = Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
    return 1024 * int(next(row for row in status.splitlines() if row.startswith("VmHWM")).split()[1])


def main() -> None:
    """Print the table."""
    settings = Settings()
    print(f"service with {settings.workers} workers of {settings.threads} threads, SQLite, RGB, 8 bits; median; aim")
    with tempfile.TemporaryDirectory(prefix="microtexture-bench-") as temporary:
        directory = Path(temporary)
        starts = []
        for _ in range(2):
            with served(directory) as service:
                service.wait_for_sample(SAMPLE)
                starts.append(service.seconds_to_ready)
        line("cold start to /readyz, empty data directory", starts[0], "s", 5)
        line("cold start to /readyz, again", starts[1], "s", 5)
        with served(directory) as service:
            photo = directory / "sample.png"
            photo.write_bytes(service.client.get(f"/api/v1/samples/{SAMPLE}/image").raise_for_status().content)
            for seed in range(2 * settings.workers):
                service.finish(body(100 + seed))
            overhead(service, photo, settings.threads)
            throughput(service, photo, settings)
            pages(service)
            memory(service)


if __name__ == "__main__":
    main()

"""Conversions of large pictures at once: memory of the process that has them made, before, at its peak and after.

``python -m benchmarks.conversions [PARALLEL] [SIDE]``
"""

import sys
import tempfile
import threading
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import psutil

from app import threads
from app.errors import BusyError
from app.images.intake.making import make
from app.images.png_writer import PngWriter

ROWS = 64


def main(parallel: int = 20, side: int = 8192) -> None:
    """Print the memory in megabytes, and how the requests were answered."""
    memory, peak, done = psutil.Process().memory_info, 0, threading.Event()

    def watch() -> None:
        nonlocal peak
        while not done.wait(0.01):
            peak = max(peak, memory().rss)

    with tempfile.TemporaryDirectory() as directory:
        source = Path(directory, "source.png")
        writer, chance = PngWriter(side, side, 3, 8), np.random.default_rng(1)
        for y in range(0, side, ROWS):
            writer.write(y, chance.integers(0, 256, (min(ROWS, side - y), side, 3), np.uint8))
        source.write_bytes(writer.finish())
        del writer
        before = memory().rss
        watching = threading.Thread(target=watch)
        watching.start()

        def ask(number: int) -> int:
            target = Path(directory, str(number))
            try:
                make("convert", [source], [target], file_format=("tiff", "jpeg")[number % 2], depth=None)
            except BusyError:
                return 503
            return 200

        with ThreadPoolExecutor(threads.AT_ONCE[threads.PICTURES]) as pool:
            answers = Counter(pool.map(ask, range(parallel)))
        done.set()
        watching.join()
    figures = (before, peak, memory().rss)
    print(f"{parallel} of {side}²:", *(f"{value >> 20} MB" for value in figures), dict(answers))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))

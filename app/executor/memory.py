"""Memory allocator of worker processes: the variables they are started with, and what they give back."""

import ctypes
import os
from pathlib import Path

MEBIBYTE = 1 << 20
KEPT = 192 * MEBIBYTE  # resident bytes with which a worker may idle

# Dask's own trim threshold of 64 KiB has every array paged in anew. Blocks of up to 32 MiB, the most that every glibc
# takes for a threshold, come from the heap and go back to it. One heap for all threads: their arrays are large, so
# they seldom meet there, and `malloc_trim` leaves the top of every other heap as it is.
MALLOC = {
    "MALLOC_ARENA_MAX": 1,
    "MALLOC_MMAP_THRESHOLD_": 32 * MEBIBYTE,
    "MALLOC_TRIM_THRESHOLD_": 256 * MEBIBYTE,
}


def give_back() -> None:
    """Return free memory to the system if this process holds much. Only glibc has to be asked, and knows how."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None and _resident() > KEPT:
        trim(0)


def _resident() -> int:
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")

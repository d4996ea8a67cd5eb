"""Environment of a run: versions and processor, on which its bytes may depend."""

from functools import cache
from importlib.metadata import version
from pathlib import Path
from platform import machine

import numpy as np

from app.synthesis import __version__

CPU = "model name"  # as /proc/cpuinfo has it on x86; elsewhere the architecture has to do


@cache
def environment() -> dict[str, str]:
    """Describe this process: ``version`` (of Microtexture), ``cpu`` with numpy's kernels for it, ``numpy``, ``scipy``.

    Examples
    --------
    >>> list(environment())
    ['version', 'cpu', 'numpy', 'scipy']
    """
    rows = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    name = next((row.partition(":")[2].strip() for row in rows if row.startswith(CPU)), machine())
    kernels = np.show_config(mode="dicts")["SIMD Extensions"]
    best = [*kernels["baseline"], *kernels.get("found", [])][-1]
    return {"version": __version__, "cpu": f"{name} ({best})", "numpy": np.__version__, "scipy": version("scipy")}

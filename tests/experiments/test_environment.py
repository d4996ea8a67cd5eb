"""What a record says of the process that computed it."""

import os
import subprocess
import sys

import numpy as np
import scipy

from app.experiments.environment import environment
from app.synthesis import __version__


def test_versions_are_those_of_this_process() -> None:
    found = environment()
    assert (found["version"], found["numpy"], found["scipy"]) == (__version__, np.__version__, scipy.__version__)


def test_the_processor_is_told_with_the_kernels_that_numpy_takes_for_it() -> None:
    """Switched off, they are not told: it is what the bytes hang on."""
    kernels = np.show_config(mode="dicts")["SIMD Extensions"]
    least, found = kernels["baseline"][-1], kernels.get("found", [])
    program = "from app.experiments.environment import environment; print(environment()['cpu'])"
    switched_off = {**os.environ, "NPY_DISABLE_CPU_FEATURES": " ".join(found)}
    plain = subprocess.run(
        [sys.executable, "-c", program], env=switched_off, check=True, capture_output=True, text=True
    ).stdout.strip()
    name = environment()["cpu"].removesuffix(f" ({[least, *found][-1]})")
    assert plain == f"{name} ({least})"

"""The same seed gives the same bytes, whichever kernels numpy, BLAS, the C library and the codecs have for a processor.

Every method of the registry runs in processes that are kept from some of what this processor can do. Where it cannot
do so anyway, the switch changes nothing and the test says so in its output.
"""

import json
import os
import subprocess
import sys
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import imagecodecs
import numpy as np
import pytest
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

from app.methods.registry import METHODS
from app.settings import ROOT
from tests.methods.bits import PLAIN_CODECS

pytestmark = pytest.mark.slow

THERE = [name for name in __cpu_dispatch__ if __cpu_features__[name]]
WIDE = [name for name in THERE if name == "X86_V4" or name.startswith("AVX512")]
BLAS = {"X86_V2": "Nehalem", "X86_V3": "Haswell", "X86_V4": "SkylakeX"}  # kernels by what they need
SWITCHES = {
    "numpy without AVX-512": {"NPY_DISABLE_CPU_FEATURES": " ".join(WIDE)},
    **{f"BLAS for {core}": {"OPENBLAS_CORETYPE": core} for need, core in BLAS.items() if __cpu_features__.get(need)},
    "C library without FMA": {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F,-AVX2,-FMA,-FMA4"},
    "plain codecs": {PLAIN_CODECS: "1", "VPX_SIMD_CAPS": "0"},
}
NARROW = "numpy without AVX2"
# Of the range: one value in 65535 of a still, one in 255 of a film; Heeger–Bergen goes on from its own rounding.
ALLOWED = {"heeger-bergen": 3 / 255}


@dataclass(frozen=True)
class Outputs:
    """What `bits.py` left: its files by name, and numpy's kernels that it ran with."""

    files: dict[str, Path] = field(repr=False)
    features: list[str]

    def of(self, method: str) -> dict[str, Path]:
        return {name: path for name, path in self.files.items() if name.split()[0] == method}


@pytest.fixture(scope="module")
def outputs(tmp_path_factory):
    """Outputs of a process with these variables; made once."""

    @lru_cache
    def made(*variables: tuple[str, str]) -> Outputs:
        directory = tmp_path_factory.mktemp("bits")
        ours = {"OPENBLAS_CORETYPE", "NPY_DISABLE_CPU_FEATURES", "GLIBC_TUNABLES", "VPX_SIMD_CAPS"}
        environment = {name: value for name, value in os.environ.items() if name not in ours} | dict(variables)
        command = [sys.executable, "-m", "tests.methods.bits", str(directory)]
        done = subprocess.run(command, env=environment, capture_output=True, check=False, text=True, cwd=ROOT)
        assert done.returncode == 0, done.stderr
        return Outputs({path.name: path for path in directory.iterdir()}, json.loads(done.stdout))

    return made


@pytest.mark.parametrize("switch", SWITCHES)
@pytest.mark.parametrize("method", METHODS)
def test_the_bytes_do_not_depend_on_the_kernels_for_a_processor(outputs, method, switch):
    here, there = outputs(), outputs(*SWITCHES[switch].items())
    print(f"{switch}: {SWITCHES[switch]}; numpy has {there.features}, of {here.features}")
    assert not set(WIDE) & set(there.features) or "AVX-512" not in switch
    ours, theirs = here.of(method), there.of(method)
    assert ours
    assert ours.keys() == theirs.keys()
    assert [name for name, path in ours.items() if path.read_bytes() != theirs[name].read_bytes()] == []


@pytest.mark.parametrize("method", METHODS)
def test_without_avx2_values_differ_by_no_more_than_the_documents_say(outputs, method):
    """Complex products without a fused operation, and exponentials of other polynomials: one step, here and there."""
    here, there = outputs(), outputs(("NPY_DISABLE_CPU_FEATURES", " ".join(THERE)))
    print(f"{NARROW}: {THERE} disabled; numpy has {there.features}")
    ours, theirs = here.of(method), there.of(method)
    assert ours.keys() == theirs.keys()
    for name, path in ours.items():
        exact, other = pixels(path), pixels(theirs[name])
        if exact is not None:
            assert other is not None
            step = 1 / np.iinfo(exact.dtype).max
            differences = np.abs(exact.astype(np.int64) - other) * step
            assert differences.max() <= ALLOWED.get(method, step), name
            if method not in ALLOWED:
                assert np.mean(differences > 0) < 0.01, name


def pixels(path: Path) -> np.ndarray | None:
    """What is exact in a file: a still's pixels, a lossless film's frames; None for files coded with loss."""
    if path.suffix == ".npy":
        return None if "-mp4" in path.name else np.load(path)
    data = path.read_bytes()
    return np.asarray(imagecodecs.png_decode(data)) if data.startswith(b"\x89PNG") else None

"""Environment of child processes: an allow-list, so that no worker or decoder holds the operator's secrets.

What a process was started with stands in ``/proc`` for as long as it lives, whatever it does to its own variables.
"""

import os
from collections.abc import Mapping

NAMES = frozenset(
    {
        "HOME",
        "LANG",
        "LANGUAGE",
        "LOGNAME",
        "PATH",
        "SSL_CERT_DIR",
        "SSL_CERT_FILE",
        "TEMP",
        "TMP",
        "TMPDIR",
        "TZ",
        "USER",
        "VIRTUAL_ENV",
    }
)
PREFIXES = ("BLIS_", "DASK_", "FAKETIME", "LC_", "LD_", "MALLOC_", "MKL_", "NPY_", "OMP_", "OPENBLAS_", "PYTHON")


def is_allowed(name: str) -> bool:
    """Whether a child process is given this variable: what it needs to start and to compute.

    Examples
    --------
    >>> is_allowed("PATH"), is_allowed("OMP_NUM_THREADS"), is_allowed("MICROTEXTURE_OPERATOR_TOKEN")
    (True, True, False)
    """
    return name in NAMES or name.startswith(PREFIXES)


def allowed(environment: Mapping[str, str]) -> dict[str, str]:
    """Keep what child processes are given."""
    return {name: value for name, value in environment.items() if is_allowed(name)}


def keep_allowed() -> None:
    """Forget everything else in this process, for good: for one that has read its settings and starts others.

    Not every library that starts processes can be told what to give them.
    """
    for name in [name for name in os.environ if not is_allowed(name)]:
        del os.environ[name]

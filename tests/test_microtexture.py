"""The name `microtexture` in a checkout leads to the modules of `app.synthesis`, not to copies of them."""

import subprocess
import sys

import pytest

from app.settings import ROOT

MODULES = [
    ".".join(path.relative_to(ROOT / "app" / "synthesis").with_suffix("").parts)
    for path in (ROOT / "app" / "synthesis").rglob("*.py")
    if path.stem != "__init__"
]
PROGRAM = """
import sys
from importlib import import_module
modules, prefixes = sys.argv[1].split(","), sys.argv[2:]
pairs = [[import_module(f"{prefix}.{name}") for prefix in prefixes] for name in modules]
assert all(one is other for one, other in pairs)
assert all(one.__name__ == one.__spec__.name == f"app.synthesis.{name}" for (one, _), name in zip(pairs, modules))
import app.synthesis, microtexture
assert microtexture is app.synthesis
print("one")
"""


@pytest.mark.parametrize("order", [("app.synthesis", "microtexture"), ("microtexture", "app.synthesis")])
def test_both_names_give_the_same_modules(order: tuple[str, str]) -> None:
    command = [sys.executable, "-W", "error", "-c", PROGRAM, ",".join(MODULES), *order]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout == "one\n", done.stderr

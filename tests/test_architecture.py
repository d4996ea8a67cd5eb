"""The layers that docs/architecture.md draws are the ones the code has."""

import ast
import subprocess
import sys
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from app.settings import ROOT

APP = ROOT / "app"
FORBIDDEN = ("fastapi", "starlette", "sqlalchemy", "pydantic", "distributed", "PIL")

# From the ground up: a module imports from its own layer and from those below it.
LAYERS = (
    {"app.child_environment", "app.errors", "app.numbers", "app.settings", "app.threads"},
    {"app.synthesis"},
    {"app.images"},
    {"app.methods", "app.samples", "app.gallery"},
    {"app.experiments"},
    {"app.store", "app.executor"},
    {"app.web"},
    {"app.main", "app.worker"},  # the wiring: of the service, and of a worker process
    {"app.cli"},
)


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {name_of(path): path for path in APP.rglob("*.py")}
SYNTHESIS = sorted(name for name in MODULES if name.startswith("app.synthesis."))


def is_type_checking(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def origin(module: str, node: ast.ImportFrom) -> str:
    """The absolute name of what a module imports from."""
    if node.level == 0:
        return node.module or ""
    here = module.split(".") if MODULES[module].stem == "__init__" else module.split(".")[:-1]
    return ".".join([*here[: len(here) - node.level + 1], *(node.module or "").split(".")]).rstrip(".")


def imports_in(module: str, node: ast.AST, *, lazy: bool) -> set[str]:
    """Modules imported by a part of a module's syntax tree; those inside functions only where ``lazy``."""
    found: set[str] = set()
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Import):
            found |= {alias.name for alias in child.names}
        elif isinstance(child, ast.ImportFrom):
            base = origin(module, child)
            found |= {f"{base}.{alias.name}" if f"{base}.{alias.name}" in MODULES else base for alias in child.names}
        elif is_type_checking(child) and not lazy:
            continue
        elif lazy or not isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            found |= imports_in(module, child, lazy=lazy)
    return found


@cache
def imports(module: str, *, lazy: bool = True) -> frozenset[str]:
    return frozenset(imports_in(module, ast.parse(MODULES[module].read_text(encoding="utf-8")), lazy=lazy))


def layer(module: str) -> int:
    if module == "app":  # holds nothing
        return 0
    return next(height for height, names in enumerate(LAYERS) if {module, ".".join(module.split(".")[:2])} & names)


def test_every_module_belongs_to_a_layer() -> None:
    assert all(layer(module) >= 0 for module in MODULES)


def test_imports_point_one_way() -> None:
    upwards = {
        f"{module} imports {imported}"
        for module in MODULES
        for imported in imports(module)
        if imported.split(".")[0] == "app" and layer(imported) > layer(module)
    }
    assert upwards == set()


def test_no_two_modules_import_each_other() -> None:
    graph = {module: {name for name in imports(module, lazy=False) if name in MODULES} for module in MODULES}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(f"imports go in a circle: {' → '.join(error.args[1])}")


@pytest.mark.parametrize(
    ("library", "allowed"),
    [
        ("fastapi", ("app.web", "app.main")),
        ("starlette", ("app.web", "app.main")),
        ("sqlalchemy", ("app.store",)),
        ("distributed", ("app.executor",)),
        ("typer", ("app.cli",)),
        ("uvicorn", ("app.cli",)),
        ("PIL", ("app.images", "app.web")),
    ],
)
def test_a_library_is_imported_only_where_it_belongs(library: str, allowed: tuple[str, ...]) -> None:
    users = {module for module in MODULES if any(name.split(".")[0] == library for name in imports(module))}
    assert {module for module in users if not module.startswith(allowed)} == set()


def test_only_the_wiring_names_backends() -> None:
    """Everything else takes a store and an engine through the protocols of `app.experiments.ports`."""
    backends = ("app.store", "app.executor")
    users = {
        module
        for module in MODULES
        if not module.startswith(backends) and any(name.startswith(backends) for name in imports(module))
    }
    assert users <= {"app.main", "app.worker"}


@pytest.mark.parametrize("module", MODULES)
def test_only_the_numerics_import_relatively_and_only_from_themselves(module: str) -> None:
    """They are a library of their own too, `microtexture`, in which there is no `app`."""
    tree = ast.parse(MODULES[module].read_text(encoding="utf-8"))
    imported = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    if module == "app.synthesis" or module in SYNTHESIS:
        assert all(name.startswith("app.synthesis") for name in imports(module) if name.split(".")[0] == "app")
        assert all(node.level > 0 for node in imported if origin(module, node).split(".")[0] == "app")
    else:
        assert all(node.level == 0 for node in imported)


def test_numerics_load_nothing_of_the_service() -> None:
    """In a fresh process, so that nothing this run has imported hides it; what a module loads stays loaded."""
    script = f"""
import importlib, sys
for module in {SYNTHESIS!r}:
    importlib.import_module(module)
    loaded = {{name.split(".")[0] for name in sys.modules}} & set({FORBIDDEN!r})
    assert not loaded, f"{{module}} loads {{loaded}}"
    print(module)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.stdout.split() == SYNTHESIS, done.stderr


@pytest.mark.parametrize("directory", ["app", "static", "templates", "scripts", "benchmarks", "tests"])
def test_no_file_has_more_than_300_lines(directory: str) -> None:
    files = (path for path in (ROOT / directory).rglob("*") if path.suffix in {".py", ".js", ".css", ".html"})
    assert {path.name: lines for path in files if (lines := len(path.read_text("utf-8").splitlines())) > 300} == {}

"""What could make a texture hang on the processor: functions that numpy computes otherwise on another one."""

import ast
from decimal import Decimal, localcontext
from pathlib import Path

import numpy as np
import pytest

from app.settings import ROOT
from app.synthesis import elementary
from app.synthesis.fourier.spectral import STATES
from app.synthesis.gaussian.adsn import _rayleigh_table
from app.synthesis.gaussian.rpn import phase_table

# In single precision these have other bits with AVX-512 than without; BLAS has others for each of its kernels.
VARYING = {
    *("exp2", "expm1", "log1p", "log2", "log10", "power", "float_power", "cbrt"),
    *("tan", "arcsin", "arccos", "arctan", "arctan2", "sinh", "cosh", "arcsinh", "arccosh", "arctanh", "angle"),
    *("dot", "vdot", "inner", "matmul", "tensordot", "linalg", "convolve", "correlate", "cov", "corrcoef"),
    *("argpartition",),
}
# Why what is left does no harm.
ALLOWED = {
    ("cell_shapes.py", "log1p"): "in double precision, rounded to single",
    ("colour_space.py", "linalg"): "in double precision, rounded to single",
    ("colour_space.py", "@"): "in double precision, rounded to single",
    ("cut_texton.py", "linalg"): "in double precision, rounded to single",
    ("cut_texton.py", "@"): "in double precision, rounded to single",
    ("window_search.py", "matmul"): "sifts only: what its rounding leaves in doubt is measured again",
    ("periodic.py", "@"): "products of single precision are exact in double precision",
    ("structure.py", "arcsin"): "of a number that is shown, not of a texture",
}
FILES = [path for part in ("synthesis", "methods", "images/video") for path in (ROOT / "app" / part).rglob("*.py")]


def varying(path: Path) -> set[str]:
    """Names in a file of what has other bits on another processor, ``argsort`` among them unless it is stable."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "np":
            found |= {node.attr} & VARYING
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
            found.add("@")
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "argsort":
            stable = any(word.arg == "kind" and ast.unparse(word.value) == "'stable'" for word in node.keywords)
            found |= set() if stable else {"argsort"}
    return found


def test_no_texture_is_made_with_functions_that_vary_with_the_processor() -> None:
    """`app.synthesis.elementary` has others for them; each exception has its reason."""
    found = {(path.name, name) for path in FILES for name in varying(path)}
    assert found == ALLOWED.keys()


@pytest.mark.parametrize(
    ("function", "truth"),
    [
        (elementary.log2, np.log2),
        (elementary.log10, np.log10),
        (lambda x: elementary.power(x, -0.7), lambda x: x**-0.7),
        (elementary.exp, np.exp),
        (elementary.log, np.log),
        (elementary.log1p, np.log1p),
    ],
)
def test_functions_are_exact_to_what_single_precision_takes(function, truth) -> None:
    x = np.random.default_rng(0).uniform(0.01, 20, 1000).astype(np.float32)
    np.testing.assert_allclose(function(x), truth(x.astype(np.float64)), rtol=3e-6, atol=1e-6)


def test_the_tables_are_so_far_from_a_tie_that_no_library_rounds_them_otherwise() -> None:
    """A last bit more or less in double precision, as libraries differ, leaves every phase and modulus as it is."""
    theta = np.pi * (1 - 2 * np.arange(STATES) / STATES)
    for function, part in ((np.cos, phase_table().real), (np.sin, phase_table().imag)):
        exact = function(theta)
        for neighbour in (np.nextafter(exact, -9), exact, np.nextafter(exact, 9)):
            axis = np.abs(exact) < 1e-15  # 0 but for the rounding of π, which is one double everywhere
            assert (neighbour.astype(np.float32) == part)[~axis].all()


def test_rayleigh_moduli_are_rounded_correctly() -> None:
    """Against 40 digits, each 17th of them and the last ones, where the formula cancels most."""
    with localcontext() as context:
        context.prec = 40
        for j in [*range(1, STATES, 17), *range(STATES - 50, STATES)]:
            below, above = Decimal(j) / STATES, Decimal(j + 1) / STATES
            square = 1 + j * below.ln() - (j + 1) * above.ln()
            assert np.float32(float(square.sqrt())) == _rayleigh_table()[j], j

"""Elementary functions that have the same bits on every processor with AVX2 and FMA, and with AVX-512 as well.

numpy has a version of these for each width of vectors, and takes the widest that the processor at hand allows; they
round differently, and so may the texture. Alike are ``exp``, ``log``, ``sin`` and ``cos`` in single precision. The
others are made of these here, or computed by the C library one value after the other, which will do for tables.

Nothing need be done about sums, means, products, quotients, roots, or `scipy.fft`. Products by BLAS have other bits on
other processors: there is `numpy.einsum` instead. What is computed in double precision and rounded to single differs
once in 2²⁹ values.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Complex, Double, Real


def exp(x: ArrayLike) -> Double:
    """Exponential function of x, in double precision; 0.1 µs a value.

    Examples
    --------
    >>> exp([0, 1]).round(3).tolist()
    [1.0, 2.718]
    """
    return _one_by_one(math.exp, x)


def log(x: ArrayLike) -> Double:
    """Natural logarithm of values above 0, in double precision; 0.1 µs a value.

    Examples
    --------
    >>> log([1, math.e]).tolist()
    [0.0, 1.0]
    """
    return _one_by_one(math.log, x)


def log1p(x: ArrayLike) -> Double:
    """Natural logarithm of 1 + x for values above −1, in double precision; 0.1 µs a value.

    Examples
    --------
    >>> float(log1p([1e-20])[0])
    1e-20
    """
    return _one_by_one(math.log1p, x)


def power(x: Real, exponent: float) -> Real:
    """A power of values from 0 up, in single precision.

    Examples
    --------
    >>> power(np.array([0, 4], np.float32), 1.5).round(4).tolist()
    [0.0, 8.0]
    """
    with np.errstate(divide="ignore"):
        logs: Real = np.log(x)
    logs *= np.float32(exponent)
    np.exp(logs, out=logs)
    return logs


def log2(x: Real) -> Real:
    """Binary logarithm of values from 0 up, in single precision.

    Examples
    --------
    >>> log2(np.array([0, 8], np.float32)).round(6).tolist()
    [-inf, 3.0]
    """
    return _logarithm(x, 2)


def log10(x: Real) -> Real:
    """Decimal logarithm of values from 0 up, in single precision.

    Examples
    --------
    >>> log10(np.array([0, 1000], np.float32)).round(6).tolist()
    [-inf, 3.0]
    """
    return _logarithm(x, 10)


def angle(z: Complex) -> Real:
    """Argument of complex numbers, of [−π, π], 0 for 0.

    Examples
    --------
    >>> bool(np.allclose(angle(np.array([0, 1, 1j, -1], np.complex64)), [0, 0, np.pi / 2, np.pi]))
    True
    """
    with np.errstate(divide="ignore"):
        logs: Complex = np.log(z)  # the C library's, which that of real numbers is not
    return logs.imag


def _logarithm(x: Real, base: int) -> Real:
    with np.errstate(divide="ignore"):
        logs: Real = np.log(x)
    logs *= np.float32(1 / math.log(base))
    return logs


def _one_by_one(function: Callable[[float], float], x: ArrayLike) -> Double:
    values = np.asarray(x, np.float64)
    return np.array([function(value) for value in values.ravel().tolist()]).reshape(values.shape)

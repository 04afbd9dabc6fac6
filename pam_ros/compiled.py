# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Compile plain scalar functions with numba where it is installed, else leave them as they are.

The same source runs both ways: rooms write scalar Python with ``math`` and decorate it.
"""

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

import numpy as np

numba: Any
try:
    numba = import_module('numba')
except ImportError:  # rosdep has numba on Debian and Ubuntu only
    numba = None

HAVE_NUMBA = numba is not None
F = TypeVar('F', bound=Callable[..., Any])


def scalar(function: F) -> F:
    """Return *function* compiled for float64 scalars and arrays passed by reference.

    Callers that pass it on to another compiled function pay nothing: it is inlined.
    """
    if numba is None:
        return function
    compiled: F = numba.njit(nogil=True, error_model='numpy')(function)
    return compiled


def cached(function: F) -> F:
    """As :func:`scalar`, with the machine code kept on disk between runs.

    numba's cache sees changes of the function's own file only. A caller that binds other
    functions into it must give it a name that changes with them (see ``rig/bind.py``).
    """
    if numba is None:
        return function
    compiled: F = numba.njit(nogil=True, error_model='numpy', cache=True)(function)
    return compiled


def broadcast(function: Callable[..., float]) -> Callable[..., Any]:
    """Return a scalar function of floats as one that broadcasts over numpy arrays.

    The source stays one; with numba it becomes a ufunc, without it a ``numpy.vectorize``.
    """
    if numba is None:
        return np.vectorize(function, otypes=[float])
    plain = getattr(function, 'py_func', function)
    ufunc: Callable[..., Any] = numba.vectorize(plain)
    return ufunc

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Compile plain scalar functions with numba if it is installed, else leave them unchanged.

The same source is used in both cases: packages write scalar Python with ``math`` and decorate it.
"""

from collections.abc import Callable
from importlib import import_module
from types import FunctionType
from typing import Any, TypeVar

import numpy as np

from pam_ros.code_cache import CodeCache

numba: Any
try:
    numba = import_module('numba')
except ImportError:  # rosdep has numba on Debian and Ubuntu only
    numba = None

HAVE_NUMBA = numba is not None
# No allocation here, so that arrays need no reference counts: counting at every call of every
# effect would take ten times as long as the physics.
_OPTIONS: dict[str, Any] = {'nogil': True, 'error_model': 'numpy', '_nrt': False}
_ON_ARRAYS = {
    'exp': np.exp,
    'sqrt': np.sqrt,
    'max': np.maximum,
    'sin': np.sin,
    'cos': np.cos,
}
F = TypeVar('F', bound=Callable[..., Any])


def scalar(function: F) -> F:
    """Return *function* compiled for float64 scalars and arrays passed by reference.

    A call from another compiled function costs nothing: the function is inlined.
    """
    return _inlined(function)


def inner(function: F) -> F:
    """As :func:`scalar`, for functions that only compiled functions call, and not Python.

    It cannot be called from Python, since the wrappers for such calls are not compiled.
    """
    return _inlined(function, no_cpython_wrapper=True, no_cfunc_wrapper=True)


def cached(function: F) -> F:
    """As :func:`scalar`, with the machine code stored on disk between runs, if that is possible.

    numba's cache detects only changes of the function's own file. A caller that binds other
    functions into it must give it a name that changes with them (see ``rig/bind.py``).
    """
    if numba is None:
        return function
    compiled: Any = _compiled(function)
    # As enable_caching() of numba does, with a cache whose failures are not errors.
    compiled._cache = CodeCache(function)
    kept: F = compiled
    return kept


def _inlined(function: F, **more: bool) -> F:
    if numba is None:
        return function
    return _compiled(_of_this_module(function), forceinline=True, **more)


def _compiled(function: F, **more: bool) -> F:
    compiled: F = numba.njit(**_OPTIONS, **more)(function)
    return compiled


def _of_this_module(function: F) -> F:
    """Return a copy of *function* whose module is, by name, this one.

    With a cached function numba stores the name of the module of each function that was compiled
    into it, and imports these modules when it loads the machine code, although the code does not
    need them. A user's file may have another name or place by then; this module always exists.
    """
    source = plain(function)
    copy: Any = FunctionType(
        source.__code__,
        source.__globals__,
        source.__name__,
        source.__defaults__,
        source.__closure__,
    )
    copy.__kwdefaults__ = source.__kwdefaults__
    copy.__qualname__ = f'{source.__module__}.{source.__qualname__}'
    copy.__module__ = __name__
    own: F = copy
    return own


def plain(function: F) -> F:
    """Return the Python source of a :func:`scalar` function that calls no other function.

    For callers that run in Python: compiling would cost them time without any gain.
    """
    source: F = getattr(function, 'py_func', function)
    return source


def broadcast(function: Callable[..., float]) -> Callable[..., Any]:
    """Return a scalar function as one that broadcasts over numpy arrays (and numpy scalars).

    There is only one source: it runs with numpy's ``exp``, ``sqrt``, ``max``, ``sin`` and ``cos``
    under the names of the scalar functions. The same is done for the functions that it calls.
    Unlike a compiled ufunc this costs nothing at import and does not need numba.
    """
    plain = getattr(function, 'py_func', function)
    names = {**plain.__globals__, **_ON_ARRAYS}
    for name in plain.__code__.co_names:
        called: Any = plain.__globals__.get(name)
        if isinstance(getattr(called, 'py_func', called), FunctionType):
            names[name] = broadcast(called)
    return FunctionType(plain.__code__, names, plain.__name__)

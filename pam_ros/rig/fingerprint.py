# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The fingerprint of a compiled function, under which its machine code is kept on disk."""

import hashlib
from collections.abc import Callable, Iterator, Mapping
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

from pam_ros import compiled


def fingerprint(function: Callable[..., Any]) -> str:
    """Return a hash of everything that the machine code of *function* depends on.

    That is the bytecode of all functions that it reaches, in any file, the constants that they
    read (among them offsets in the rows, and arrays), and the modules that numba imports when it
    loads the machine code.
    """
    digest = hashlib.sha256()
    seen: set[FunctionType] = set()
    for root in (function, compiled.scalar, compiled.inner, compiled.cached):
        for part in _parts(root, seen):
            digest.update(repr(part).encode())
    return digest.hexdigest()[:16]


def _parts(value: Any, seen: set[FunctionType]) -> Iterator[Any]:
    """Yield the parts of a *value* that a function reads, and of all that the value depends on."""
    plain = getattr(value, 'py_func', value)
    if isinstance(plain, FunctionType):
        yield plain.__module__, plain.__name__
        if plain not in seen:
            seen.add(plain)
            yield plain.__defaults__, plain.__kwdefaults__
            yield from _parts_of_code(plain.__code__, plain.__globals__, seen)
            for cell in plain.__closure__ or ():
                yield from _parts(cell.cell_contents, seen)
    elif isinstance(plain, tuple):
        yield len(plain)
        for each in plain:
            yield from _parts(each, seen)
    elif isinstance(plain, (np.ndarray, np.generic)):
        yield str(plain.dtype), plain.shape, plain.tobytes()
    elif isinstance(plain, (bool, int, float, complex, str, dict)):
        yield plain


def _parts_of_code(
    code: CodeType, names: Mapping[str, Any], seen: set[FunctionType]
) -> Iterator[Any]:
    """Yield the code, its constants, and the parts of the values that it reads in *names*."""
    yield code.co_code, code.co_names, code.co_varnames, code.co_freevars
    for constant in code.co_consts:
        if isinstance(constant, CodeType):  # of a function inside the function
            yield from _parts_of_code(constant, names, seen)
        else:
            yield constant
    scopes: list[Mapping[str, Any]] = [names]
    modules: set[ModuleType] = set()
    for scope in scopes:  # grows by the modules whose names the code may read
        for name in code.co_names:
            value = scope.get(name)
            if isinstance(value, ModuleType):
                if value not in modules:
                    modules.add(value)
                    scopes.append(vars(value))
            elif scope is names or not isinstance(value, FunctionType):
                # Plain functions of modules are those of numpy, which numba implements itself.
                yield from _parts(value, seen)

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Compile the kernel with numba where it is there; the same source runs as plain Python else."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

try:
    import numba

    COMPILED = not numba.config.DISABLE_JIT
except ImportError:
    COMPILED = False

# Numba's disk cache watches one file only. The digest of all sources is a field of every
# record, hence part of the compiled signature: a kernel built from older text is never used.
_DIGEST = zlib.crc32(
    b''.join(path.read_bytes() for path in sorted(Path(__file__).parent.glob('[!t]*.py')))
)


def jit(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compiled function, or the function itself without numba."""
    if not COMPILED:
        return function
    return numba.njit(cache=True, error_model='numpy')(function)


def blank(name: str, scalars: tuple[str, ...], arrays: dict[str, int]) -> Any:
    """Return a one-element sequence with a zeroed record of named float fields.

    Its element is read and written by attribute: a numpy record for numba, a namespace (much
    faster to read) for plain Python. Kernels take the sequence, which numba unpacks ten times
    faster than the record.
    """
    if not COMPILED:
        fields: dict[str, Any] = dict.fromkeys(scalars, 0.0)
        fields.update({field: [0.0] * size for field, size in arrays.items()})
        return [SimpleNamespace(**fields)]
    dtype: list[Any] = [(field, np.float64) for field in scalars]
    dtype += [(field, np.float64, (size,)) for field, size in arrays.items()]
    dtype.append((f'{name}_{_DIGEST:08x}', np.float64))
    return np.zeros(1, dtype=np.dtype(dtype, align=True))


def element(sequence: Any) -> Any:
    """Return the record of what `blank` made, sharing its memory."""
    return sequence.view(np.recarray)[0] if isinstance(sequence, np.ndarray) else sequence[0]

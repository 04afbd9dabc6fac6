# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The derivatives of the residuals of several runs, as one block for each run.

The start of a run acts in this run alone. With many runs most of the Jacobian is therefore 0: of
ten runs with ten common unknowns and four of its own each, one run depends on 14 unknowns of 50.
Products with the blocks cost accordingly less.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.fit.discrepancy import Whitening

Array = NDArray[np.float64]
Indices = NDArray[np.int_]


# Multiplications up to which BLAS computes a product in the thread that calls it. Fits run in
# parallel, and threads of BLAS that wait for each other took nine tenths of the time of a search.
ALONE = 200_000


def product(a: Array, b: Array) -> Array:
    """Return A'B (k, m) of *a* A (n, k) and *b* B (n, m), by parts in this thread alone."""
    (n, k), m = a.shape, b.shape[1]
    rows = max(ALONE // max(k * m, 1), 1)
    parts, whole = n // rows, n // rows * rows
    left = a[:whole].reshape(parts, rows, k).transpose(0, 2, 1)
    found: Array = np.matmul(left, b[:whole].reshape(parts, rows, m)).sum(axis=0)
    found += a[whole:].T @ b[whole:]
    return found


@dataclass(frozen=True, eq=False)
class Slopes:
    """The Jacobian (n, k) of the residuals of all runs, one after the other.

    ``blocks`` are the derivatives (n_r, k_r) in each run by the unknowns ``columns`` (k_r,) that
    act in it; the derivatives by the others are 0. ``unknowns`` is k.
    """

    blocks: Sequence[Array]
    columns: Sequence[Indices]
    unknowns: int

    @classmethod
    def of(cls, parts: Sequence[Array], columns: Sequence[Indices]) -> 'Slopes':
        """Return the blocks of a Jacobian, given as the rows of each run, *parts* (n_r, k)."""
        pairs = zip(parts, columns, strict=True)
        return cls([part.take(own, axis=1) for part, own in pairs], columns, parts[0].shape[1])

    @property
    def dense(self) -> Array:
        """The Jacobian (n, k) with all of its zeros."""
        parts = []
        for block, own in zip(self.blocks, self.columns, strict=True):
            part = np.zeros((block.shape[0], self.unknowns))
            part[:, own] = block
            parts.append(part)
        return np.concatenate(parts)

    def whitened(self, whitenings: Sequence[Whitening]) -> 'Slopes':
        """Return the slopes of the whitened residuals; *whitenings* are the maps of the runs."""
        pairs = zip(whitenings, self.blocks, strict=True)
        return Slopes([map_(block) for map_, block in pairs], self.columns, self.unknowns)

    def normal(self) -> Array:
        """Return J'J (k, k)."""
        found = np.zeros((self.unknowns, self.unknowns))
        for block, own in zip(self.blocks, self.columns, strict=True):
            found[np.ix_(own, own)] += product(block, block)
        return found

    def onto(self, residuals: Sequence[Array]) -> Array:
        """Return J'r (k,) for *residuals* r (n_r,) of the runs."""
        found = np.zeros(self.unknowns)
        for block, own, r in zip(self.blocks, self.columns, residuals, strict=True):
            found[own] += block.T @ r
        return found

    def along(self, step: Array) -> Array:
        """Return J du (n,), the linear change of the residuals with a *step* du (k,)."""
        pairs = zip(self.blocks, self.columns, strict=True)
        return np.concatenate([block @ step[own] for block, own in pairs])

    def updated(self, step: Array, change: Sequence[Array]) -> 'Slopes':
        """Return the slopes with the least change that gives the measured *change* of residuals.

        *change* (n_r,) of the runs was found with a *step* (k,). This is Broyden's rule with the
        zeros of the Jacobian kept (Schubert, Mathematics of Computation 24, 1970): in each run
        only the unknowns that act there can explain the change.
        """
        blocks = []
        for block, own, dr in zip(self.blocks, self.columns, change, strict=True):
            du = step[own]
            less = np.outer(dr - block @ du, du) / max(float(du @ du), 1e-300)
            blocks.append(block + less)
        return Slopes(blocks, self.columns, self.unknowns)

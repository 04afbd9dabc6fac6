# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""One source for scalars and arrays, compiled or not."""

from math import exp, sqrt

import numpy as np

from pam_ros import compiled


@compiled.inner
def bell(x: float) -> float:
    """Return a bell."""
    return exp(-x * x)


@compiled.scalar
def outer(x: float, scale: float) -> float:
    """Return a scaled bell that calls another function."""
    return scale * sqrt(bell(max(x, 0.0)))


def test_broadcast_runs_the_same_source_over_arrays():
    x = np.linspace(-1.0, 2.0, 7)
    expected = 3.0 * np.sqrt(np.exp(-(np.maximum(x, 0.0) ** 2)))
    np.testing.assert_allclose(compiled.broadcast(outer)(x, 3.0), expected, rtol=1e-15)
    np.testing.assert_allclose([outer(each, 3.0) for each in x], expected, rtol=1e-15)
    assert compiled.broadcast(outer)(x[:, None], np.ones(4)).shape == (7, 4)


def test_without_numba_functions_stay_as_they_are(monkeypatch):
    monkeypatch.setattr(compiled, 'numba', None)

    def double(x: float) -> float:
        return 2.0 * x

    assert compiled.scalar(double) is double
    assert compiled.inner(double) is double
    assert compiled.cached(double) is double
    np.testing.assert_array_equal(compiled.broadcast(double)(np.arange(3.0)), [0.0, 2.0, 4.0])

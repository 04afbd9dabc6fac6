# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What was recorded with version 0.1.0, and how results of today are compared with it.

Runs have the same bits where the mathematical functions of the platform and of numpy do, which
a hash in the file says; those of numpy depend on its version and on the processor. Elsewhere, and
as plain Python, which rounds some sums in another order, results agree to a billionth of the
motion.
"""

import hashlib
import math
from pathlib import Path

import numpy as np

from pam_ros.compiled import HAVE_NUMBA

RECORDED = np.load(Path(__file__).with_name('runs.npz'))


def probe():
    """Return a hash of what the mathematical functions of the platform and of numpy give."""
    x = np.linspace(-30.0, 3.0, 400)
    digest = hashlib.sha256()
    for f in (math.exp, math.expm1, math.sin, math.cos):
        digest.update(np.array([f(a) for a in x]).tobytes())
    for f in (math.log1p, math.sqrt, math.log):
        digest.update(np.array([f(abs(a) + 0.1) for a in x]).tobytes())
    for ufunc in (np.exp, np.expm1, np.sin, np.cos, np.arctan):
        digest.update(ufunc(x).tobytes())
    for power in (-0.5, 0.3, 1.7):
        digest.update(np.power(np.abs(x) + 0.1, power).tobytes())
    return digest.hexdigest()


HAS_SAME_BITS = HAVE_NUMBA and probe() == str(RECORDED['functions'])


def compare(key, found, close=1e-9, axis=0, to_the_bit=HAS_SAME_BITS):
    """Compare *found* with what is recorded as *key*: to the bit, else as *close*.

    Where the bits differ *close* is a share of the largest value along *axis*.
    """
    recorded = RECORDED[key]
    if to_the_bit:
        np.testing.assert_array_equal(found, recorded)
    else:
        scale = np.max(np.abs(recorded), axis=axis, keepdims=True)
        assert np.max(np.abs(found - recorded) / np.where(scale > 0.0, scale, 1.0)) < close

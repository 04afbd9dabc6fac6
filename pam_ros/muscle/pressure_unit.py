# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Pressures of users that are probably in another unit than Pa."""

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from pam_ros.muscle.muscle import Muscle

IN_KPA = 1e-3  # fraction of p_max up to which a pressure may be a value in kPa
TOO_HIGH = 5.0  # times p_max: no valve gives it, and no force law is valid there


def is_low(pressure: float, p_max: float) -> bool:
    """Return whether a *pressure* in Pa is so low that it may be in kPa or bar; 0 is not."""
    return 0.0 < abs(pressure) <= IN_KPA * p_max


def warn_of_unit(name: str, pressure: ArrayLike, muscles: Sequence[Muscle]) -> None:
    """Warn if *pressure* in Pa, of any shape, is probably in another unit.

    *name* is its name in the warning, which is attributed to the caller of the caller. The input
    of a force source in place of a *muscle* has its own unit.
    """
    if all(muscle.is_load_only for muscle in muscles):
        return
    p_max = max(muscle.p_max for muscle in muscles)
    highest = float(np.max(np.abs(pressure), initial=0.0))
    if is_low(highest, p_max):
        warnings.warn(
            f'{name} reaches {highest:g} Pa only, and p_max is {p_max:g} Pa: '
            'pressures are in Pa, is it in kPa or bar?',
            stacklevel=3,
        )
    elif highest > TOO_HIGH * p_max:
        warnings.warn(
            f'{name} reaches {highest:g} Pa, and p_max is {p_max:g} Pa: the force law is not '
            'valid there',
            stacklevel=3,
        )

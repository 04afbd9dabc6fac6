# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How much of a trial's effect could be seen at all, and how much re-tuning would hide."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .trials import Trial


@dataclass(frozen=True)
class Visibility:
    """RMS in m: of the effect, of what re-tuning leaves of it (to first order), of the noise."""

    effect: float
    remainder: float
    noise: float


def visibility(trial: Trial, *, mass_free: bool = False) -> Visibility:
    """Return how visible a free trial's effects are.

    The difference with and without the effects is projected on the sensitivities to the configured
    parameters (a1..a6, zeta, mass_free: mass); what is left over no re-tuning can explain, to
    first order.
    """
    base = trial.replay(effects=())
    difference = trial.replay() - base
    columns = []
    constants = np.array(trial.constants_si)
    for i in range(6):
        changed = constants.copy()
        changed[i] *= 1.0 + 1e-4
        columns.append(trial.replay(effects=(), constants=tuple(changed)) - base)
    columns.append(trial.replay(effects=(), zeta=trial.zeta * 1.001) - base)
    if mass_free:
        columns.append(trial.replay(effects=(), mass=trial.mass * 1.0001) - base)
    matrix = np.column_stack(columns)
    matrix /= np.linalg.norm(matrix, axis=0)
    left = difference - matrix @ np.linalg.lstsq(matrix, difference, rcond=1e-9)[0]
    return Visibility(
        float(np.sqrt(np.mean(difference**2))), float(np.sqrt(np.mean(left**2))), trial.noise
    )

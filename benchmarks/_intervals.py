# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How often a 95 % interval contains the true value, for parameters of the same meaning.

Most effects of the truth plant have other equations than those of the package, and so no common
parameters. The table lists those that have common ones. The constants of the muscle have the same
meaning only if every effect of the rig has the same equations as in the package: otherwise they
contain a part of the effects, such as the loss of a leak or the gain of a regulator.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pam_ros.identification.result import Estimate
from pam_ros.rig.loads import GRAVITY
from truth import Trial, muscles
from truth.plant import SUBSTEP

Values = Mapping[str, float]
Array = NDArray[np.float64]


def mean_delay(dead_time: float, t: Array) -> float:
    """Return the mean time in s after which the plant uses commands with the stamps t (n,).

    It is longer than the *dead_time* in s: the plant takes a command at the beginning of the next
    substep. With equidistant stamps this is the same part of a substep for all commands.
    """
    counts = np.maximum(np.ceil(np.diff(t) / SUBSTEP - 1e-6), 1).astype(int)
    held = zip(t[:-1], t[1:], counts, strict=True)
    substeps = np.concatenate([np.linspace(a, b, n, endpoint=False) for a, b, n in held])
    taken = np.searchsorted(substeps, t + dead_time - 1e-9)
    is_taken = taken < substeps.size
    return float(np.mean(substeps[taken[is_taken]] - t[is_taken]))


# The true value as a function of the parameters of the plant's effect and the command stamps.
SAME: dict[tuple[str, str], dict[str, Callable[[Values, Array], float]]] = {
    ('viscous_friction', 'linear'): {
        'effects.viscous_friction.coefficient': lambda v, _: v['viscous_ns_m'],
    },
    ('coulomb_friction', 'lugre'): {  # of steady sliding
        'effects.coulomb_friction.level': lambda v, _: v['coulomb_n'],
    },
    ('pressure_lag', 'two_times'): {
        'effects.pressure_lag.fill': lambda v, _: v['fill_s'],
        'effects.pressure_lag.vent': lambda v, _: v['vent_s'],
    },
    ('dead_time', 'transport'): {
        'effects.dead_time.delay': lambda v, t: mean_delay(v['dead_time_s'], t),
    },
    ('pressure_offset', 'affine'): {
        'effects.pressure_offset.offset': lambda v, _: v['regulator_pa'],
        'effects.pressure_offset.gain': lambda v, _: v['regulator_gain'] - 1.0,
    },
    ('payload', 'mass'): {
        'effects.payload.mass': lambda v, _: v['payload_kg'],
    },
    ('pressure_dependent_damping', 'two_ways'): {
        'effects.pressure_dependent_damping.inflating': lambda v, _: (
            v['damping_up_ns_m_bar'] / 1e5
        ),
        'effects.pressure_dependent_damping.deflating': lambda v, _: (
            v['damping_down_ns_m_bar'] / 1e5
        ),
    },
    ('periodic_disturbance', 'force'): {
        'effects.periodic_disturbance.frequency': lambda v, _: v['ripple_hz'],
    },
    ('periodic_disturbance', 'supply'): {
        'effects.periodic_disturbance.frequency': lambda v, _: v['ripple_hz'],
    },
    ('length_offset', 'rest'): {
        'effects.length_offset.offset': lambda v, _: v['kappa_offset'],
    },
}

EXACT = set(SAME) - {('coulomb_friction', 'lugre'), ('pressure_offset', 'affine')}


def truth_of(trial: Trial) -> dict[str, float]:
    """Return the true values of the trial by the package's names, constants in SI units."""
    truth = {}
    if all((one.kind, one.form) in EXACT for one in trial.effects):
        truth = {f'a{k}': a for k, a in enumerate(trial.constants_si, 1)}
        # The plant's gravity has fewer digits. The difference is a constant force, as a6 is.
        mass = trial.mass + sum(one.values.get('payload_kg', 0.0) for one in trial.effects)
        truth['a6'] -= mass * (muscles.GRAVITY - GRAVITY)
        truth['zeta'] = trial.zeta
    for one in trial.effects:
        for name, value in SAME.get((one.kind, one.form), {}).items():
            truth[name] = value(one.values, trial.recording.t_s)
    return truth


def intervals(truth: Values, estimates: Mapping[str, Estimate]) -> dict[str, list[float]]:
    """Return true value, low and high end of each fitted parameter whose truth is known."""
    return {
        name: [value, estimates[name].low, estimates[name].high]
        for name, value in truth.items()
        if name in estimates and estimates[name].low < estimates[name].high
    }


def are_inside(rows: list[dict[str, Any]], of_effects: bool) -> list[bool]:
    """Return whether each interval of the rows contains the truth, of effects or of muscles."""
    return [
        low <= value <= high
        for row in rows
        for name, (value, low, high) in row['intervals'].items()
        if name.startswith('effects.') == of_effects
    ]

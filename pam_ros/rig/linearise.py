# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The linear model of a joint about the position in which it rests under given pressures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.arguments import instance, one_each
from pam_ros.effects.base import Effect
from pam_ros.muscle.pressure_unit import warn_of_unit
from pam_ros.rig import layout as at
from pam_ros.rig import statics
from pam_ros.rig.changes import refuse_onsets
from pam_ros.rig.equilibrium import acceleration_of, rest_from, rest_position
from pam_ros.rig.joint import Joint
from pam_ros.rig.start import start_state

Array = NDArray[np.float64]
STEP = (
    1e-5  # of the length of a muscle, and of its highest pressure: a difference of the equations
)


@dataclass(frozen=True, eq=False)
class LinearModel:
    """x' = A x + B u, y = C x + D u: small deviations from an equilibrium, in SI.

    ``A`` (n, n), ``B`` (n, muscles), ``C`` (1, n) and ``D`` (1, muscles), which is 0. x are the
    ``states``: position (m or rad), velocity, and the pressure (Pa) in each chamber that follows
    its command with a lag. u are the commanded pressures (Pa), y is the position.

    ``position`` (m or rad) and ``pressure`` (muscles,), gauge Pa, are those of the equilibrium.
    ``left_out`` are the names of the effects of the joint that the model does not contain.
    The model is also the sequence A, B, C, D: ``scipy.signal.StateSpace(*model)`` and
    ``control.ss(*model)`` take it.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: tuple[str, ...]
    position: float
    pressure: Array
    left_out: tuple[str, ...]

    def __iter__(self) -> Iterator[Array]:
        """Return A, B, C and D in turn."""
        return iter((self.A, self.B, self.C, self.D))


def linearise(joint: Joint, pressure: ArrayLike) -> LinearModel:
    """Return the linear model of *joint* where it rests under *pressure* in gauge Pa.

    *pressure* is (muscles,), or one number for all. The model contains the muscles with their
    damping, the load, and the effects that have no memory, such as ``Payload``,
    ``ViscousFriction`` and ``Slack``. A ``PressureLag`` is a state with the mean of its time
    constants of filling and venting. Other effects with a memory, such as dry friction,
    hysteresis, creep and a dead time, have no linear model with few states: they are left out, and
    ``left_out`` names them.

    Raises RangeError if there is no equilibrium, and ParameterError for a joint with an onset, a
    pressure of another shape or one that is not finite. Warns of a pressure that seems to be in
    kPa or bar, or is far above p_max.
    """
    refuse_onsets(instance('joint', joint, Joint, 'a Joint'), 'linearise')
    p = one_each('pressure', pressure, len(joint.actuators), 'muscle')
    direct = joint.map_effects(lambda effects: [e for e in effects if not _has_memory(e)])
    lags = [_lag(joint, i) for i in range(len(p))]
    slow = [i for i, lag in enumerate(lags) if lag > 0.0]
    warn_of_unit('pressure', p, joint.muscles)
    s = rest_position(direct, p)
    if direct.active and not direct.is_driven:
        s = rest_from(direct, p, s)  # with offsets, slack and stops, also of one muscle on a mass
    stiffness, damping, gains, chambers = _slopes(direct, s, p)
    n = 2 + len(slow)
    a, b = np.zeros((n, n)), np.zeros((n, len(p)))
    a[0, 1], a[1, 0], a[1, 1] = 1.0, stiffness, damping
    for i in range(len(p)):
        if i in slow:
            k = 2 + slow.index(i)
            a[1, k] = gains[i] / chambers[i] if chambers[i] else 0.0
            a[k, k], b[k, i] = -1.0 / lags[i], chambers[i] / lags[i]
        else:
            b[1, i] = gains[i]
    c = np.zeros((1, n))
    c[0, 0] = 1.0
    kept = {e.name for e in direct.all_present} | ({'pressure_lag'} if slow else set())
    return LinearModel(
        a,
        b,
        c,
        np.zeros((1, len(p))),
        ('position', 'velocity', *(f'pressure_{i + 1}' for i in slow)),
        s,
        p,
        tuple(e.name for e in joint.all_present if e.name not in kept),
    )


def _has_memory(effect: Effect) -> bool:
    """Return whether the effect depends on the past, or on time.

    A hidden state in s is the length of the last step, which is no memory of the motion.
    """
    return (
        any(state.unit != 's' for state in effect.states)
        or effect.equations.delay is not None
        or effect.moves_by_itself
    )


def _lag(joint: Joint, muscle: int) -> float:
    """Return the time constant of the pressure in a muscle in s: the mean of both directions."""
    row = joint.parameters()[at.MUSCLE + muscle].tolist()
    for effect in joint.present[at.MUSCLE + muscle]:
        if effect.equations.chamber is not None:
            fill, vent, _ = effect.equations.chamber(row, joint.layout.parameter_at[effect.name])
            return 0.5 * float(fill + vent)
    return 0.0


def _slopes(
    joint: Joint, s: float, p: Array
) -> tuple[float, float, Sequence[float], Sequence[float]]:
    """Return the derivatives of s'' with respect to s, v and each command, at rest at s.

    The last ones are those of the pressure in each chamber with respect to its command.
    """
    acceleration = acceleration_of(joint)
    length = min(muscle.l0 for muscle in joint.muscles)
    arm = max(abs(float(statics.arm(joint, i, s))) for i in range(len(p)))
    ds = STEP * length / arm
    layout, q = joint.layout, joint.parameters()

    def chamber(commands: Array, i: int) -> float:
        return float(start_state(layout, q, commands, s, 0.0)[at.MUSCLE + i, at.P])

    gains, chambers = [], []
    for i, muscle in enumerate(joint.muscles):
        dp = np.zeros(len(p))
        dp[i] = STEP * muscle.p_max
        gains.append((acceleration(s, 0.0, p + dp) - acceleration(s, 0.0, p - dp)) / (2.0 * dp[i]))
        chambers.append((chamber(p + dp, i) - chamber(p - dp, i)) / (2.0 * dp[i]))
    return (
        (acceleration(s + ds, 0.0, p) - acceleration(s - ds, 0.0, p)) / (2.0 * ds),
        (acceleration(s, ds, p) - acceleration(s, -ds, p)) / (2.0 * ds),
        gains,
        chambers,
    )

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The longest step for a joint, from the range of its motion and the stiffness of its muscles."""

import itertools
import math
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig import layout as at
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint
from pam_ros.rig.start import start_state

Array = NDArray[np.float64]
BELOW, ABOVE = 0.3, 0.7  # contraction below and above the rated range that is examined
POINTS = 500
LONGEST_WITH_EFFECTS = 0.01  # s: end stops that are softened for longer steps are too soft to hold
FAST = 10.0  # m/s or rad/s, at which dry friction is negligible compared with a drag


def longest_step(joint: Joint) -> float:
    """Return the step in s in which the phase of the joint's fastest motion advances by 1 rad.

    The motion is fastest where the muscles are stiffest: within the permissible range of the
    joint, and at the positions that it reaches, undamped, after a release in this range. The
    integrator is stable to 2.6 rad, with critical damping to 1.3 rad. A known force instead of a
    muscle sets no limit. The drag of effects counts as damping; effects with memory have their own
    updates.
    """
    if joint.is_driven:
        k, cap = 0.0, math.inf
    elif statics.is_direct(joint):
        k, cap = _stiffest_of_one(joint), math.inf
    else:
        k, cap = _stiffest(joint), LONGEST_WITH_EFFECTS if joint.active else math.inf
    square = k / joint.inertia
    zeta = max(muscle.zeta for muscle in joint.muscles)
    decay = zeta * math.sqrt(square) + 0.5 * drag(joint) / joint.inertia
    fastest = max(math.sqrt(square), decay + math.sqrt(max(decay * decay - square, 0.0)))
    return min(1.0 / fastest if fastest > 0.0 else math.inf, cap)


def check_step(joint: Joint, step: float) -> None:
    """Raise ParameterError if *step* in s is not positive, or too long for the fastest motion."""
    if not step > 0.0:
        raise ParameterError(f'a physics step of {step:g} s is not allowed: give more than 0')
    for _, stage in joint.stages:
        longest = longest_step(stage)
        if step > longest:
            _refuse(stage, step, longest)


def _refuse(joint: Joint, step: float, longest: float) -> NoReturn:
    braking = drag(joint)
    if joint.is_revolute:
        moved, more = f'an inertia of {joint.inertia:g} kg m^2', 'inertia'
    else:
        moved, more = f'a mass of {joint.inertia:g} kg', 'mass'
    these = 'this muscle' if len(joint.muscles) == 1 else 'these muscles'
    unit = 'N m s/rad' if joint.is_revolute else 'N s/m'
    braked = f' with a drag of {braking:.4g} {unit}' if braking > 0.0 else ''
    # A motion can be so fast that no step resolves it.
    rate = 1.0 / longest if longest > 0.0 else math.inf
    steps = f'at least {math.ceil(rate)} steps a second, or ' if math.isfinite(rate) else ''
    raise ParameterError(
        f'a physics step of {step * 1e3:g} ms does not resolve {moved} on {these}{braked}: give '
        f'{steps}more {more}'
    )


def drag(joint: Joint) -> float:
    """Return the largest effort per velocity that effects add to the muscles' damping."""
    q, layout = joint.parameters(), joint.layout
    x = start_state(layout, q, [0.0] * len(joint.muscles), 0.0, 0.0)
    on_joint, *in_muscles = joint.present
    total = 0.0
    for i, (muscle, effects) in enumerate(zip(joint.muscles, in_muscles, strict=True)):
        most = 0.0
        for p, v in itertools.product((muscle.p_min, muscle.p_max), (-FAST, FAST)):
            c = 0.0
            for effect in effects:
                if effect.equations.damping is not None:
                    j = layout.parameter_at[effect.name]
                    c = float(effect.equations.damping(c, p, 0.0, v, q[at.MUSCLE + i], j))
            most = max(most, c)
        total += most * _longest_arm(joint, i) ** 2
    most = 0.0
    for v in (-FAST, FAST):
        f = 0.0
        for effect in on_joint:
            if effect.equations.outside is not None:
                i, j = layout.state_at[effect.name], layout.parameter_at[effect.name]
                row = x[at.JOINT]
                f = effect.equations.outside(
                    f, 0.0, 0.0, v, 0.0, 0.0, row, i, row.copy(), q[at.JOINT], j
                )
        most = max(most, -float(f) / v)
    return total + most


def _longest_arm(joint: Joint, i: int) -> float:
    """Return the largest absolute arm of muscle i within the permissible range of the joint."""
    if statics.is_direct(joint):
        return 1.0
    return float(np.max(np.abs(statics.arm(joint, i, np.linspace(*statics.span(joint), POINTS)))))


# One muscle on a mass --------------------------------------------------------------------------


def _stiffest_of_one(joint: Joint) -> float:
    """Return the largest stiffness in N/m of one muscle, from kappa_max to the end of a fall."""
    muscle = joint.muscle
    lowest = _deepest(muscle, float(statics.weight(joint, 0.0)))
    p, kappa = np.meshgrid((muscle.p_min, muscle.p_max), (lowest, muscle.kappa_max))
    return float(np.max(muscle.stiffness(p, kappa)))  # the largest is at a corner, as the least is


def _deepest(muscle: Muscle, weight: float) -> float:
    """Return the least contraction of an undamped fall from kappa_max at p_min."""
    kappa = np.linspace(muscle.kappa_max, muscle.kappa_min - BELOW, POINTS)
    energy = weight * muscle.l0 * kappa - muscle.potential(muscle.p_min, kappa)
    landed = (energy >= energy[0]) & (kappa < muscle.kappa_min)
    return float(kappa[np.argmax(landed)]) if np.any(landed) else float(kappa[-1])


# Several muscles -------------------------------------------------------------------------------


def _stiffest(joint: Joint) -> float:
    """Return the largest stiffness within the joint's travel and the range that it swings to."""
    s = np.linspace(*statics.span(joint, BELOW, ABOVE), POINTS)
    far = np.zeros(POINTS, dtype=bool)
    k = np.zeros(POINTS)
    for p in itertools.product(*((m.p_min, m.p_max) for m in joint.muscles)):
        far |= _swung(joint, s, statics.effort(joint, p, s))
        far |= _swung(joint, s, statics.pull(joint, p, s))
        k = np.maximum(k, statics.stiffness(joint, p, s))
    return float(np.max(k[far]))


def _swung(joint: Joint, s: Array, effort: Array) -> NDArray[np.bool_]:
    """Return which of the coordinates s are reached from a rest within the joint's travel."""
    net = effort - statics.weight(joint, s)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (net[1:] + net[:-1]) * np.diff(s))])
    low, high = statics.span(joint)
    inside = np.flatnonzero((s >= low) & (s <= high))
    first, last = int(inside[0]), int(inside[-1])
    # Released at rest, the joint has only its potential energy: the negative of the work up to
    # the point of release.
    least = float(np.min(work[inside]))
    reached = np.zeros(len(s), dtype=bool)
    reached[first : last + 1] = True
    above = np.flatnonzero(work[last:] < least)
    reached[last : last + int(above[0]) + 1 if above.size else None] = True
    below = np.flatnonzero(work[: first + 1] < least)
    reached[int(below[-1]) if below.size else 0 : first] = True
    return reached

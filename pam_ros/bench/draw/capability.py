# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the muscles of a joint can do: where they hold the load, and which motions they follow.

All of it is on the safe side: friction and hysteresis are assumed to act in the direction in which
they hinder, and a reserve of the range of pressure is left at both ends.
"""

from collections.abc import Mapping, Sequence
from math import hypot

import numpy as np
from numpy.typing import NDArray

from pam_ros.rig import statics
from pam_ros.rig.joint import Actuator, Joint

Array = NDArray[np.float64]
PLACES = 121  # coordinates at which it is tested whether the load can be held
INSIDE = 0.005  # contraction that is left at both ends of the permissible range
RATED = 0.8  # share of the rated force that a load may need
DIP = 0.3  # share of the range of pressure by which muscles fill at once from a reservoir
SWING = 0.1  # contraction of a quick motion, which a creeping stiffness resists
FAST = 0.7  # share of the fastest change of pressure that a motion may need
Values = Mapping[str, Mapping[str, float]]


def _of(effects: Values, effect: str, parameter: str) -> float:
    """Return the value of a parameter, 0 for an absent effect."""
    return effects.get(effect, {}).get(parameter, 0.0)


def _chamber(effects: Values, command: float) -> float:
    """Return the pressure in Pa that a muscle with *effects* has with a constant *command*."""
    gain, offset = (_of(effects, 'pressure_offset', name) for name in ('gain', 'offset'))
    valve = max((1.0 + gain) * command + offset, 0.0)
    kept = 1.0 + _of(effects, 'leak', 'rate') * _of(effects, 'leak', 'refill')
    return max(valve - _of(effects, 'dead_band', 'band'), 0.0) / kept


class Capability:
    """The efforts that the muscles of a *joint* can give, N or N m.

    *reserve* is the share of the range of pressure that is left at both ends. A muscle pulls only.
    """

    def __init__(self, joint: Joint, reserve: float) -> None:
        """Take the effects of the joint into account, each with its worst influence."""
        self._joint, self._reserve = joint, reserve
        self._effects: Values = {one.name: one.values for one in joint.effects}
        self._muscles: Sequence[Values] = [
            {one.name: one.values for one in actuator.effects} for actuator in joint.actuators
        ]

    def efforts(self, s: Array) -> tuple[Array, Array]:
        """Return the least and the greatest effort at the coordinates *s*, in their shape."""
        low, high = np.zeros(np.shape(s)), np.zeros(np.shape(s))
        for i, actuator in enumerate(self._joint.actuators):
            least, most = self._forces(i, actuator, s)
            arm = statics.arm(self._joint, i, s) + 0.0 * s
            low += np.where(arm > 0.0, arm * least, arm * most)
            high += np.where(arm > 0.0, arm * most, arm * least)
        rub = max(_of(self._effects, 'coulomb_friction', name) for name in ('level', 'breakaway'))
        return low + rub, high - rub

    def _forces(self, i: int, actuator: Actuator, s: Array) -> tuple[Array, Array]:
        """Return the least and the greatest force of muscle i in N."""
        muscle, effects = actuator.muscle, self._muscles[i]
        kappa = statics.contraction(self._joint, i, s) + _of(effects, 'length_offset', 'offset')
        low, high = self._pressures(i, actuator)
        creeps = abs(_of(effects, 'creep', 'force')) + abs(_of(effects, 'creep', 'pressure'))
        kept = 1.0 - max(_of(effects, 'softening', 'limit'), 0.0) - creeps
        unsure = (
            _of(effects, 'hysteresis', 'amplitude')
            + _of(effects, 'hysteresis', 'slip')
            + _of(effects, 'pressure_hysteresis', 'slip') * muscle.gain(kappa)
            + SWING * _of(effects, 'creep', 'stiffness')
            + hypot(
                _of(effects, 'periodic_disturbance', 'force_sin'),
                _of(effects, 'periodic_disturbance', 'force_cos'),
            )
        )
        least = (1.0 + creeps) * np.maximum(muscle.force(low, kappa), 0.0) + unsure
        most = kept * muscle.force(high, kappa) - unsure
        return least, np.minimum(np.maximum(most, 0.0), RATED * muscle.force_max)

    def _pressures(self, i: int, actuator: Actuator) -> tuple[float, float]:
        """Return the lowest and the highest pressure in the chamber of muscle i in Pa."""
        muscle, effects = actuator.muscle, self._muscles[i]
        range_ = muscle.p_max - muscle.p_min
        low, high = muscle.p_min + self._reserve * range_, muscle.p_max - self._reserve * range_
        if share := _of(self._effects, 'supply', 'share'):
            dip = DIP * share * range_ * len(self._muscles)
            high = min(high, _of(self._effects, 'supply', 'level') - dip)
        ripple = hypot(
            _of(effects, 'periodic_disturbance', 'pressure_sin'),
            _of(effects, 'periodic_disturbance', 'pressure_cos'),
        )
        return _chamber(effects, low) + ripple, _chamber(effects, high) - ripple

    def reach(self) -> tuple[float, float] | None:
        """Return the longest range of the coordinate in which the load can be held, or None."""
        s = np.linspace(*statics.span(self._joint, -INSIDE, -INSIDE), PLACES)
        low, high = self.efforts(s)
        needed = statics.weight(self._joint, s)
        holds = (low <= needed) & (needed <= high) & self._is_off_the_pads(s)
        ends = np.flatnonzero(np.diff(np.concatenate([[0], holds.astype(int), [0]])))
        runs = [(int(a), int(b) - 1) for a, b in zip(ends[::2], ends[1::2], strict=True)]
        if not runs:
            return None
        first, last = max(runs, key=lambda run: run[1] - run[0])
        return float(s[first]), float(s[last])

    def _is_off_the_pads(self, s: Array) -> NDArray[np.bool_]:
        length = 1.0 if self._joint.is_revolute else self._joint.muscles[0].l0
        free = np.ones(np.shape(s), dtype=bool)
        if _of(self._effects, 'end_stop', 'stiffness'):
            free &= s <= length * _of(self._effects, 'end_stop', 'upper')
        if _of(self._effects, 'end_stop', 'lower_stiffness'):
            free &= s >= length * _of(self._effects, 'end_stop', 'lower')
        return free

    def follows(self, s: Array, period: float, pressures: Sequence[float]) -> bool:
        """Return whether the muscles can follow the motion *s* (n,), a sample each *period* s.

        *pressures* are mean ones in Pa. The command leads the pressure by the lag of the valve.
        """
        joint = self._joint
        v = np.gradient(s, period)
        needed = joint.inertia * np.gradient(v, period) + statics.weight(joint, s)
        needed += self._damping(pressures, s) * v
        stiff = statics.stiffness(joint, pressures, s)
        faster = np.gradient(needed, period) + stiff * v  # rate of the effort of the pressures
        led = needed + self._lag() * faster
        low, high = self.efforts(s)
        gain = sum(
            np.abs(statics.arm(joint, i, s)) * muscle.gain(statics.contraction(joint, i, s))
            for i, muscle in enumerate(joint.muscles)
        )
        rates = np.abs(faster) / gain
        return bool(
            np.all((low <= led) & (led <= high) & (low <= needed) & (needed <= high))
            and np.all(rates <= FAST * self._fastest())
        )

    def _damping(self, pressures: Sequence[float], s: Array) -> Array:
        """Return the damping of the joint along *s*, N s/m or N m s/rad."""
        joint, count = self._joint, len(self._muscles)
        total = np.full(np.shape(s), _of(self._effects, 'viscous_friction', 'coefficient'))
        for i, (muscle, p) in enumerate(zip(joint.muscles, pressures, strict=True)):
            square = statics.arm(joint, i, s) ** 2
            c = muscle.damping(p, statics.contraction(joint, i, s), joint.inertia / count / square)
            rates = self._muscles[i].get('pressure_dependent_damping', {}).values()
            total += square * (c + p * max(rates, default=0.0))
        return total

    def _lag(self) -> float:
        return max(
            max(_of(one, 'pressure_lag', 'fill'), _of(one, 'pressure_lag', 'vent'))
            + max(_of(one, 'leak', 'refill'), _of(one, 'leak', 'vent'))
            for one in self._muscles
        )

    def _fastest(self) -> float:
        found = [np.inf]
        for one in self._muscles:
            lag, leak = one.get('pressure_lag', {}), one.get('leak', {})
            found += [lag.get('fastest', np.inf), lag.get('fastest_vent', np.inf)]
            found += [leak.get('supply', np.inf), leak.get('exhaust', np.inf)]
        return min(found)

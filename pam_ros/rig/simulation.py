# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Joints that are advanced in time, for the simulator node and for the tests of controllers."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from operator import index
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pam_ros.arguments import number, one_each, refuse, sequence
from pam_ros.errors import ParameterError
from pam_ros.rig import layout as at
from pam_ros.rig.equilibrium import rest_position
from pam_ros.rig.group import Group
from pam_ros.rig.joint import Joint
from pam_ros.rig.layout import Layout
from pam_ros.rig.statics import refuse_position
from pam_ros.rig.step_limit import check_step

Array = NDArray[np.float64]


class MuscleOutputs(NamedTuple):
    """Outputs of the muscles, each (muscles,), in the order of joints and of muscles within them.

    ``force`` is the pulling force in N, effects included, without the damping; ``stiffness`` is
    in N/m, ``damping`` in N s/m; ``acceleration`` is that of the muscle's end in m/s^2.
    """

    force: Array
    stiffness: Array
    damping: Array
    acceleration: Array


class JointOutputs(NamedTuple):
    """Outputs of the joints, each (joints,), in N and m, or N m and rad for a revolute joint.

    ``effort`` in N or N m is that of the muscles, effects included, without their damping;
    ``stiffness`` in N/m or N m/rad is that of the muscles, without gravity; ``acceleration`` is in
    m/s^2 or rad/s^2.
    """

    effort: Array
    stiffness: Array
    acceleration: Array


class Simulation:
    """One or more joints with their muscles, advanced together with a fixed step.

    All quantities are arrays. Position m and velocity m/s (contraction positive), or rad and rad/s
    for a revolute joint, have one entry for each joint, in the order of *joints*. Pressure Pa
    gauge in the chamber, force N (pulling), stiffness N/m and damping N s/m have one entry for
    each muscle, in the order of joints and of muscles within them. Steps are counted, so time is
    exact. The same joints, start and commands give bitwise equal results, for any number of steps
    per call.

    *step* is in s. Raises ParameterError if it is too long for one of the joints. All methods
    raise ParameterError for shapes that do not fit and numbers that are not finite.
    """

    def __init__(self, joints: Sequence[Joint], step: float = 1e-3) -> None:
        """Start at rest at 0 Pa; see :meth:`reset` to start elsewhere."""
        self.step = step = number('step', step)
        self.joints = joints = _joints(joints)
        for joint in joints:
            check_step(joint, step)
        # Consecutive joints of one kind are advanced in one call.
        self._groups = [Group(tuple(alike), step) for _, alike in groupby(joints, _kind)]
        self._k = 0
        self._has_looked = False  # whether the outputs of the present state are known
        # For each muscle: its group, the number of its joint there, and its number in the joint.
        self._muscles = [
            (group, a, i)
            for group in self._groups
            for a in range(len(group.joints))
            for i in range(group.muscles)
        ]
        self.reset(
            np.zeros(len(self._muscles)),
            [rest_position(joint.at_start, 0.0) for joint in joints],
            0.0,
        )

    def prepare(self) -> None:
        """Load all machine code that these joints and any :meth:`change` of them can need.

        Code that is not on disk is compiled, which takes many seconds; afterwards neither
        :meth:`advance` nor :meth:`muscle_outputs` waits for it.
        """
        for group in self._groups:
            group.prepare()
        self._has_looked = False

    def change(self, joints: Sequence[Joint]) -> None:
        """Continue from the present state with other parameters; after an error with the old ones.

        Hidden states are kept. An effect that was absent begins to act, with its memory at rest at
        the present position, and without a jump of pressure or position. Raises ParameterError for
        joints of other kinds: create a new Simulation for those.
        """
        joints = _joints(joints)
        for joint in joints:
            check_step(joint, self.step)
        if [_kind(joint) for joint in joints] != [_kind(joint) for joint in self.joints]:
            raise ParameterError(
                'a simulation keeps the kinds of its joints: make a new Simulation for others'
            )
        self.joints = joints
        left = iter(joints)
        for group in self._groups:
            group.change([next(left) for _ in group.joints], self._k)
        self._has_looked = False

    def reset(self, pressure: ArrayLike, position: ArrayLike, velocity: ArrayLike) -> None:
        """Set time to 0 and the state to these values, as after a long rest at *pressure*.

        *pressure* (muscles,) in gauge Pa is also the present command; delayed commands are
        discarded. *position* and *velocity* are (joints,), in m and m/s, or rad and rad/s for a
        revolute joint. One number sets all entries, in each of the three. Raises ParameterError
        for a position that the muscles of its joint cannot have.
        """
        p = one_each('pressure', pressure, len(self._muscles), 'muscle')
        s = one_each('position', position, len(self.joints), 'joint')
        v = one_each('velocity', velocity, len(self.joints), 'joint')
        for joint, start in zip(self.joints, s.tolist(), strict=True):
            refuse_position('position', start, joint)
        self._k = a = m = 0
        for group in self._groups:
            n = len(group.joints)
            pressures = p[m : m + n * group.muscles].reshape(n, group.muscles)
            group.reset(pressures, s[a : a + n], v[a : a + n])
            a, m = a + n, m + n * group.muscles
        self._has_looked = False

    def command(self, pressure: ArrayLike) -> None:
        """Command these gauge pressures in Pa, (muscles,) or one number for all, from now on."""
        values = one_each('pressure', pressure, len(self._muscles), 'muscle')
        for (group, a, i), value in zip(self._muscles, values.tolist(), strict=True):
            group.command(a, i, self.time, value)

    def command_one(self, muscle: int, pressure: float) -> None:
        """Command the gauge pressure of one muscle in Pa from now on; the others keep theirs.

        Muscles are counted from 0, in the order of joints and of muscles within them.
        """
        if not 0 <= _whole('muscle', muscle) < len(self._muscles):
            refuse('muscle', muscle, f'a whole number, 0 to {len(self._muscles) - 1}')
        group, a, i = self._muscles[muscle]
        group.command(a, i, self.time, number('pressure', pressure))

    def advance(self, steps: int = 1) -> None:
        """Advance all joints by *steps* steps, a whole number that is not negative."""
        steps = _whole('steps', steps)
        if steps < 0:
            refuse('steps', steps, 'a whole number, at least 0')
        for group in self._groups:
            group.advance(self._k, steps)
        self._k += steps
        self._has_looked = False

    @property
    def time(self) -> float:
        """Simulated time in s since the last reset."""
        return self._k * self.step

    @property
    def position(self) -> Array:
        """Position in m, contraction positive, or angle in rad (joints,)."""
        return _joined([group.s for group in self._groups])

    @property
    def velocity(self) -> Array:
        """Velocity in m/s or rad/s (joints,)."""
        return _joined([group.v for group in self._groups])

    @property
    def contraction(self) -> Array:
        """Contraction as a fraction of the length at rest (muscles,)."""
        self._look()
        found: Array = self._out[at.CONTRACTION].copy()
        return found

    @property
    def pressure(self) -> Array:
        """Gauge pressure in the chamber in Pa (muscles,)."""
        return _joined([group.p.ravel() for group in self._groups])

    def muscle_outputs(self) -> MuscleOutputs:
        """Return force, stiffness, damping and acceleration of each muscle."""
        self._look()
        return MuscleOutputs(*self._out[: at.CONTRACTION].copy())

    def joint_outputs(self) -> JointOutputs:
        """Return effort, stiffness and acceleration of each joint."""
        self._look()
        return JointOutputs(*_joined([group.joint_out for group in self._groups]).T)

    def _look(self) -> None:
        if not self._has_looked:
            for group in self._groups:
                group.look(self.time)
            out = [group.out.reshape(-1, at.OUTPUTS) for group in self._groups]
            self._out: Array = _joined(out).T
            self._has_looked = True


def _joints(given: Sequence[Joint]) -> tuple[Joint, ...]:
    joints = sequence('joints', given, Joint, 'a Joint')
    if not joints:
        raise ParameterError('joints is empty: give at least one Joint')
    return joints


def _whole(name: str, value: int) -> int:
    try:
        return index(value)
    except TypeError:
        refuse(name, value, 'a whole number')


def _kind(joint: Joint) -> Layout:
    return joint.layout


def _joined(parts: list[Array]) -> Array:
    return parts[0].copy() if len(parts) == 1 else np.concatenate(parts)

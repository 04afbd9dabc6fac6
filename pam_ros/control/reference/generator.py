# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The reference of a joint for programs that step a control law themselves."""

from __future__ import annotations

from math import isfinite

import numpy as np
from numpy.typing import ArrayLike

from pam_ros.arguments import along, instance, number, refuse, stamps
from pam_ros.control.allocation import allocation_of
from pam_ros.control.limits import Limits
from pam_ros.control.model import ControlModel
from pam_ros.control.reference.points import Points
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import INSTANT, ReferenceSource
from pam_ros.control.signals import Reference, start_arguments
from pam_ros.rig.joint import Joint


class ReferenceGenerator:
    """Makes a smooth reference from target positions and trajectories, as ``pam_control`` does.

    A target that jumps is approached within the bounds of *shape*; a target that moves smoothly
    from call to call is followed without lag. ``reach`` has the lowest and the highest position
    at which the muscles can hold the load within *limits*. Positions are in m, contraction
    positive, or in rad for a revolute joint. All methods raise ParameterError for numbers that
    are not finite.
    """

    def __init__(
        self, joint: Joint, shape: Shape | None = None, limits: Limits | None = None
    ) -> None:
        """Make it for *joint*, at rest in the middle of its reach; see :meth:`start`.

        Raises ParameterError for a shape of the other kind of joint (``Shape.for_joint``).
        """
        instance('joint', joint, Joint, 'a Joint')
        shape = Shape.for_joint(joint) if shape is None else shape
        limits = Limits() if limits is None else limits
        instance('shape', shape, Shape, 'a Shape')
        instance('limits', limits, Limits, 'Limits')
        self._joint = joint
        self.reach = allocation_of(ControlModel(joint), limits).reach
        self._source = ReferenceSource(shape, self.reach, joint.transmission.equations.unit)
        low, high = self.reach
        self.start(0.5 * (low + high) if isfinite(low) and isfinite(high) else 0.0)

    def start(self, position: float) -> None:
        """Begin at rest at *position*, without a target.

        The position may be out of reach, as that of a load that rests there is. Raises
        ParameterError if it is far from those that the muscles can have, as laws do.
        """
        start_arguments(self._joint, position, None)
        self._source.start(float(position))
        # As in pam_control, time passes between a start and a target.
        self._source.follow(INSTANT)

    def set_target(self, position: float) -> None:
        """Approach *position*; a trajectory ends here. Raises RangeError out of reach."""
        self._source.set_target(number('position', position))

    def set_trajectory(
        self,
        t: ArrayLike,
        position: ArrayLike,
        velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
    ) -> None:
        """Follow a trajectory through points, starting from the present reference.

        *t* (n,) in s from now on, ascending; *position*, *velocity* and *acceleration* (n,) at
        these times. With velocities and accelerations the motion between two points is a
        polynomial of fifth order, with velocities alone of third order, and with positions alone
        a cubic spline that is at rest at both ends. The last position is held. Raises RangeError
        for a motion out of reach, and ParameterError if the sizes of the arrays differ; then the
        former target remains.
        """
        times = stamps('t', t, strict=True)
        if acceleration is not None and velocity is None:
            refuse('velocity', velocity, 'one for each stamp of t, as there are accelerations')
        n = times.size
        points = Points(
            times,
            along('position', position, 't', n),
            np.zeros(n) if velocity is None else along('velocity', velocity, 't', n),
            np.zeros(n) if acceleration is None else along('acceleration', acceleration, 't', n),
            has_velocity=np.full(n, velocity is not None),
            has_acceleration=np.full(n, acceleration is not None),
        )
        self._source.play(points)

    def update(self, dt: float) -> Reference:
        """Return the reference *dt* s after the last call.

        It has the position in m (rad for a revolute joint) and its first three derivatives. Raises
        ParameterError if *dt* is not above 0.
        """
        if number('dt', dt) <= 0.0:
            refuse('dt', dt, 'a finite time above 0 s')
        return self._source.follow(dt)

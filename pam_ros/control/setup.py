# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Makes a position law and its reference generator from a joint, gains and limits."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite, nan

import numpy as np

from pam_ros.cached_property import cached_property
from pam_ros.control.allocation import Allocation, allocation_of
from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.gains import Gains
from pam_ros.control.limits import Limits
from pam_ros.control.loop import Loop, warm_up
from pam_ros.control.model import ControlModel
from pam_ros.control.pid import Pid, PidGains
from pam_ros.control.plausibility import Plausibility, bounds_of
from pam_ros.control.pressure_path import PressurePath
from pam_ros.control.reference.shaping import Shape
from pam_ros.control.reference.source import ReferenceSource
from pam_ros.control.signals import PositionLaw, Pressures, Reference
from pam_ros.control.sliding_mode import SlidingMode
from pam_ros.errors import ParameterError
from pam_ros.rig.joint import Joint

TRIALS = 3  # updates of a law, after which its command must be finite


@dataclass(frozen=True)
class LawSetup:
    """A joint and the law that controls it, checked against each other.

    ``controller`` is ``sliding_mode`` with its ``gains``, or ``pid`` with ``pid``; both have the
    same ``limits`` and ``co_contraction``. ``shape`` is that of the references. The law is called
    every ``period`` s. Raises ParameterError if gains do not fit the joint or the period, or if
    the law gives no finite pressure.
    """

    controller: str
    joint: Joint
    gains: Gains
    pid: PidGains
    limits: Limits
    shape: Shape
    co_contraction: CoContraction
    period: float

    def __post_init__(self) -> None:
        """Check the gains, the desired co-contraction, and the first commands of the law."""
        self.gains.check(self._allocation, self.period)
        self.co_contraction.wanted(self._allocation)
        self._check_law()

    @cached_property
    def _allocation(self) -> Allocation:
        return allocation_of(ControlModel(self.joint), self.limits)

    @property
    def reach(self) -> tuple[float, float]:
        """The range of the coordinate in which the load can be held, m or rad."""
        return self._allocation.reach

    @property
    def can_stiffen(self) -> bool:
        """Whether the stiffness can be chosen in addition to the position."""
        return self._allocation.can_stiffen

    @property
    def unit(self) -> str:
        """Unit of the coordinate."""
        return self.joint.transmission.equations.unit

    def make_law(self) -> PositionLaw:
        """Return a new law, which must be started before use."""
        if self.controller == 'pid':
            return Pid(self.joint, self.pid, self.limits, self.co_contraction)
        return SlidingMode(self.joint, self.gains, self.limits, self.co_contraction)

    def make_reference_source(self) -> ReferenceSource:
        """Return a new reference generator, which must be started before use."""
        return ReferenceSource(self.shape, self.reach, self.unit)

    def make_loop(self) -> Loop:
        """Return a new loop of this law, which waits for a first measurement.

        All that it needs is compiled, so that its first steps are as short as the later ones.
        """
        law = self._make_warm_law()
        plausibility = Plausibility(bounds_of(law.allocation))
        return Loop(law, self.make_reference_source(), self.period, plausibility)

    def _make_warm_law(self) -> PositionLaw:
        law = self.make_law()
        warm_up(law, self.reach, self.period)
        return law

    def _check_law(self) -> None:
        """Raise ParameterError if the law cannot be created, or if its command is not finite.

        Each parameter can be within its range while the combination of them overflows.
        """
        low, high = self.reach
        middle = 0.5 * (low + high) if isfinite(low) and isfinite(high) else 0.0
        law = self.make_law()
        try:
            with np.errstate(all='ignore'):
                law.start(middle)
                for _ in range(TRIALS):
                    command = law.update(self.period, Reference(middle), middle)
        except ArithmeticError:
            command = (nan,)
        if not all(map(isfinite, command)):
            raise ParameterError(
                'the law gives no finite pressure with these parameters: one of them is too large '
                'or too close to 0, such as the mass or inertia of the load'
            )

    def command_at(self, chambers: Sequence[float]) -> Pressures:
        """Return the commands in Pa at which the chambers stay at these gauge pressures in Pa."""
        return tuple(
            path.command_at_rest(chamber)
            for path, chamber in zip(self._paths, chambers, strict=True)
        )

    @cached_property
    def _paths(self) -> tuple[PressurePath, ...]:
        return tuple(PressurePath(self.joint, i, 1.0) for i in range(len(self.joint.muscles)))

    def change_loop(self, loop: Loop, before: 'LawSetup') -> str:
        """Let *loop*, created by *before*, continue with this setup.

        Return a sentence if the present reference is out of the new reach, else ''.
        """
        loop.period = self.period
        if not self.needs_new_law(before):
            self.take_over(loop.law, before)
            loop.source.set_shape(self.shape)
            return ''
        law = self._make_warm_law()
        sentence = loop.change(law, self.make_reference_source())
        loop.plausibility.bounds = bounds_of(law.allocation)
        return sentence

    def take_over(self, law: PositionLaw, before: 'LawSetup') -> None:
        """Let *law*, created by *before*, continue with the gains and stiffness of this setup."""
        if not isinstance(law, SlidingMode):
            return
        if self.gains != before.gains:
            law.set_gains(self.gains)
        if self.co_contraction != before.co_contraction:
            law.set_co_contraction(self.co_contraction)

    def needs_new_law(self, before: 'LawSetup') -> bool:
        """Return whether the changes since *before* cannot be applied to a running law."""
        is_pid = self.controller == 'pid'
        return (self.controller, self.joint, self.pid, self.limits) != (
            *(before.controller, before.joint, before.pid, before.limits),
        ) or (is_pid and self.co_contraction != before.co_contraction)

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A PID law with the interface of the sliding-mode law, for comparison."""

from dataclasses import dataclass
from math import exp

from pam_ros.arguments import instance
from pam_ros.control.co_contraction import CoContraction
from pam_ros.control.joint_settings import JointSettings
from pam_ros.control.law import JointLaw
from pam_ros.control.limits import Limits
from pam_ros.control.pid_schedule import Schedule
from pam_ros.control.signals import (
    Pressures,
    Reference,
    Terms,
    start_arguments,
    step_arguments,
)
from pam_ros.parameters import OnRevolute, parameter_field
from pam_ros.rig.joint import Joint


@dataclass(frozen=True)
class PidGains(JointSettings):
    """Gains of the PID law.

    The defaults are the best single set for all rigs of ``benchmarks/control.py`` with an
    unmodelled lag or load. They were found by differential evolution: the gains with the least
    integral of the absolute error after a load of 50 N, at the worst position from 45 to 85 mm,

    - with a largest sensitivity of 1.6 at most on the nominal rig, at each position, and of 2.0
      with 5 kg more, with a lag of 60 ms, and with both and 10 ms of dead time (Astrom &
      Hagglund, Advanced PID Control, 2006: 1.2 to 2.0),
    - and with 400 Pa of noise in the pressure at most, for 20 um in the position at 500 Hz.

    Gains for the nominal rig alone have a third of these errors there, and are unstable with the
    lag.

    The defaults of a revolute joint are found by the same rule for the pair of
    ``benchmarks/pair_control.py`` (two muscles of 400 mm on a pulley of 40 mm, 1 kg on an arm of
    250 mm). They have the least error after a torque of 2 N m, which is 50 N at the radius, at the
    worst angle from 0 to 0.8 rad, the largest angle at which the default stiffness is possible.
    The bounds of the sensitivity are the same, with 0.3 kg more instead of 5 kg; the noise is 400
    Pa in each pressure for 0.02 degrees in the angle. Their largest sensitivity is 1.15 on the
    nominal pair: the lag and the noise limit these gains.
    """

    proportional: float = parameter_field(
        0.82e6,
        'pressure per error',
        'Pa/m',
        low=0.0,
        high=1e9,
        revolute=OnRevolute(49.1e3, 1e9),
    )
    integral: float = parameter_field(
        39e6,
        'rate of pressure per error',
        'Pa/(m s)',
        low=0.0,
        high=1e10,
        revolute=OnRevolute(1.91e6, 1e10),
    )
    derivative: float = parameter_field(
        194e3,
        'pressure per rate of the error',
        'Pa s/m',
        low=0.0,
        high=1e9,
        revolute=OnRevolute(9.09e3, 1e9),
    )
    filter_bandwidth: float = parameter_field(
        282.0,
        'bandwidth of the filter of the measured position',
        'rad/s',
        low=1.0,
        high=1e4,
        revolute=OnRevolute(326.0, 1e4),
    )
    bounded: bool = parameter_field(
        True,
        'whether the gains are reduced at references at which the sensitivity of the nominal '
        'joint would exceed the bounds by which the defaults were found',
    )


class Pid(JointLaw):
    """PID on the error, added to the pressures that hold the load at the reference.

    The error is filtered twice at the same bandwidth, to keep noise out of its derivative. The
    static part comes from the same model as that of the sliding-mode law: without it a PID cannot
    follow the nonlinear curve of a muscle. For antagonistic muscles the output is added to one
    side and subtracted from the other, and the stiffness is that of the static part.
    """

    gains: PidGains

    def __init__(
        self,
        joint: Joint,
        gains: PidGains | None = None,
        limits: Limits | None = None,
        co_contraction: CoContraction | None = None,
    ) -> None:
        """Take the nominal joint; only its effects without an onset are used.

        Raises ParameterError if the gains are for the other kind of joint, or if some place of
        the reach has no stable share of the gains.
        """
        gains = PidGains.for_joint(joint) if gains is None else gains
        self.gains = instance('gains', gains, PidGains, 'PidGains')
        super().__init__(joint, gains, limits, co_contraction, 1.0)
        self._stiffness = self._co_contraction.wanted(self.allocation)
        self._schedule = (
            Schedule(
                self.allocation,
                (gains.proportional, gains.integral, gains.derivative, gains.filter_bandwidth),
                self._stiffness,
            )
            if gains.bounded
            else None
        )
        self.start(0.0)

    def _signs(self, position: float) -> list[float]:
        return [1.0 if gain > 0.0 else -1.0 for gain in self.allocation.gains(position)]

    @property
    def learned(self) -> None:
        """Nothing: this law does not learn."""

    def stiffen(self, stiffness: float) -> None:
        """Set the *stiffness* that the muscles give the joint, in N/m or N m/rad.

        Raises RangeError if it is not possible at the present reference, or with these gains.
        """
        self.allocation.refuse_stiffness(stiffness, self.terms.reference)
        if self._schedule is not None:
            self._schedule.refuse_stiffness(stiffness)
        self._stiffness = stiffness

    def start(self, position: float, pressures: Pressures | None = None) -> None:
        """Start again at rest at *position*, under commands of *pressures* Pa if they are known.

        Raises ParameterError as :meth:`pam_ros.control.signals.PositionLaw.start`.
        """
        start_arguments(self.joint, position, pressures)
        static, signs = self._at_rest(position, self._stiffness), self._signs(position)
        for limiter, pressure in zip(self._limiters, pressures or static, strict=True):
            limiter.start(pressure)
        commands = self._commands
        before = sum(
            sign * (command - pressure)
            for sign, command, pressure in zip(signs, commands, static, strict=True)
        ) / len(signs)
        self._error = self._filtered = 0.0
        self._has_rate = False
        self._seen, self._waited, self._output = position, 0.0, before
        self._parts = 0.0, before, 0.0  # proportional, integral, derivative
        self.terms = Terms(reference=position, position=position)
        self._note(commands)

    def update(
        self,
        dt: float,
        reference: Reference,
        position: float | None,
        velocity: float | None = None,
        age: float = 0.0,
    ) -> Pressures:
        """Return the gauge pressures in Pa to command from now on, (muscles,).

        *dt* is the time since the last call in s. *reference* and *position* are in m, or rad for
        a revolute joint; the position is None without a new measurement. Neither *velocity* nor
        the *age* of the measurement is used.

        Without a new measurement the static part follows the reference, and the output of the PID
        is kept: the reference minus an old position is not an error. For numbers that are not
        finite see :meth:`pam_ros.control.signals.PositionLaw.update`.
        """
        position, _ = step_arguments(self.joint, dt, reference, position, velocity, age)
        self._waited += dt
        static = self._at_rest(reference.position, self._stiffness)
        gains = self.allocation.gains(reference.position)
        signs = self._signs(reference.position)
        if position is not None:
            room = self._room(reference.position, static, signs)
            self._correct(reference.position, position, *room)
        output = self._output
        p, i, d = self._parts
        commands, cut = [], 0.0
        for limiter, sign, pressure, gain in zip(
            self._limiters, signs, static, gains, strict=True
        ):
            commands.append(limiter.limit(pressure + sign * output, dt))
            cut += gain * (pressure + sign * (p + i + d) - commands[-1])
        gain = sum(map(abs, gains))
        self.terms = Terms(
            reference=reference.position,
            speed=reference.velocity,
            position=self._seen,
            error=reference.position - self._seen,
            equivalent=sum(g * pressure for g, pressure in zip(gains, static, strict=True)),
            switching=gain * (p + d),
            observer=gain * i,
            cut=cut,
        )
        self._note(tuple(commands))
        return self.terms.pressures

    def _correct(self, reference: float, position: float, low: float, high: float) -> None:
        """Take in a measured *position*, with the time since the last one.

        The output and its integral part stay from *low* to *high*: what the limits of pressure
        leave to them.
        """
        dt, self._waited = self._waited, 0.0
        self._seen = position
        share = 1.0 - exp(-self.gains.filter_bandwidth * dt)
        self._error += share * (reference - position - self._error)
        before = self._filtered
        self._filtered += share * (self._error - self._filtered)
        of_all, of_integral = 1.0, 1.0
        if self._schedule is not None:
            of_all, of_integral = self._schedule.at(reference, self._stiffness)
        gains, error = self.gains, self._filtered
        p = of_all * gains.proportional * error
        i = min(max(self._parts[1], low), high)
        i = min(max(i + of_all * of_integral * gains.integral * error * dt, low), high)
        # The first position has no rate: the joint may have moved since the law was started.
        d = of_all * gains.derivative * (error - before) / dt if self._has_rate else 0.0
        self._has_rate = True
        self._parts = p, i, d
        self._output = min(max(p + i + d, low), high)

    def _note(self, commands: Pressures) -> None:
        """Set the terms of the *commands*, and of the stiffness when the pressures follow."""
        chambers: Pressures = ()
        if self.allocation.can_stiffen:
            pairs = zip(self._paths, commands, strict=True)
            chambers = tuple(path.reached(command) for path, command in pairs)
        self._note_pressures(commands, chambers, self._stiffness)

    def _room(
        self, reference: float, static: Pressures, signs: list[float]
    ) -> tuple[float, float]:
        """Return the least and the greatest output at which one of the pressures can still change.

        If a muscle is at a limit with the static part alone, only the others count. A muscle that
        is slack at the reference is at a limit.
        """
        low, high = float('inf'), -float('inf')
        for limiter, path, sign, pressure, least in zip(
            self._limiters,
            self._paths,
            signs,
            static,
            self.allocation.least(reference),
            strict=True,
        ):
            slack = min(max(path.command_at_rest(least), limiter.low), limiter.high)
            ends = sorted((sign * (slack - pressure), sign * (limiter.high - pressure)))
            low, high = min(low, ends[0]), max(high, ends[1])
        return low, high

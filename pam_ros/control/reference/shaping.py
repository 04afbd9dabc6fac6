# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""From the target for the load to a reference that it can follow.

A target that jumps is approached within bounds of velocity, acceleration and jerk. A target that
moves smoothly is passed on with its derivatives and without lag, whatever the bounds: the
reference differs from it by an offset that goes to zero within the bounds.
"""

from dataclasses import dataclass
from math import exp

from pam_ros.control.joint_settings import JointSettings
from pam_ros.control.reference.profile import JerkLimitedMotion, MotionLimits, advance, change
from pam_ros.control.signals import Reference
from pam_ros.control.tuning import number
from pam_ros.parameters import OnRevolute, parameter_field


@dataclass(frozen=True)
class StreamTuning:
    """How a target that is set repeatedly is distinguished from one that jumps."""

    quick: float = number(
        80.0, 'rad/s', 'of the tracker: a sine of 0.5 Hz is followed to 6e-5 of its amplitude'
    )
    per_sample: float = number(
        1.5, '', 'rad of the tracker a sample at most: as for the velocity estimate'
    )
    rough: float = number(
        4.0, '', 'times the bound of acceleration: largest deviation of a sample of a stream'
    )
    pause: float = number(
        0.12, 's', 'after which the next sample is a new target: a period of 10 Hz, and jitter'
    )
    least_interval: float = number(1e-4, 's', 'assumed for samples that arrive together')
    missed: float = number(4.0, '', 'intervals without a sample after which a stream has ended')
    least_missed: float = number(0.05, 's', 'the least such time: a delay of a busy machine')


STREAM = StreamTuning()


@dataclass(frozen=True)
class Shape(JointSettings):
    """Bounds of the motion to a target that jumps; in rad for a revolute joint."""

    max_velocity: float = parameter_field(
        0.1,
        'velocity of the reference after a step',
        'm/s',
        low=0.0,
        high=10.0,
        above_low=True,
        revolute=OnRevolute(2.0, 100.0),
    )
    max_acceleration: float = parameter_field(
        0.5,
        'acceleration of the reference after a step',
        'm/s^2',
        low=0.0,
        high=1000.0,
        above_low=True,
        revolute=OnRevolute(15.0, 1e4),
    )
    max_jerk: float = parameter_field(
        6.0,
        'jerk of the reference after a step',
        'm/s^3',
        low=0.0,
        high=1e6,
        above_low=True,
        revolute=OnRevolute(300.0, 1e7),
    )

    @property
    def bounds(self) -> MotionLimits:
        """The same as a tuple."""
        return MotionLimits(self.max_velocity, self.max_acceleration, self.max_jerk)


class Tracker:
    """Velocity and acceleration of a target of which only position samples are given.

    An alpha-beta-gamma filter with three equal poles at ``StreamTuning.quick``. It follows a
    constant acceleration without error, and a sine of amplitude A and w rad/s with an error of
    A (w / quick)^3. A sample that needs more acceleration than ``StreamTuning.rough`` times that
    of *bounds* is a jump: the target is at rest there. If the next sample is another one, but
    within the bound of velocity, it is the second sample of a motion.
    """

    def __init__(self, bounds: MotionLimits) -> None:
        """Make it for a target at rest at 0; see :meth:`start`."""
        self.bounds = bounds
        self.start(0.0)

    def start(self, position: float) -> None:
        """Start again with a target at rest at *position* m."""
        self.state = (position, 0.0, 0.0)
        self._last = position
        self._age = self._interval = STREAM.pause
        self._has_jumped = False

    def follow(self, dt: float) -> bool:
        """Advance by *dt* s; return whether the target jumped because its stream ended."""
        self._age += dt
        x, v, a = self.state
        if v == a == 0.0:
            return False
        if self._age > max(STREAM.missed * self._interval, STREAM.least_missed):
            self.state = (self._last, 0.0, 0.0)
            return True
        self.state = (x + dt * (v + 0.5 * dt * a), v + dt * a, a)
        return False

    def take(self, position: float, ago: float) -> bool:
        """Take in a sample in m, set *ago* s ago; return whether it is a jump."""
        interval = max(self._age - ago, STREAM.least_interval)
        distance = position - self._last
        self._interval, self._age, self._last = interval, ago, position
        x, v, a = self.state
        # Both are compared at the present time: the sample is extrapolated.
        surprise = position + ago * (v + 0.5 * ago * a) - x
        rate = min(STREAM.quick, STREAM.per_sample / interval)
        if (
            interval > STREAM.pause
            or abs(surprise) * rate * rate > STREAM.rough * self.bounds.acceleration
        ):
            speed = distance / interval
            is_stream = self._has_jumped and interval <= STREAM.pause
            is_second = is_stream and abs(speed) <= self.bounds.velocity
            self.state = (
                (position + ago * speed, speed, 0.0) if is_second else (position, 0.0, 0.0)
            )
            self._has_jumped = True
            return True
        self._has_jumped = False
        z = exp(-rate * interval)
        left = 1.0 - z
        self.state = (
            x + (1.0 - z * z * z) * surprise,
            v + 1.5 * left * left * (1.0 + z) / interval * surprise,
            a + left * left * left / (interval * interval) * surprise,
        )
        return False


class Shaper:
    """Turns targets into references."""

    def __init__(self, shape: Shape) -> None:
        """Make it at rest at 0; see :meth:`start`."""
        self.shape = shape
        self._offset = JerkLimitedMotion()
        self._tracker = Tracker(shape.bounds)
        self.start(0.0)

    def start(self, position: float) -> None:
        """Start again at rest at *position* m."""
        self._tracker.start(position)
        self._offset = JerkLimitedMotion()
        self.reference = Reference(position)

    def set_shape(self, shape: Shape) -> None:
        """Continue within other bounds; the present approach keeps the former ones."""
        self.shape = shape
        self._tracker.bounds = shape.bounds

    @property
    def target(self) -> float:
        """The position of the target now, m."""
        return self._tracker.state[0]

    def take(self, position: float, ago: float = 0.0) -> None:
        """Take in a target in m that was set *ago* s ago."""
        if self._tracker.take(position, ago):
            self._set_out(*self._tracker.state)

    def join(self, target: Reference) -> None:
        """Let the target continue from the motion *target*, which is that of a trajectory.

        The acceleration of the reference becomes that of *target* at once, as at all points of a
        trajectory: an approach within the bound of jerk could go beyond the reach if the
        trajectory begins quickly.
        """
        self._set_out(target.position, target.velocity, self.reference.acceleration)

    def _set_out(self, position: float, velocity: float, acceleration: float) -> None:
        """Approach a target whose state differs from that of the reference."""
        now = self.reference
        start = (
            now.position - position,
            now.velocity - velocity,
            now.acceleration - acceleration,
        )
        self._offset.begin(start, self.shape.bounds)

    def follow(self, dt: float, pace: float = 1.0) -> Reference:
        """Return the reference after another *dt* s; *pace* as for :meth:`along`."""
        if self._tracker.follow(dt):
            self._set_out(*self._tracker.state)
        return self.along(dt, Reference(*self._tracker.state), pace)

    def along(self, dt: float, target: Reference, pace: float = 1.0) -> Reference:
        """Return the reference after another *dt* s, for the joined *target*.

        The approach to the target is slower by *pace*, 0 to 1; the target is not.
        """
        x, v, a = self._offset.follow(pace * dt)
        self.reference = Reference(
            target.position + x,
            target.velocity + pace * v,
            target.acceleration + pace * pace * a,
            target.jerk + pace * pace * pace * self._offset.jerk,
        )
        return self.reference

    def rest_at(self, position: float) -> None:
        """Let the target rest at *position* m from now on."""
        self._tracker.start(position)
        self._set_out(position, 0.0, 0.0)

    def stop(self) -> None:
        """Let the target rest at the position at which the reference can stop soonest."""
        _, velocity, acceleration, _ = self.reference
        state: tuple[float, ...] = (self.reference.position, velocity, acceleration)
        for jerk, duration in change(velocity, acceleration, 0.0, self.shape.bounds):
            state = advance((state[0], state[1], state[2]), jerk, duration)
        self.rest_at(state[0])

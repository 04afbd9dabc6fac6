# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The gains of the sliding-mode law, as bandwidths and bounds, and their conditions."""

from dataclasses import dataclass
from math import acos, exp, log, pi, sqrt

from pam_ros.control.allocation import Allocation
from pam_ros.control.joint_settings import JointSettings
from pam_ros.control.tuning import number
from pam_ros.errors import ParameterError
from pam_ros.parameters import OnRevolute, parameter_field


@dataclass(frozen=True)
class OrderTuning:
    """Conditions between the bandwidths of a law."""

    spread: float = number(
        4.0,
        '',
        'least ratio of velocity bandwidth to decay rate of the sliding variable: the two poles '
        'of the estimate then cause a phase lag of 2 atan(1/4), 28 degrees, at this rate',
    )
    samples: float = number(
        1.5,
        '',
        'largest velocity bandwidth times control period: with the pole exp(-1.5) = 0.22 of the '
        'estimate, 1 % of the influence of a sample is left after three',
    )


ORDER = OrderTuning()


@dataclass(frozen=True)
class Gains(JointSettings):
    """Gains of :class:`pam_ros.control.sliding_mode.SlidingMode`.

    Units are those of a prismatic joint. For a revolute joint, read rad for m and N m for N; its
    defaults are different (:meth:`for_joint`). For a moved mass m (or a moment of inertia) the
    gains have these consequences:

    switching gain
        K = disturbance_bound / m. Reaching condition (Slotine & Li 1991, section 7.1): sigma is
        the sliding variable, and d the part of the disturbance that the observer does not cancel.
        If |d| < disturbance_bound, then sigma sigma' < 0 outside the boundary layer, and sigma
        reaches it within |sigma(0)| m / (disturbance_bound - |d|).
    boundary width
        Phi = K / bandwidth. Within the layer K sat(sigma / Phi) = bandwidth sigma, so that sigma
        decays at *bandwidth* there. Boundedness: |sigma| <= Phi from then on, and the error
        |e| <= :meth:`error_bound`.

    Raises ParameterError for a value out of range, or if a condition fails that does not depend
    on the rig; :meth:`check` tests the other conditions.
    """

    bandwidth: float = parameter_field(
        14.0,
        'decay rate of the sliding variable in the boundary layer; a loop with a '
        'pressure lag of 1/bandwidth that is not configured is still well damped',
        '1/s',
        low=0.5,
        high=200.0,
        revolute=OnRevolute(25.0, 200.0),
    )
    fast_bandwidth: float = parameter_field(
        50.0,
        'bandwidth that is reached when learning has found that the pressure follows fast',
        '1/s',
        low=0.5,
        high=200.0,
    )
    surface_bandwidth: float = parameter_field(
        8.0,
        'least natural frequency of the error on the sliding surface; if the stiffness of the '
        'joint gives a higher one, that one is used',
        'rad/s',
        low=0.1,
        high=200.0,
    )
    surface_damping: float = parameter_field(
        0.28,
        'damping ratio of the error on the sliding surface',
        '',
        low=0.05,
        high=5.0,
        revolute=OnRevolute(0.5, 5.0),
    )
    disturbance_bound: float = parameter_field(
        200.0,
        'largest force that the switching term must overcome',
        'N',
        low=0.0,
        high=1e5,
        above_low=True,
        revolute=OnRevolute(5.0, 1e5),
    )
    observer: bool = parameter_field(True, 'whether the disturbance observer acts')
    observer_bandwidth: float = parameter_field(
        4.0,
        'bandwidth of the disturbance observer',
        'rad/s',
        low=0.01,
        high=200.0,
        revolute=OnRevolute(8.0, 200.0),
    )
    velocity_bandwidth: float = parameter_field(
        126.0,
        'bandwidth of the velocity estimate, which lags by 2/velocity_bandwidth in a motion that '
        'the model does not predict',
        'rad/s',
        low=5.0,
        high=2000.0,
    )
    use_measured_velocity: bool = parameter_field(
        False, 'whether the velocity of the joint state is used instead of the estimate'
    )
    rest_factor: float = parameter_field(
        0.2,
        'factor by which all bandwidths are multiplied while the reference rests and is reached',
        '',
        low=0.01,
        high=1.0,
        revolute=OnRevolute(0.3, 1.0),
    )
    rest_tolerance: float = parameter_field(
        12e-6,
        'error below which a resting reference counts as reached; from 2.5 times this on the '
        'full bandwidths act',
        'm',
        low=0.0,
        high=0.01,
        above_low=True,
        revolute=OnRevolute(2e-4, 1.0),
    )
    rejection: bool = parameter_field(
        True,
        'whether the bandwidths rise while a disturbance moves a load that should rest, as far as '
        'the delay of the rig allows',
    )
    rejection_bandwidth: float = parameter_field(
        100.0,
        'bandwidth of the disturbance observer at the highest level of rejection',
        'rad/s',
        low=0.01,
        high=1000.0,
    )
    rejection_surface: float = parameter_field(
        25.0,
        'natural frequency of the error on the sliding surface at the highest level of rejection',
        'rad/s',
        low=0.1,
        high=200.0,
    )
    rejection_damping: float = parameter_field(
        1.0,
        'damping ratio of the error on the sliding surface at the highest level of rejection',
        '',
        low=0.05,
        high=5.0,
    )
    learning: bool = parameter_field(
        True,
        'whether friction, hysteresis and lag that are not configured are learned from the motion',
    )
    pressure_time: float = parameter_field(
        0.02,
        'time constant down to which a configured or learned pressure lag is inverted',
        's',
        low=0.001,
        high=1.0,
    )

    def __post_init__(self) -> None:
        """Check every field, then the conditions between them."""
        super().__post_init__()
        if self.fast_bandwidth < self.bandwidth:
            raise ParameterError(
                f'fast_bandwidth = {self.fast_bandwidth:g} 1/s is below bandwidth = '
                f'{self.bandwidth:g} 1/s, which grows to it'
            )
        if self.velocity_bandwidth < ORDER.spread * self.bandwidth:
            raise ParameterError(
                f'velocity_bandwidth = {self.velocity_bandwidth:g} rad/s is too slow for '
                f'bandwidth = {self.bandwidth:g} 1/s: give at least {ORDER.spread:g} times as '
                'much, or the sliding variable leaves the boundary layer'
            )
        if self.observer and self.observer_bandwidth > self.bandwidth:
            raise ParameterError(
                f'observer_bandwidth = {self.observer_bandwidth:g} rad/s is above bandwidth = '
                f'{self.bandwidth:g} 1/s: the observer compensates what the switching term leaves '
                'and must be slower'
            )

    def check(self, allocation: Allocation, period: float) -> None:
        """Raise ParameterError if these gains do not suit a joint.

        *period* is the time between two updates of the law in s: an estimate of the velocity needs
        several samples. *allocation* is that of the joint, whose muscles must be able to overcome
        ``disturbance_bound``.
        """
        if self.velocity_bandwidth * period > ORDER.samples:
            raise ParameterError(
                f'velocity_bandwidth = {self.velocity_bandwidth:g} rad/s is too fast for a '
                f'control rate of {1.0 / period:g} Hz: give at most {ORDER.samples / period:g}'
            )
        available = allocation.available()
        if self.disturbance_bound > available:
            unit = allocation.model.joint.transmission.equations.effort_unit
            these = (
                'this muscle changes its'
                if len(allocation.ranges) == 1
                else 'the muscles change the'
            )
            what = 'force' if unit == 'N' else 'torque'
            raise ParameterError(
                f'disturbance_bound = {self.disturbance_bound:g} {unit} cannot be overcome: '
                f'{these} {what} by {available:.4g} {unit} over the range of pressure'
            )

    def switching_gain(self, mass: float) -> float:
        """Return K in m/s^2."""
        return self.disturbance_bound / mass

    def boundary_width(self, mass: float) -> float:
        """Return Phi in m/s, half the width of the boundary layer."""
        return self.switching_gain(mass) / self.bandwidth

    def error_bound(self, disturbance: float, mass: float, frequency: float) -> float:
        """Return the largest error in m under any disturbance that stays within +-*disturbance*.

        The surface has the natural *frequency* w in rad/s and the damping ratio z. |sigma| <=
        disturbance / (m bandwidth) is multiplied by the absolute area of the impulse response
        from sigma to the error, whose transfer function is p / (p^2 + 2 z w p + w^2).
        """
        z, w = self.surface_damping, frequency
        if z < 1.0:
            root = sqrt(1.0 - z * z)
            first = exp(-z / root * acos(z)) / w
            area = 2.0 * first / (1.0 - exp(-z * pi / root))
        else:
            area = 2.0 * _overdamped_peak(z) / w
        return disturbance / (mass * self.bandwidth) * area


def _overdamped_peak(z: float) -> float:
    """Return the peak of the step response of p / (p^2 + 2 z p + 1), z >= 1."""
    root = sqrt(max(z * z - 1.0, 0.0))
    if root < 1e-6:
        return exp(-1.0)
    slow, fast = z - root, z + root
    t = (1.0 / (fast - slow)) * log(fast / slow)
    return (exp(-slow * t) - exp(-fast * t)) / (fast - slow)

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The gains of the law for an antagonistic pair, in the units of a joint that turns."""

from dataclasses import dataclass
from math import sqrt

from pam_ros.control.gains import (
    BOUNDARY_LAYER,
    SUPER_TWISTING,
    refuse_disorder,
    refuse_fast_estimate,
)
from pam_ros.control.pair_model import PairModel
from pam_ros.errors import ParameterError
from pam_ros.parameters import check_all, parameter


@dataclass(frozen=True)
class PairGains:
    """Gains of :class:`pam_ros.control.pair_law.PairLaw`.

    What follows from them is as with :class:`pam_ros.control.gains.Gains`, the moment of inertia
    J in place of the mass: K = disturbance_bound / J, Phi = K / bandwidth. Raises ParameterError
    for a value out of range or bandwidths out of order; :meth:`check` has what depends on the
    joint.
    """

    bandwidth: float = parameter(
        25.0,
        'decay rate of the sliding variable in the boundary layer',
        '1/s',
        low=0.5,
        high=200.0,
    )
    surface_bandwidth: float = parameter(
        8.0,
        'least natural frequency of the error on the sliding surface; where the stiffness of the '
        'joint gives more, that is left to it',
        'rad/s',
        low=0.1,
        high=200.0,
    )
    surface_damping: float = parameter(
        0.5, 'damping ratio of the error on the sliding surface', '', low=0.05, high=5.0
    )
    disturbance_bound: float = parameter(
        5.0,
        'largest torque that the switching term must overcome',
        'N m',
        low=0.0,
        high=1e5,
        above_low=True,
    )
    switching: str = parameter(
        BOUNDARY_LAYER,
        'switching term: boundary_layer (saturation), or super_twisting (second order; for a '
        'pressure that follows at once)',
        choices=(BOUNDARY_LAYER, SUPER_TWISTING),
    )
    disturbance_rate: float = parameter(
        5.0,
        'largest rate of the disturbance that super_twisting must follow',
        'N m/s',
        low=0.0,
        high=1e6,
        above_low=True,
    )
    observer: bool = parameter(True, 'whether the disturbance observer acts')
    observer_bandwidth: float = parameter(
        8.0, 'bandwidth of the disturbance observer', 'rad/s', low=0.01, high=200.0
    )
    velocity_bandwidth: float = parameter(
        126.0,
        'bandwidth of the velocity estimate, which lags what the model does not foresee by '
        '2/velocity_bandwidth',
        'rad/s',
        low=5.0,
        high=2000.0,
    )
    use_measured_velocity: bool = parameter(
        False, 'whether the velocity of the joint state is used instead of the estimate'
    )
    rest_factor: float = parameter(
        0.3,
        'by how much all bandwidths shrink while the reference rests and is reached',
        '',
        low=0.01,
        high=1.0,
    )
    rest_tolerance: float = parameter(
        2e-4,
        'error below which a resting reference counts as reached; from 2.5 times this on the '
        'full bandwidths act',
        'rad',
        low=0.0,
        high=1.0,
        above_low=True,
    )
    pressure_time: float = parameter(
        0.02,
        'time constant down to which a declared pressure lag is inverted',
        's',
        low=0.001,
        high=1.0,
    )

    def __post_init__(self) -> None:
        """Check every field, then what must hold between them."""
        check_all(self)
        refuse_disorder(self)

    def check(self, rig: PairModel, period: float) -> None:
        """Raise ParameterError where these gains do not suit a joint, sampled each *period* s."""
        refuse_fast_estimate(self, period)
        low, high = rig.efforts(0.5 * sum(rig.reach))
        if self.disturbance_bound > high - low:
            raise ParameterError(
                f'disturbance_bound = {self.disturbance_bound:g} N m cannot be overcome: these '
                f'muscles change their torque by {high - low:.4g} N m over their range of pressure'
            )

    def switching_gain(self, inertia: float) -> float:
        """Return K in rad/s^2."""
        return self.disturbance_bound / inertia

    def super_twisting(self, inertia: float) -> tuple[float, float]:
        """Return k1 in rad^0.5/s^1.5 and k2 in rad/s^3."""
        rate = self.disturbance_rate / inertia
        return 1.5 * sqrt(rate), 1.1 * rate

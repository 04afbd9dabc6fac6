# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs and outputs of a position law."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple, Protocol

from pam_ros.arguments import array, number, refuse, refuse_shape
from pam_ros.control.allocation import Allocation
from pam_ros.control.learned import Learned
from pam_ros.rig.joint import Joint
from pam_ros.rig.statics import refuse_position

Pressures = tuple[float, ...]  # gauge Pa, one a muscle


class Reference(NamedTuple):
    """Desired position and its derivatives: m, m/s, m/s^2, m/s^3, contraction positive."""

    position: float
    velocity: float = 0.0
    acceleration: float = 0.0
    jerk: float = 0.0


@dataclass
class Terms:
    """Results of the last step of a law, for plots: SI, forces in N, contraction positive.

    For a revolute joint, read rad for m, and N m for N.

    reference, speed
        desired position and velocity, m and m/s
    position, velocity
        estimated position and velocity, m and m/s
    error
        reference minus position, m
    surface
        sliding variable, m/s; 0 where the law has none
    equivalent, switching, observer, learned
        parts of the wanted force: from the model, from the sliding variable, from the
        disturbance observer, and from learning
    pressures
        gauge Pa commanded, one a muscle
    co_contraction, stiffness
        desired stiffness of the joint in N/m, if it can be chosen, and the one that the
        muscles give it according to the model
    bandwidth
        decay rate of the sliding variable in use, 1/s
    rejection, highest_rejection
        level at which disturbances are rejected, 0 to 1, and the present upper limit of it
    feedback
        share of the feedback gains in use, lower after an oscillation of the loop
    cut
        part of the wanted force that a limit of pressure or of its rate cuts off
    """

    reference: float = 0.0
    speed: float = 0.0
    position: float = 0.0
    velocity: float = 0.0
    error: float = 0.0
    surface: float = 0.0
    equivalent: float = 0.0
    switching: float = 0.0
    observer: float = 0.0
    learned: float = 0.0
    pressures: Pressures = (0.0,)
    co_contraction: float = 0.0
    stiffness: float = 0.0
    bandwidth: float = 0.0
    rejection: float = 0.0
    highest_rejection: float = 0.0
    feedback: float = 1.0
    cut: float = 0.0

    @property
    def pressure(self) -> float:
        """Mean of the commanded pressures in Pa."""
        return sum(self.pressures) / len(self.pressures)

    @property
    def saturated(self) -> bool:
        """Whether a limit of pressure or of its rate is active."""
        return self.cut != 0.0

    def value(self, name: str) -> float:
        """Return a term by its name among :func:`term_names`."""
        which, _, number = name.partition('_')
        if which == 'pressure' and number:
            return self.pressures[int(number) - 1]
        return float(getattr(self, name))


LONGEST_TIME = 1.0  # s: of a step, and between a measurement and the step; laws run every few ms


def step_arguments(
    joint: Joint,
    dt: float,
    reference: Reference,
    position: float | None,
    velocity: float | None,
    age: float,
) -> tuple[float | None, float | None]:
    """Return position and velocity for the step of a law for *joint*: None if they are not finite.

    A failed sensor reads NaN, and a law that used it would return NaN from then on. Raises
    ParameterError as in :meth:`PositionLaw.update`.
    """
    if not isinstance(reference, Reference):
        refuse('reference', reference, 'a Reference, such as Reference(0.05)')
    try:
        if not 0.0 < dt <= LONGEST_TIME:
            refuse('dt', dt, f'a time above 0 s and up to {LONGEST_TIME:g} s')
        if not all(map(isfinite, reference)):
            refuse('reference', reference, 'finite numbers')
        _refuse_far('reference.position', reference.position, joint)
        if not -LONGEST_TIME <= age <= LONGEST_TIME:
            refuse('age', age, f'a time in s, {-LONGEST_TIME:g} to {LONGEST_TIME:g} s')
        if position is not None and not isfinite(position):
            position = None
        if position is not None:
            _refuse_far('position', position, joint)
        if velocity is not None and not isfinite(velocity):
            velocity = None
    except (TypeError, ValueError):
        # Looked for only now, since checks of types would cost each step of a law.
        desired = {f'reference.{name}': value for name, value in reference._asdict().items()}
        given = {'dt': dt, 'position': position, 'velocity': velocity, 'age': age}
        for name, value in {**desired, **given}.items():
            if value is not None:
                number(name, value)
        raise
    return position, velocity


def start_arguments(joint: Joint, position: float, pressures: Sequence[float] | None) -> None:
    """Raise ParameterError unless a law for *joint* can start here."""
    _refuse_far('position', number('position', position), joint)
    if pressures is None:
        return
    given, muscles = array('pressures', pressures), len(joint.muscles)
    if given.shape != (muscles,):
        refuse_shape('pressures', given, f'({muscles},), gauge Pa of each muscle, or None')


def _refuse_far(name: str, position: float, joint: Joint) -> None:
    """Raise ParameterError for a position far from those that the muscles of *joint* can have.

    A load can move beyond their range for a moment, but not by the length of this range.
    """
    low, high = joint.position_range
    if not low - (high - low) <= position <= high + (high - low):
        refuse_position(name, position, joint)


# What a plot shows, in this order: m, m/s, N, Pa, 1/s (or rad, N m); saturated is 0 or 1, and
# rejection between them.
TERMS = (
    'reference',
    'position',
    'velocity',
    'error',
    'surface',
    'equivalent',
    'switching',
    'observer',
    'learned',
    'pressure',
    'bandwidth',
    'saturated',
    'rejection',
)


def term_names(muscles: int) -> tuple[str, ...]:
    """Return the names of the terms of a joint with this number of muscles, in order.

    For several muscles these are the TERMS, the pressure of each muscle (their mean is
    ``pressure``), and the stiffness in N/m or N m/rad, desired and according to the model.
    """
    if muscles == 1:
        return TERMS
    # These two come last, so that the others keep their indices: plots may use indices.
    last = ('learned', 'rejection')
    return (
        *(name for name in TERMS if name not in last),
        *(f'pressure_{i + 1}' for i in range(muscles)),
        'co_contraction',
        'stiffness',
        *last,
    )


class PositionLaw(Protocol):
    """A law from positions to pressures; it has no clock and does not depend on ROS.

    For a revolute joint, read rad for m, and N m for N.
    """

    @property
    def terms(self) -> Terms:
        """The results of the last step."""

    @property
    def allocation(self) -> Allocation:
        """The allocation of the effort to the muscles."""

    @property
    def learned(self) -> Learned | None:
        """What was learned from the motion, None for a law that does not learn."""

    def stiffen(self, stiffness: float) -> None:
        """Set a stiffness in N/m; raises RangeError if it is not possible at the reference."""

    def start(self, position: float, pressures: Pressures | None = None) -> None:
        """Start again with the load at *position* m, under commands of *pressures* Pa if known.

        The commands continue from these pressures. Raises ParameterError for a position far from
        those that the muscles can have, for numbers that are not finite, and if the number of
        pressures is not that of the muscles.
        """

    def update(
        self,
        dt: float,
        reference: Reference,
        position: float | None,
        velocity: float | None = None,
        age: float = 0.0,
    ) -> Pressures:
        """Return the gauge pressures in Pa to command from now on, *dt* s after the last call.

        *reference* is the desired position now. *position* is the newest measurement in m,
        taken *age* s ago, None if there was none since the last call; *velocity* is the
        measured one in m/s, if there is one. A measurement that is not finite is ignored.
        *age* is negative for a measurement after now, if its stamp is of a clock that is ahead.
        Raises ParameterError, and changes nothing, for a *dt* that is not above 0 s or is above
        1 s, for a measurement that was taken more than 1 s before or after now, for a reference
        that is not finite, and for positions far from those that the muscles can have: in mm or
        degrees, for example.
        """

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What goes into a position law and what can be read out of it."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol, TypeVar

# Gauge Pa: of one muscle, or of the two of a pair.
Pressure = TypeVar('Pressure', float, tuple[float, float])


class Reference(NamedTuple):
    """Where the load shall be: m, m/s, m/s^2, m/s^3, contraction positive."""

    position: float
    velocity: float = 0.0
    acceleration: float = 0.0
    jerk: float = 0.0


@dataclass
class Terms:
    """What a law found at its last step, for plots: SI, forces in N, contraction positive.

    reference, speed
        where the load shall be and how fast it shall go, m and m/s
    position, velocity
        where it is estimated to be and how fast it goes, m and m/s
    error
        reference less position, m
    surface
        sliding variable, m/s; 0 where the law has none
    equivalent, switching, observer, learned
        parts of the wanted force: what the model wants, what the sliding variable wants, what
        the disturbance observer takes back, and what has been learned
    pressure
        gauge Pa commanded
    bandwidth
        decay rate of the sliding variable in use, 1/s
    cut
        force that is wanted and that a limit of pressure or of its rate cuts off
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
    pressure: float = 0.0
    bandwidth: float = 0.0
    cut: float = 0.0

    @property
    def saturated(self) -> bool:
        """Whether a limit of pressure or of its rate holds."""
        return self.cut != 0.0


@dataclass
class PairTerms(Terms):
    """The same of a law for two muscles against each other: rad for m, N m for N.

    pressures
        gauge Pa commanded of both muscles; ``pressure`` is their mean
    co_contraction, stiffness
        stiffness that the muscles shall give the joint, and do as modelled, N m/rad
    """

    pressures: tuple[float, float] = (0.0, 0.0)
    co_contraction: float = 0.0
    stiffness: float = 0.0

    @property
    def pressure_1(self) -> float:
        """Pressure of the first muscle, which a positive angle shortens."""
        return self.pressures[0]

    @property
    def pressure_2(self) -> float:
        """Pressure of the second muscle."""
        return self.pressures[1]


# What a plot shows, in this order. SI: m, m/s, N, Pa, 1/s; saturated is 0 or 1.
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
)
# Of a pair: rad, rad/s, N m, N m/rad, Pa (the mean first).
PAIR_TERMS = (
    *(name for name in TERMS if name != 'learned'),
    'pressure_1',
    'pressure_2',
    'co_contraction',
    'stiffness',
)


class PositionLaw(Protocol[Pressure]):
    """A law that turns positions into pressures; it has no clock and knows no ROS.

    For a joint that turns, read rad for m, and N m for N.
    """

    @property
    def terms(self) -> Terms:
        """What the last step found."""

    def start(self, position: float, pressure: Pressure | None = None) -> None:
        """Begin anew with the load at *position* m, chambers at *pressure* gauge Pa if known.

        The first pressure that is commanded then is that pressure.
        """

    def update(
        self,
        dt: float,
        reference: Reference,
        position: float | None,
        velocity: float | None = None,
        age: float = 0.0,
    ) -> Pressure:
        """Return the gauge pressure in Pa to command from now on, *dt* s after the last call.

        *reference* is where the load shall be now. *position* is the newest measurement in m,
        taken *age* s ago, None where there was none since the last call; *velocity* is the
        measured one in m/s, where there is one.
        """

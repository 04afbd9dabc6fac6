# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Forces of a muscle and its guide that the model may lack, as features of the motion.

Friction and hysteresis are a sum of elastic elements that slip (Maxwell slip, a generalised
Prandtl-Ishlinskii model): each is a spring that slips when its deflection exceeds its reach.
Together they approximate any hysteresis loop that starts again at each reversal. The first
element, with a reach of 50 um, is dry friction; Stribeck's additional friction at rest is added
to it. An error of the nominal force law is a force over the position (:mod:`.force_curve`).
"""

from dataclasses import dataclass
from math import exp

from pam_ros.control.learning.force_curve import KNOTS, Between, ForceCurve
from pam_ros.control.tuning import number

# Indices: the elements that slip, Stribeck's friction, the slopes at the knots, the constant.
STRIBECK = 5
SLOPES = slice(STRIBECK + 1, STRIBECK + 1 + KNOTS)
CONSTANT = SLOPES.stop
COUNT = CONSTANT + 1


@dataclass(frozen=True)
class FeatureTuning:
    """Sizes of the features, and the expected size of the force that each one describes."""

    reaches: tuple[float, ...] = number(
        (50e-6, 250e-6, 0.8e-3, 2e-3, 5e-3),
        'm',
        'displacements at which the elements slip: from 2.5 times the noise to half of the '
        'largest swing of control, in steps of a factor 2.5 to 5',
    )
    stribeck_speed: float = number(
        0.01, 'm/s', 'default of effects.coulomb_friction.stribeck_speed'
    )
    stroke: float = number(
        0.01, 'm', 'displacement over which the slopes of the force count: the swing of control'
    )
    spreads: tuple[float, ...] = number(
        (20.0,) * STRIBECK + (10.0,) + (15.0,) * KNOTS + (100.0,),
        'N',
        'expected force of each: half of the hysteresis of 40 N and about the friction of 15/25 N '
        'of control; the constant one is a payload of 10 kg; a slope of 30 N causes larger errors '
        'with muscles of other makers',
    )
    lows: tuple[float, ...] = number(
        (0.0,) * STRIBECK + (-5.0,) + (-100.0,) * KNOTS + (-300.0,),
        'N',
        'elements resist the motion; slopes may have both signs, up to 10 N/mm: with 25 '
        'the largest errors on a braided muscle are twice as large',
    )
    highs: tuple[float, ...] = number(
        (60.0,) * STRIBECK + (30.0,) + (100.0,) * KNOTS + (300.0,),
        'N',
        'three times what is expected, and the same for slopes: beyond it an estimate is wrong',
    )


class Features:
    """The features along one motion; a feature times its weight is a force in N.

    ``values`` have no unit: -1 to 1, except for those over the position, in strokes; ``rates`` are
    their change per second in the last step. All features are forces against the motion or forces
    that grow with the position: the muscles must overcome them.
    """

    def __init__(self, tuning: FeatureTuning, reach: tuple[float, float]) -> None:
        """Create the features of a joint with this *reach*, at rest at 0."""
        self._tuning = tuning
        self._curve = ForceCurve(reach, tuning.stroke)
        self.start(0.0)

    def start(self, position: float) -> None:
        """Start again at rest: no element is deflected."""
        self._position = position
        self._origin = self._curve.features(position)
        self.values = self._before = [0.0] * CONSTANT + [1.0]
        self._dt = 1.0  # of the last step, s

    @property
    def rates(self) -> list[float]:
        """Change of the values per second in the last step."""
        dt = self._dt
        return [(a - b) / dt for a, b in zip(self.values, self._before, strict=True)]

    @property
    def place(self) -> Between:
        """Where the position is between the knots of the force over the position."""
        return self._curve.at(self._position)

    def follow(self, dt: float, position: float, velocity: float) -> list[float]:
        """Advance by *dt* s to *position* m and *velocity* m/s."""
        tuning, distance = self._tuning, position - self._position
        self._position, self._before, self._dt = position, self.values, dt
        now = []
        # By comparison, since min() and max() take most of the time of such a loop.
        for before, reach in zip(self._before, tuning.reaches, strict=False):
            bent = before + distance / reach
            now.append(-1.0 if bent < -1.0 else 1.0 if bent > 1.0 else bent)
        ratio = velocity / tuning.stribeck_speed
        now.append(now[0] * exp(-ratio * ratio))
        for value, origin in zip(self._curve.features(position), self._origin, strict=True):
            now.append(value - origin)
        now.append(1.0)
        self.values = now
        return now

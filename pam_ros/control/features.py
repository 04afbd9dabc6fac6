# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a muscle and its guide may have beside their model, as features of the motion.

Friction and hysteresis are a sum of play elements: each is a spring that slips at its reach, and
together they make any loop that a turning point starts anew (Maxwell slip; generalised
Prandtl-Ishlinskii). The first, with its reach of a few micrometres, is dry friction; Stribeck's
surplus at rest goes with it. A stiffness other than the declared one is a force over position.
"""

from math import exp

REACHES = (50e-6, 250e-6, 0.8e-3, 2e-3, 5e-3)  # m
STRIBECK_SPEED = 0.01  # m/s
STROKE = 0.01  # m, for the stiffness
COUNT = len(REACHES) + 3
CONSTANT = COUNT - 1

# Of each: standard deviation expected, least and largest force, N. The last is a constant force.
SPREAD = (*(20.0 for _ in REACHES), 10.0, 15.0, 100.0)
LOW = (*(0.0 for _ in REACHES), -5.0, -30.0, -300.0)
HIGH = (*(60.0 for _ in REACHES), 30.0, 30.0, 300.0)


class Features:
    """The features along one motion: a force in N each, once multiplied with its weight.

    ``values`` are 1 or of its size; ``rates`` their change per second in the last step. All
    resist the motion or grow with the position: they are what must be pulled against.
    """

    def __init__(self) -> None:
        """Make them at rest at 0."""
        self.values = [0.0] * COUNT
        self.rates = [0.0] * COUNT
        self.start(0.0)

    def start(self, position: float) -> None:
        """Begin anew at rest: no element is bent."""
        self._origin = self._position = position
        self.values[:] = [0.0] * CONSTANT + [1.0]
        self.rates[:] = [0.0] * COUNT

    def follow(self, dt: float, position: float, velocity: float) -> list[float]:
        """Go on by *dt* s to *position* m, where the velocity is *velocity* m/s."""
        way = position - self._position
        self._position = position
        now = [
            min(max(before + way / reach, -1.0), 1.0)
            for before, reach in zip(self.values, REACHES, strict=False)
        ]
        ratio = velocity / STRIBECK_SPEED
        now += [now[0] * exp(-ratio * ratio), (position - self._origin) / STROKE, 1.0]
        self.rates[:] = [(a - b) / dt for a, b in zip(now, self.values, strict=True)]
        self.values[:] = now
        return now

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rigs whose muscle is not the one that is configured, and motions over their whole reach.

The controller has the constants of ``dmsp_20_400n``. The rigs have those of other publications,
random ones, or a braided muscle by its geometry, whose force law has no exponential at all. All
have a valve lag and dry friction that are not configured.
"""

from math import exp, pi, radians, sin, tan, tanh
from types import SimpleNamespace

import numpy as np
from scipy.optimize import brentq

from support.closed_loop import close_loop, nominal, shared
from truth import Sensor, TruthPlant
from truth.control_plants import FEEDBACK_NOISE
from truth.effects import effect
from truth.muscles import GRAVITY, constants_si, contraction_for

MASS, LENGTH, P0 = 20.0, 0.4, 250e3  # kg, m, Pa
LOWEST, HIGHEST = 20e3, 560e3  # Pa, at the ends of the motions at rest
SPARE = 3e-3  # m, from there and from the ends of the nominal reach
HOLD, STEPS = 2.5, 8  # s, count
FREQUENCY, SINE = 0.3, 20.0  # Hz, s
SHARE = 0.12  # by which random constants differ
LAG, DRY = 0.03, 8.0  # s, N
EFFECTS = (
    effect('pressure_lag', 'two_times', fill_s=LAG, vent_s=LAG),
    effect('coulomb_friction', coulomb_n=DRY, static_n=DRY, stribeck_m_s=10e-3),
)


class BraidedMuscle:
    """A muscle of McKibben's type that lifts a mass (Chou & Hannaford 1996, with friction).

    F = pi r^2 p (a (1 - e)^2 - b) less an elastic force of the bladder, with the braid's angle
    of 25 degrees and 2 r = 20 mm at rest. It has viscous friction, too, and the members of a
    truth plant that a loop uses.
    """

    def __init__(self, seed=0, drag=60.0, bladder=1500.0, stretched=12000.0):
        """Let it rest at P0; *drag* is in N s/m, the elastic forces are in N."""
        self._drag = drag
        self._bladder, self._stretched = bladder, stretched
        self._rng = np.random.default_rng([seed, 25])
        self.state = SimpleNamespace(u=P0, p=P0)
        self.y, self._v = self.rests_at(P0), 0.0

    def force(self, p, e):
        """Return the pull in N at p in Pa and the contraction e."""
        angle = radians(25.0)
        area = pi * 0.01**2
        braid = p * area * (3.0 / tan(angle) ** 2 * (1.0 - e) ** 2 - 1.0 / sin(angle) ** 2)
        return braid - (self._bladder if e >= 0.0 else self._stretched) * e

    def rests_at(self, p):
        """Return the position in m at which it holds the mass with p in Pa."""
        return LENGTH * brentq(lambda e: self.force(p, e) - MASS * GRAVITY, -0.2, 0.3)

    def step(self, command, dt, push=0.0):
        """Advance by *dt* s with *command* in Pa; return the measured position in m."""
        state = self.state
        state.u = command
        count = max(round(dt / 2e-4), 1)
        h = dt / count
        for _ in range(count):
            state.p += (command - state.p) * (1.0 - exp(-h / LAG))
            pull = self.force(state.p, self.y / LENGTH)
            friction = self._drag * self._v + DRY * tanh(self._v / 5e-4)
            self._v += h * ((pull - friction + push) / MASS - GRAVITY)
            self.y += h * self._v
        return self.measure()

    def measure(self):
        """Return the position in m with the noise of the sensor."""
        return self.y + FEEDBACK_NOISE * self._rng.standard_normal()


def plant(muscle, seed=0):
    """Return the plant of a *muscle* by name, and the positions in m of its lowest and highest.

    'random' has constants that differ from the configured ones, each by up to SHARE.
    """
    if muscle == 'braided':
        rig = BraidedMuscle(seed)
        return rig, (rig.rests_at(LOWEST), rig.rests_at(HIGHEST))
    if muscle == 'random':
        factors = 1.0 + np.random.default_rng([seed, 12]).uniform(-SHARE, SHARE, 6)
        constants = tuple(factors * constants_si('dmsp_20_400n'))
    else:
        constants = constants_si(muscle)
    rig = TruthPlant(
        constants, MASS, effects=EFFECTS, sensor=Sensor(noise=FEEDBACK_NOISE), seed=seed, p0=P0
    )
    ends = (contraction_for(constants, p, MASS * GRAVITY) * LENGTH for p in (LOWEST, HIGHEST))
    return rig, tuple(ends)


def over_the_reach(make, muscle, seed=0):
    """Return errors in mm with the law ``make(joint)``: of steps from end to end and of a sine.

    Of the last four steps the largest overshoot, of the last two periods of the sine the RMS.
    """
    rig, (low, high) = plant(muscle, seed)
    joint = nominal(MASS)
    law, reach = make(joint), shared(joint).reach
    low, high = max(low, reach[0]) + SPARE, min(high, reach[1]) - SPARE
    middle, swing = 0.5 * (low + high), 0.45 * (high - low)
    start = rig.y

    def steps(t):
        return (high if int(t / HOLD + 1e-9) % 2 else low) - start

    def sine(t):
        return middle + swing * sin(2.0 * pi * FREQUENCY * t) - start

    run = close_loop(law, rig, steps, HOLD * STEPS)
    beyond = np.where(run.target > middle, -run.error, run.error)
    # A step ends a second after its begin: until then the load is on its way.
    arrived = (run.t - 1e-6) % HOLD > 1.0
    overshoot = np.max(beyond[arrived & run.last(4 * HOLD)])
    rig, _ = plant(muscle, seed)
    run = close_loop(make(joint), rig, sine, SINE)
    rms = np.sqrt(np.mean(run.error[run.last(2.0 / FREQUENCY)] ** 2))
    return 1e3 * float(overshoot), 1e3 * float(rms)

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Position laws in simulated time on the truth plant: deterministic, without ROS."""

from dataclasses import dataclass, field
from math import pi, sin

import numpy as np

from pam_ros.control.allocation import allocation_of
from pam_ros.control.limits import Limits
from pam_ros.control.model import ControlModel
from pam_ros.control.reference.shaping import Shape, Shaper
from pam_ros.effects import PressureLag
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.loads import Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from truth import CONTROL_PLANTS, Sensor, TruthPlant
from truth.control_plants import FEEDBACK_NOISE

STREAM = 0.01  # s between two samples of a moving target
LAG = [PressureLag(fill=0.050, vent=0.070)]
ZONE = [PressureLag(dead_zone=6e3)]
LAG_WITH_ZONE = [PressureLag(fill=0.050, vent=0.070, dead_zone=6e3)]


@dataclass
class Run:
    """What a run left: times s, target and true coordinate m or rad, commands Pa, terms.

    Of a pair also the true ``stiffness`` in N m/rad, and that which the law ``wanted``.
    """

    t: np.ndarray
    target: np.ndarray
    coordinate: np.ndarray
    pressure: np.ndarray
    terms: dict[str, np.ndarray] = field(default_factory=dict)
    stiffness: np.ndarray | None = None
    wanted: np.ndarray | None = None

    @property
    def error(self):
        """Target less true coordinate."""
        return self.target - self.coordinate

    def last(self, seconds):
        """Return which samples are in the last *seconds*."""
        return self.t > self.t[-1] - seconds


def truth(name, mass=20.0, p0=300e3, noise=FEEDBACK_NOISE, seed=0, **more):
    """Return a plant of the benchmark's table, or with effects of its own."""
    effects = CONTROL_PLANTS[name] if isinstance(name, str) else name
    return TruthPlant(
        effects=effects, mass=mass, p0=p0, sensor=Sensor(noise=noise), seed=seed, **more
    )


def nominal(mass=20.0, effects=(), **muscle):
    """Return the rig as it is configured in the controller."""
    return single_muscle_joint(Muscle(zeta=0.15, **muscle), Mass(mass=mass), effects)


def shared(joint, limits=None):
    """Return how the muscles of a joint share what a law wants."""
    return allocation_of(ControlModel(joint), limits or Limits())


def step_target(height, at=1.0):
    """Return a target that jumps by *height* m at a time, from where the load rests."""
    return lambda t: height if t >= at else 0.0


def sine_target(amplitude, frequency):
    """Return a target that swings by *amplitude* m at *frequency* Hz around where it rests."""
    return lambda t: amplitude * sin(2.0 * pi * frequency * t)


def close_loop(
    law, plant, target, duration, rate=500.0, shape=None, is_pressure_known=True, push=None
):
    """Run *law* on *plant*; *target* (s -> m) is relative to where the load rests at first.

    The law gets the target as samples every STREAM s, as from a topic, and measured positions of
    the truth plant at its own *rate*; its state is the one at the end of each period. *push*
    (s -> N) is a force on the load.
    """
    dt = 1.0 / rate
    count = round(duration * rate)
    origin = plant.y
    law.start(origin, (plant.state.u,) if is_pressure_known else None)
    shaper = Shaper(shape or Shape())
    shaper.start(origin)
    measured = plant.measure()
    taken = None
    rows = np.zeros((count, 4))
    names = (
        *('error', 'surface', 'equivalent', 'switching', 'observer', 'learned', 'bandwidth'),
        *('rejection', 'highest_rejection'),
    )
    terms = np.zeros((count, len(names)))
    for n in range(count):
        t = n * dt
        sample = int(t / STREAM + 1e-9)
        if sample != taken:
            taken = sample
            shaper.take(origin + target(sample * STREAM), t - sample * STREAM)
        (pressure,) = law.update(dt, shaper.reference, measured)
        measured = plant.step(pressure, dt, push(t) if push else 0.0)
        shaper.follow(dt)
        end = (n + 1) * dt
        rows[n] = end, origin + target(end), plant.y, pressure
        terms[n] = [getattr(law.terms, name) for name in names]
    return Run(*rows.T, dict(zip(names, terms.T, strict=True)))

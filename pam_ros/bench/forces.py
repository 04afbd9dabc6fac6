# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Sinusoidal forces on the load of a scenario, and how far they move it.

A force is that of ``periodic_disturbance``, which ``changes`` of a scenario can start, alter and
end. The motion at its frequency is measured at the end of a stretch of time in which it is the
same.
"""

from collections.abc import Sequence
from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pam_ros.bench.trial import Trial
from pam_ros.effects.periodic_disturbance import PeriodicDisturbance
from pam_ros.settings.scene import SimulationSetup
from pam_ros.simulator.plant import Plant

Array = NDArray[np.float64]
SETTLING = 0.5  # share of a stretch in which the motion may still settle
PERIODS = 3.0  # fewest of the force, in what is left


class Force(NamedTuple):
    """A sinusoidal force from ``begin`` to ``end`` in s: ``frequency`` Hz, ``amplitude`` N."""

    begin: float
    end: float
    frequency: float
    amplitude: float


class Response(NamedTuple):
    """The motion per force at a ``frequency`` in Hz, in m/N or rad/N.

    ``compliance`` is that with the controller, ``alone`` that of the rig at constant pressures.
    """

    frequency: float
    compliance: float
    alone: float


def forces_of(setups: Sequence[tuple[float, SimulationSetup]], duration: float) -> list[Force]:
    """Return the forces of a scenario that lasts *duration* s, in the order of their times.

    *setups* are those of the rig, each with the time in s from which it holds. Forces are left out
    whose stretch is too short to measure the motion.
    """
    times = [time for time, _ in setups]
    found: list[Force] = []
    for (begin, setup), end in zip(setups, [*times[1:], duration], strict=True):
        forces = (
            Force(begin, end, effect.frequency, hypot(effect.force_sin, effect.force_cos))
            for actuator in setup.joints[0].actuators
            for effect in actuator.effects
            if isinstance(effect, PeriodicDisturbance)
        )
        # That of one muscle: on both of an antagonistic pair they would cancel.
        found += [one for one in forces if one.amplitude > 0.0 and one.frequency > 0.0][:1]
    return [
        one
        for one in _joined(found)
        if (1.0 - SETTLING) * (one.end - one.begin) * one.frequency >= PERIODS
    ]


def _joined(forces: list[Force]) -> list[Force]:
    """Return *forces* without the changes of the rig that did not change the force."""
    found: list[Force] = []
    for one in forces:
        before = found[-1] if found else None
        if before is not None and (before.end, *before[2:]) == (one.begin, *one[2:]):
            found[-1] = before._replace(end=one.end)
        else:
            found.append(one)
    return found


def response(t: Array, position: Array, force: Force) -> float:
    """Return the amplitude in m or rad of the *position* (n,) at the frequency of *force*.

    *t* (n,) are the times in s. It is that of a sinusoid beside a straight line, fitted to whole
    periods at the end of the stretch.
    """
    settled = force.begin + SETTLING * (force.end - force.begin)
    periods = np.floor((force.end - settled) * force.frequency + 1e-9)
    inside = (t > force.end - periods / force.frequency - 1e-9) & (t < force.end - 1e-9)
    angle = 2.0 * np.pi * force.frequency * t[inside]
    columns = np.column_stack(
        (np.sin(angle), np.cos(angle), np.ones(angle.size), t[inside] - force.end)
    )
    sine, cosine, *_ = np.linalg.lstsq(columns, position[inside], rcond=None)[0]
    return float(np.hypot(sine, cosine))


def responses(trial: Trial) -> list[Response]:
    """Return how far each force of a *trial* moved the load, by frequency."""
    found = []
    for row in trial.forces.tolist():
        force = Force(*row)
        moved, alone = (response(trial.t, one, force) for one in (trial.position, trial.alone))
        found.append(Response(force.frequency, moved / force.amplitude, alone / force.amplitude))
    return sorted(found)


def left_alone(setups: Sequence[tuple[float, SimulationSetup]], count: int) -> Array:
    """Return the positions (count,) in m or rad of a rig that keeps its pressures.

    *setups* are those of the rig, each with the time in s from which it holds; positions are those
    of the periods of its states.
    """
    (_, setup), *changes = setups
    plant = Plant(setup)
    rate = setup.settings.publish_rate
    steps = setup.settings.physics_rate / rate
    found = np.zeros(count)
    for k in range(count):
        while changes and k / rate >= changes[0][0] - 0.5e-9:
            plant.change(changes.pop(0)[1])
        found[k] = plant.position[0]
        plant.advance(round((k + 1) * steps))
    return found

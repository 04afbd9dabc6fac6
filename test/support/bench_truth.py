# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of the truth plant as the package reads them, and what their user believes."""

from dataclasses import replace

import numpy as np

from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig.loads import GRAVITY, Mass
from pam_ros.rig.standard_joints import single_muscle_joint
from truth import (
    PROGRAMMES,
    Sensor,
    TruthPlant,
    held_record,
    play,
    play_late,
    record,
    stamps,
    working_range,
)
from truth.muscles import GRAVITY as TRUE_GRAVITY
from truth.muscles import constants_si

MASS = 20.0


def recording_of(true, name='truth.csv'):
    """Return a recording of the truth plant as the package holds it."""
    t = true.t_s - true.t_s[0]
    u = true.pressure_command_pa
    if true.held:
        return Recording(name, t, t, u, true.position_m, None, true.force_n, None, 'held')
    return Recording(name, t, t, u, true.position_m)


def free(*effects, name='truth.csv', **settings):
    """Return the recording of a free load of 20 kg; see ``truth.record``."""
    return recording_of(record(effects, **{'rate': 100.0, 'duration': 30.0, **settings}), name)


def of_pressures(*effects, name='truth.csv', **settings):
    """Return the recording of the commands and the pressure of a free load; see ``free``."""
    true = record(effects, **{'rate': 100.0, 'duration': 30.0, **settings})
    t = true.t_s - true.t_s[0]
    return Recording(
        name, t, t, true.pressure_command_pa, pressure=true.pressure_pa, kind='pressure'
    )


def with_pressures(*effects, name='truth.csv', **settings):
    """Return the recording of a free load with its commands and pressures; see ``free``."""
    true = record(effects, **{'rate': 100.0, 'duration': 30.0, **settings})
    return replace(recording_of(true, name), pressure=true.pressure_pa)


def late(one, onset, seed=0, duration=40.0, rate=100.0, noise=20e-6, before=(), within=0.0):
    """Return the recording of a free load of 20 kg on which an effect begins at *onset* s.

    It has its full strength *within* s.
    The effects *before* act from the start.
    """
    plant = TruthPlant(mass=MASS, effects=before, sensor=Sensor(noise=noise), seed=seed)
    low, high = working_range(plant.constants, MASS)
    rng = np.random.default_rng([seed, 4])
    u = PROGRAMMES['mixture'](rate, duration, low, high, rng)
    plant.reset(u[0], seed)
    t = stamps(rate, duration)
    first = int(np.searchsorted(t, onset))
    return recording_of(play_late(plant, [one], t, u, first, seed, within), 'late.csv')


def step_and_back(one, seed, duration=12.0, rate=100.0, noise=20e-6):
    """Return the recording of a free load whose pressure rises at 1 s and falls at its end."""
    plant = TruthPlant(mass=MASS, effects=[one], sensor=Sensor(noise=noise), seed=seed)
    low, high = working_range(plant.constants, MASS)
    first, step = np.random.default_rng([seed, 9]).uniform([0.0, 0.3], [0.5, 0.5])
    t = stamps(rate, duration)
    is_up = (t >= 1.0) & (t < 0.8 * duration)
    u = low + (high - low) * (first + step * is_up)
    plant.reset(u[0], seed)
    return recording_of(play(plant, t, u, seed=seed), f'{seed}.csv')


def held(*effects, name='truth.csv', **settings):
    """Return the recording of a muscle at prescribed lengths; see ``truth.held_record``."""
    return recording_of(held_record(effects, **{'duration': 40.0, **settings}), name)


def nominal(mass=MASS, zeta=0.15, off=None):
    """Return the model that is exactly the truth plant's, constants times 1 + *off* (6,).

    The truth plant falls with 9.81 m/s^2; the difference to the standard value stands in a6.
    """
    constants = list(constants_si('dmsp_20_400n'))
    constants[5] -= mass * (TRUE_GRAVITY - GRAVITY)
    if off is not None:
        constants = [a * (1.0 + share) for a, share in zip(constants, off, strict=True)]
    muscle = Muscle(*constants, pressure_unit='Pa', contraction_unit='fraction', zeta=zeta)
    return single_muscle_joint(muscle, Mass(mass=mass))

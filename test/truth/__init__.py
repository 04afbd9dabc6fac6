# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""An independent plant to judge the package by: own equations, own integrator, own constants.

It shares no code with the package on purpose, and says each effect by other equations than the
package where more than one description exists.

Closed loop, a command held for 2 ms, the noisy position back::

    plant = control_plant('friction', p0=300e3)
    y = plant.measure()
    for _ in range(5000):
        y = plant.step(controller(y), 2e-3)
    plant.y, plant.v, plant.force, plant.pressure  # the truth

Any rig, and a recording of it::

    lag = effect('pressure_lag', fill_s=0.05, vent_s=0.07)
    recording = record([lag], rate=500.0, duration=60.0, noise=20e-6, rho=0.9, seed=1)
    recording.write_csv('free.csv')
    held_record([effect('hysteresis', 'pressure')]).write_csv('held.csv')

Blind trials of a kind, a pair or nothing at all::

    trial = blind_trial('hysteresis+pressure_lag', seed=3)
    trial.recording, trial.nominal  # what the finder gets
    trial.kinds, trial.effects, trial.accepted  # the answer
    late_trial('leak', seed=3).onset  # the same, with an effect that begins in the middle
    visibility(trial)  # how much re-tuning alone would leave
"""

from .catalogue import FORMS, KINDS, OUT_OF_LIBRARY
from .control_plants import CONTROL_PLANTS, control_plant
from .effects import Effect, effect
from .excitation import PROGRAMMES, stamps, working_range
from .late import DEVELOPING, LATE, LateTrial, late_trial, play_late
from .plant import TruthPlant
from .records import Recording, held_record, play, record
from .sensor import Sensor
from .trials import (
    ABSORBED,
    NOISE_ONLY,
    PAIRS,
    Nominal,
    Trial,
    blind_trial,
    held_trial,
    slow_trial,
    wide_trial,
)
from .visibility import Visibility, visibility

__all__ = [
    'ABSORBED',
    'CONTROL_PLANTS',
    'DEVELOPING',
    'FORMS',
    'KINDS',
    'LATE',
    'NOISE_ONLY',
    'OUT_OF_LIBRARY',
    'PAIRS',
    'PROGRAMMES',
    'Effect',
    'LateTrial',
    'Nominal',
    'Recording',
    'Sensor',
    'Trial',
    'TruthPlant',
    'Visibility',
    'blind_trial',
    'control_plant',
    'effect',
    'held_record',
    'held_trial',
    'late_trial',
    'play',
    'play_late',
    'record',
    'slow_trial',
    'stamps',
    'visibility',
    'wide_trial',
    'working_range',
]

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Trials in which an effect is not there at first, and begins in the middle of the recording."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .effects import Effect
from .excitation import PROGRAMMES, stamps, working_range
from .plant import TruthPlant
from .records import Recording, play
from .sensor import Sensor
from .trials import Trial, _Draw, wide_trial

# What breaks, loosens, dries out or is put down while a rig runs.
LATE = (
    'coulomb_friction',
    'leak',
    'payload',
    'pressure_lag',
    'pressure_loss',
    'viscous_friction',
)
# A part of the supply is lost: 5 to 12 % of every pressure.
LOSS = (0.05, 0.12)


SEEN = 3.0  # noises by which an effect has moved the load when it shows


@dataclass
class LateTrial:
    """A trial whose effect begins ``onset`` s after the first sample.

    ``shows`` is the time in s after which it has moved the load by SEEN noises: a leak behind a
    valve that is open all the time does nothing yet.
    """

    trial: Trial
    onset: float
    shows: float


def late_trial(kind: str, seed: int) -> LateTrial:
    """Draw a wide trial of a kind of LATE, which begins within 20 to 60 % of the recording.

    Payloads are put on or taken off. Rig, noise, rate and programme are those of
    :func:`wide_trial`.
    """
    base = wide_trial('pressure_offset' if kind == 'pressure_loss' else kind, seed)
    draw = _Draw('late ' + kind, seed)
    (one,) = base.effects
    values = dict(one.values)
    if kind == 'payload' and draw.chance(0.5):
        values['payload_kg'] = -values['payload_kg']
    if kind == 'pressure_loss':
        values = {'regulator_pa': 0.0, 'regulator_gain': 1.0 - draw.uniform(*LOSS)}
    trial = replace(base, kind=f'late {kind}', effects=(Effect(one.kind, one.form, values),))
    duration = draw.uniform(40.0, 120.0)
    t = stamps(trial.rate, duration, trial.jitter, draw.rng)
    low, high = working_range(trial.constants_si, trial.mass)
    u = PROGRAMMES[trial.programme](trial.rate, duration, low, high, draw.rng)
    first = int(draw.uniform(0.2, 0.6) * t.size)
    sensor = Sensor(noise=trial.noise, rho=trial.rho, quantum=trial.quantum)
    plant, plain = (
        TruthPlant(trial.constants_si, trial.mass, trial.zeta, sensor=s, seed=seed, p0=u[0])
        for s in (sensor, None)
    )
    trial.recording = play_late(plant, trial.effects, t, u, first, seed)
    moved = np.abs(trial.recording.truth['position_m'] - plain.run(t, u).y)
    shows = int(np.argmax(moved > SEEN * trial.noise))
    return LateTrial(trial, float(t[first] - t[0]), float(t[shows] - t[0]))


def play_late(
    plant: TruthPlant,
    effects: Sequence[Effect],
    t: np.ndarray,
    u: np.ndarray,
    first: int,
    seed: int = 0,
) -> Recording:
    """Record a plant under commands u (n,) Pa at t (n,) s; *effects* begin at sample *first*."""
    before = play(plant, t[: first + 1], u[: first + 1], seed=seed)
    plant.begin(effects)
    after = play(plant, t[first:], u[first:], seed=seed)
    names = ('t_s', 'pressure_command_pa', 'position_m', 'force_n', 'pressure_pa')
    joined = {n: np.concatenate([getattr(before, n)[:-1], getattr(after, n)]) for n in names}
    true = np.concatenate([before.truth['position_m'][:-1], after.truth['position_m']])
    return replace(after, **joined, truth={'position_m': true})

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
# What may also develop: a guide runs dry, a leak opens, a tank fills, a supply is lost.
DEVELOPING = tuple(
    f'developing {kind}' for kind in ('coulomb_friction', 'leak', 'payload', 'pressure_loss')
)
# A part of the supply is lost: 5 to 12 % of every pressure.
LOSS = (0.05, 0.12)
WITHIN = (2.0, 8.0)  # s until a developing effect has its full strength
STAGES = 50  # in which it grows
# Fields of the plant that grow with an effect, and their values without it; others are its form.
ABSENT = {
    'coulomb_n': 0.0,
    'static_n': 0.0,
    'leak_per_s': 0.0,
    'fill_s': 0.0,
    'vent_s': 0.0,
    'payload_kg': 0.0,
    'viscous_ns_m': 0.0,
    'regulator_gain': 1.0,
}


SEEN = 3.0  # noises by which an effect has moved the load when it shows


@dataclass
class LateTrial:
    """A trial whose effect begins ``onset`` s after the first sample.

    It has its full strength ``within`` s after that, 0 if it jumps. ``shows`` is the time in s
    after which it has moved the load by SEEN noises: a leak behind a valve that is open all the
    time does nothing yet.
    """

    trial: Trial
    onset: float
    shows: float
    within: float


def late_trial(kind: str, seed: int) -> LateTrial:
    """Draw a wide trial of a kind of LATE, which begins within 20 to 60 % of the recording.

    One of DEVELOPING grows in WITHIN s, at a constant rate or at one that decreases. Payloads are
    put on or taken off. Rig, noise, rate and programme are those of :func:`wide_trial`.
    """
    draw, is_developing = _Draw('late ' + kind, seed), kind in DEVELOPING
    kind = kind.removeprefix('developing ')
    base = wide_trial('pressure_offset' if kind == 'pressure_loss' else kind, seed)
    (one,) = base.effects
    values = dict(one.values)
    if kind == 'payload' and draw.chance(0.5):
        values['payload_kg'] = -values['payload_kg']
    if kind == 'pressure_loss':
        values = {'regulator_pa': 0.0, 'regulator_gain': 1.0 - draw.uniform(*LOSS)}
    how = 'developing' if is_developing else 'late'
    trial = replace(base, kind=f'{how} {kind}', effects=(Effect(one.kind, one.form, values),))
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
    within = draw.uniform(*WITHIN) if is_developing else 0.0
    trial.recording = play_late(
        plant, trial.effects, t, u, first, seed, within, slows=is_developing and draw.chance(0.5)
    )
    moved = np.abs(trial.recording.truth['position_m'] - plain.run(t, u).y)
    shows = int(np.argmax(moved > SEEN * trial.noise))
    return LateTrial(trial, float(t[first] - t[0]), float(t[shows] - t[0]), within)


def play_late(
    plant: TruthPlant,
    effects: Sequence[Effect],
    t: np.ndarray,
    u: np.ndarray,
    first: int,
    seed: int = 0,
    within: float = 0.0,
    slows: bool = False,
) -> Recording:
    """Record a plant under commands u (n,) Pa at t (n,) s; *effects* begin at sample *first*.

    They have their full strength after *within* s. Until then they grow with the time, or, if
    their growth *slows*, as 1 - exp(-3 t / within) does.
    """
    grown = np.arange(1, STAGES + 1) / STAGES if within else np.ones(1)
    begin = np.searchsorted(t, t[first] + within * (grown - grown[0]))
    shares = np.expm1(-3.0 * grown) / np.expm1(-3.0) if slows else grown
    ends = np.append(begin[1:], t.size - 1)
    pieces = [play(plant, t[: first + 1], u[: first + 1], seed=seed)]
    for n, (start, end, share) in enumerate(zip(begin, ends, shares, strict=True), 1):
        plant.begin([_grown(one, share) for one in effects])
        if end > start:
            pieces.append(play(plant, t[start : end + 1], u[start : end + 1], seed=seed + n))
    names = ('t_s', 'pressure_command_pa', 'position_m', 'force_n', 'pressure_pa')
    joined = {n: _joined([getattr(one, n) for one in pieces]) for n in names}
    true = _joined([one.truth['position_m'] for one in pieces])
    return replace(pieces[-1], **joined, truth={'position_m': true})


def _grown(effect: Effect, share: float) -> Effect:
    """Return an effect at a share of its strength."""
    values = {
        name: ABSENT[name] + share * (value - ABSENT[name]) if name in ABSENT else value
        for name, value in effect.values.items()
    }
    return replace(effect, values=values)


def _joined(pieces: Sequence[np.ndarray]) -> np.ndarray:
    """Return pieces as one record: the last sample of each is the first of the next."""
    return np.concatenate([*(one[:-1] for one in pieces[:-1]), pieces[-1]])

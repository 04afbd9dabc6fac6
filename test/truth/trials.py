# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Blind trials: a specimen, a rig and a recording drawn from a seed, with the truth."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .catalogue import FORMS, OUT_OF_LIBRARY
from .effects import Effect, draw_effect
from .excitation import PROGRAMMES, stamps, triangle, working_range
from .muscles import constants_si, contraction_for
from .plant import TruthPlant
from .records import Recording, held_record, play
from .sensor import Sensor

# Pairs whose signatures differ, each expected to be distinguished.
PAIRS = (
    'coulomb_friction+pressure_lag',
    'hysteresis+pressure_lag',
    'hysteresis+dead_time',
    'coulomb_friction+creep',
    'viscous_friction+creep',
    'periodic_disturbance+hysteresis',
    'end_stop+coulomb_friction',
    'softening+pressure_lag',
    'leak+coulomb_friction',
    'pressure_dependent_damping+dead_time',
    'payload+hysteresis',
    'slack+pressure_lag',
)
MUSCLE = 'dmsp_20_400n'
NOISE_ONLY = 'noise_only'
RATES = (100.0, 125.0, 200.0, 250.0, 500.0, 1000.0)
ENCODER = 1e-5  # m, step of an encoder of 0.01 mm
# Wrong numbers rather than missing physics: re-tuning takes all or most of them.
ABSORBED = ('payload', 'pressure_offset', 'length_offset')


@dataclass(frozen=True)
class Nominal:
    """What the user believes: a1..a6 in SI, mass in kg, damping ratio, rest length in m."""

    constants_si: tuple[float, ...]
    mass: float
    zeta: float
    l0: float = 0.4


@dataclass
class Trial:
    """A recording to be explained, and the answer.

    kind      a kind of the catalogue, two joined by '+', or 'noise_only'
    configured  the model as the finder gets it (another specimen's constants)
    recording what the finder gets
    effects   the truth
    """

    kind: str
    seed: int
    nominal: Nominal
    recording: Recording
    effects: tuple[Effect, ...]
    constants_si: tuple[float, ...]
    mass: float
    zeta: float
    noise: float
    rho: float
    rate: float
    jitter: float
    programme: str
    exercised: bool
    unsettled: bool = False
    quantum: float = 0.0

    @property
    def kinds(self) -> tuple[str, ...]:
        """Kinds that are really there, none for noise alone."""
        return tuple(one.kind for one in self.effects)

    @property
    def accepted(self) -> tuple[frozenset[str], ...]:
        """For each effect the names by which it may be called."""
        return tuple(FORMS[(one.kind, one.form)].names for one in self.effects)

    @property
    def in_library(self) -> bool:
        """Whether every kind that is there is one that the package has."""
        return not set(self.kinds) & set(OUT_OF_LIBRARY)

    def replay(
        self,
        *,
        effects: Sequence[Effect] | None = None,
        constants: tuple[float, ...] | None = None,
        mass: float | None = None,
        zeta: float | None = None,
    ) -> np.ndarray:
        """Return the noiseless positions (n,) in m of the same programme on a changed rig."""
        plant = TruthPlant(
            constants or self.constants_si,
            mass or self.mass,
            zeta or self.zeta,
            effects=self.effects if effects is None else effects,
            p0=self.recording.pressure_command_pa[0],
            seed=self.seed,
        )
        return plant.run(self.recording.t_s, self.recording.pressure_command_pa).linked

    def test_recording(self) -> Recording:
        """Return a second recording of the same rig and specimen under another programme."""
        again = _Draw(self.kind, self.seed + 1_000_003)
        t = stamps(self.rate, 30.0, self.jitter, again.rng)
        low, high = working_range(self.constants_si, self.mass)
        u = PROGRAMMES[self.programme](self.rate, 30.0, low, high, again.rng)
        return _play(self, t, u, self.seed + 1_000_003)


class _Draw:
    """The random numbers of a trial."""

    def __init__(self, kind: str, seed: int) -> None:
        self.rng = np.random.default_rng([zlib.crc32(kind.encode()), seed])

    def log(self, low: float, high: float) -> float:
        return float(low * (high / low) ** self.rng.random())

    def uniform(self, low: float, high: float) -> float:
        return float(self.rng.uniform(low, high))

    def specimen(self, scatter: float = 0.02, most: float = 0.05) -> tuple[float, ...]:
        """Another muscle of the same type: each constant off by 2 %, at most 5 %."""
        scatter = np.clip(scatter * self.rng.standard_normal(6), -most, most)
        return tuple(float(a) for a in np.array(constants_si(MUSCLE)) * (1.0 + scatter))

    def chance(self, share: float) -> bool:
        return bool(self.rng.random() < share)


def _play(trial: Trial, t: np.ndarray, u: np.ndarray, seed: int) -> Recording:
    plant = TruthPlant(
        trial.constants_si,
        trial.mass,
        trial.zeta,
        effects=trial.effects,
        sensor=Sensor(noise=trial.noise, rho=trial.rho, quantum=trial.quantum),
        seed=seed,
        p0=u[0],
    )
    if trial.exercised or trial.unsettled:
        # A rig that has been used before: memory is not virgin when the recording starts.
        cycle = triangle(200.0, 8.0, u.min(), u.max(), np.random.default_rng(seed), period=4.0)
        for command in cycle:
            plant.step(command, 1.0 / 200.0)
        # Long enough for the load to come to rest, or not even for that.
        plant.step(u[0], 0.3 if trial.unsettled else 2.0)
    return play(plant, t, u, seed=seed)


def blind_trial(
    kind: str, seed: int, *, rate: float | None = None, duration: float | None = None
) -> Trial:
    """Draw a free-load trial of a kind, of a pair 'a+b', or of 'noise_only'.

    Drawn: magnitude and form (catalogue), specimen, damping ratio, mass, noise of 5 to 60 um,
    white or AR(1) up to 0.95 a sample, rate of 100 to 1000 Hz, in a quarter
    of the trials with stamps that jitter by 15 % of a period, duration of 40 to 120 s, virgin
    or exercised memory. The configured model has the published constants and a damping ratio of
    0.15; the configured mass is right, a payload aside.
    """
    draw = _Draw(kind, seed)
    kinds = () if kind == NOISE_ONLY else tuple(kind.split('+'))
    constants = draw.specimen()
    # Only a light load lets a muscle go slack.
    mass = draw.uniform(2.5, 6.0) if 'slack' in kinds else draw.uniform(12.0, 25.0)
    rate = rate or float(draw.rng.choice(RATES))
    duration = duration or draw.uniform(40.0, 120.0)
    low, high = working_range(constants, mass)
    stroke = tuple(0.4 * contraction_for(constants, p, mass * 9.81) for p in (low, high))
    effects = tuple(
        draw_effect(one, draw.rng, stroke=stroke, pressures=(low, high), duration=duration)
        for one in kinds
    )
    programme = 'mixture_with_vents' if 'slack' in kinds else 'mixture'
    trial = Trial(
        kind=kind,
        seed=seed,
        nominal=Nominal(constants_si(MUSCLE), mass, 0.15),
        recording=None,  # type: ignore[arg-type]
        effects=effects,
        constants_si=constants,
        mass=mass,
        zeta=draw.uniform(0.11, 0.20),
        noise=draw.log(5e-6, 60e-6),
        rho=draw.uniform(0.3, 0.95) if draw.rng.random() < 0.5 else 0.0,
        rate=rate,
        jitter=0.3 if draw.rng.random() < 0.25 else 0.0,
        programme=programme,
        exercised=bool({'hysteresis', 'coulomb_friction'} & set(kinds))
        and bool(draw.rng.random() < 0.5),
    )
    u = PROGRAMMES[programme](rate, duration, low, high, draw.rng)
    t = stamps(rate, duration, trial.jitter, draw.rng)
    trial.recording = _play(trial, t, u, seed)
    return trial


def wide_trial(kind: str, seed: int) -> Trial:
    """Draw a free-load trial from what rigs in the field are like, kinds as for blind_trial.

    Drawn as there, but for these: each constant of the specimen off by 3 %, at most 6 %; rates of
    50 to 1000 Hz; stamps that jitter by 15 % of a period in half of the trials; an encoder of
    0.01 mm in a third; in half of them a recording that begins 0.3 s after eight seconds of
    motion, with all memories wherever they are.
    """
    base = blind_trial(kind, seed, rate=50.0, duration=40.0)
    draw = _Draw('wide ' + kind, seed)
    constants = draw.specimen(0.03, 0.06)
    low, high = working_range(constants, base.mass)
    stroke = tuple(0.4 * contraction_for(constants, p, base.mass * 9.81) for p in (low, high))
    rate = float(draw.rng.choice((50.0, *RATES)))
    duration = draw.uniform(40.0, 120.0)
    trial = replace(
        base,
        effects=tuple(
            draw_effect(one, draw.rng, stroke=stroke, pressures=(low, high), duration=duration)
            for one in base.kinds
        ),
        constants_si=constants,
        rate=rate,
        jitter=0.3 if draw.chance(0.5) else 0.0,
        quantum=ENCODER if draw.chance(1.0 / 3.0) else 0.0,
        unsettled=draw.chance(0.5),
        exercised=False,
    )
    u = PROGRAMMES[trial.programme](rate, duration, low, high, draw.rng)
    t = stamps(rate, duration, trial.jitter, draw.rng)
    trial.recording = _play(trial, t, u, seed)
    return trial


def slow_trial(kind: str, seed: int) -> Trial:
    """Draw a trial of one slow cycle of 20 to 60 s, on a rig as in :func:`wide_trial`."""
    base = wide_trial(kind, seed)
    draw = _Draw('slow ' + kind, seed)
    trial = replace(base, programme='cycle')
    low, high = working_range(trial.constants_si, trial.mass)
    duration = draw.uniform(20.0, 60.0)
    u = PROGRAMMES[trial.programme](trial.rate, duration, low, high, draw.rng)
    t = stamps(trial.rate, duration, trial.jitter, draw.rng)
    trial.recording = _play(trial, t, u, seed)
    return trial


def held_trial(kind: str, seed: int) -> Trial:
    """Draw a trial at prescribed lengths: pressure and contraction in, force (2 N noise) out."""
    draw = _Draw('held ' + kind, seed)
    kinds = () if kind == NOISE_ONLY else tuple(kind.split('+'))
    constants = draw.specimen()
    duration = draw.uniform(80.0, 160.0)
    effects = tuple(
        draw_effect(
            one,
            draw.rng,
            stroke=(0.0, 0.072),
            pressures=(60e3, 560e3),
            duration=duration,
            held=True,
        )
        for one in kinds
    )
    rate = float(draw.rng.choice(RATES[:4]))
    recording = held_record(
        effects,
        seed=seed,
        rate=rate,
        duration=duration,
        force_noise=draw.log(0.5, 3.0),
        moving=bool(draw.rng.random() < 0.5),
        muscle=constants,
    )
    return Trial(
        kind=kind,
        seed=seed,
        nominal=Nominal(constants_si(MUSCLE), 20.0, 0.15),
        recording=recording,
        effects=effects,
        constants_si=constants,
        mass=20.0,
        zeta=0.15,
        noise=0.0,
        rho=0.0,
        rate=rate,
        jitter=0.0,
        programme='held',
        exercised=False,
    )

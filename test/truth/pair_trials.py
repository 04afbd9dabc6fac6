# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Blind trials of a joint of two muscles: what is there, and in which muscle or on the joint."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np

from .catalogue import FORMS, OUT_OF_LIBRARY
from .effects import Effect, draw_effect
from .excitation import mixture, stamps, steps
from .muscles import constants_si
from .pair import TruthPair
from .reservoir import Reservoir
from .sensor import Sensor

MUSCLE, LENGTH = 'dmsp_20_400n', 0.4
BOTH, JOINT = 'both', 'joint'
NAMES = ('agonist', 'antagonist')
IN_MUSCLES = (
    'pressure_lag',
    'dead_time',
    'dead_band',
    'leak',
    'hysteresis',
    'creep',
    'pressure_dependent_damping',
    'periodic_disturbance',
)
ON_JOINT = ('coulomb_friction', 'viscous_friction')
SUPPLY = 'supply'  # of both muscles, and so of the joint
# The pair has no ripple of a force on the load, and no creep of a share of the force.
_FORMS = {'periodic_disturbance': ('supply',), 'creep': ('pressure', 'strain')}
# Every kind with the places where a trial can have it; 'one' is either muscle.
PAIR_KINDS = (
    'noise_only',
    *(f'{kind}@both' for kind in IN_MUSCLES),
    *(f'{kind}@one' for kind in IN_MUSCLES),
    *(f'{kind}@joint' for kind in ON_JOINT),
    f'{SUPPLY}@joint',
    'saturation@both',
    'saturation@one',
)


@dataclass(frozen=True)
class NominalPair:
    """What the user believes of the joint; units as those of TruthPair."""

    constants_si: tuple[float, ...]
    zeta: float
    l0: float
    radius: float
    inertia: float
    mass: float
    arm: float
    contraction: float


@dataclass
class PairTrial:
    """A recording of a joint to be explained, and the answer.

    t (n,) s, commands (n, 2) Pa, angle (n,) rad as measured with *noise* (rad). ``kind`` is what
    was asked for, ``effects`` and ``reservoir`` what is there, ``where`` the name of a muscle,
    'both' or 'joint'.
    """

    kind: str
    seed: int
    nominal: NominalPair
    effects: tuple[Effect, ...]
    reservoir: Reservoir | None
    where: str
    noise: float
    t: np.ndarray
    commands: np.ndarray
    angle: np.ndarray

    @property
    def accepted(self) -> frozenset[str]:
        """The names by which the effect may be called."""
        names = {name for e in self.effects for name in FORMS[(e.kind, e.form)].names}
        return frozenset({*names, SUPPLY} if self.reservoir else names)

    @property
    def forms(self) -> list[str]:
        """The forms of what is there."""
        return [*(e.form for e in self.effects), *(['reservoir'] if self.reservoir else [])]

    @property
    def in_library(self) -> bool:
        """Whether what is there is something that the package has."""
        return not any(e.kind in OUT_OF_LIBRARY for e in self.effects)


def pair_trial(
    kind: str, seed: int, *, rate: float | None = None, duration: float | None = None
) -> PairTrial:
    """Draw a trial of 'effect@place', or of 'noise_only'; places are both, one and joint.

    Drawn: magnitude and form (catalogue), each muscle's own specimen (each constant off by 2 %, at
    most 5 %), damping ratio, pulley, load, mounting, noise of 0.03 to 1 mrad, rate of 100 to 500
    Hz, jittered stamps in a quarter, 40 to 80 s. Friction at the pivot is that of a guide at the
    pulley's radius. The configured model has the published constants; its geometry is right.
    """
    rng = np.random.default_rng([zlib.crc32(kind.encode()), seed, 11])
    name, _, place = kind.partition('@')
    specimens = tuple(
        tuple(np.array(constants_si(MUSCLE)) * (1.0 + np.clip(0.02 * rng.standard_normal(6),
                                                              -0.05, 0.05)))
        for _ in NAMES
    )  # fmt: skip
    radius = float(rng.uniform(0.03, 0.05))
    nominal = NominalPair(
        constants_si(MUSCLE),
        0.15,
        LENGTH,
        radius,
        float(rng.uniform(0.01, 0.03)),
        float(rng.uniform(0.5, 2.0)),
        0.25,
        float(rng.uniform(0.08, 0.12)),
    )
    drawn = float(rng.uniform(40.0, 80.0)), float(rng.choice((100.0, 200.0, 500.0)))
    duration, rate = duration or drawn[0], rate or drawn[1]
    t = stamps(rate, duration, 0.3 if rng.random() < 0.25 else 0.0, rng)
    commands = _commands(t, rate, duration, rng)
    reservoir = _reservoir(commands, rng) if name == SUPPLY else None
    effects, where = ((), place)
    if reservoir is None:
        effects, where = _drawn(name, place, radius, duration, commands, rng)
    noise = float(3e-5 * (1e-3 / 3e-5) ** rng.random())
    plant = TruthPair(
        muscles=(MUSCLE, MUSCLE),
        lengths=(LENGTH, LENGTH),
        radius=radius,
        inertia=nominal.inertia,
        mass=nominal.mass,
        arm=nominal.arm,
        contraction=(nominal.contraction, nominal.contraction),
        zeta=float(rng.uniform(0.11, 0.20)),
        constants=specimens,
        in_muscles=effects if where == BOTH else (),
        in_each=tuple(effects if where == one else () for one in NAMES),
        at_pivot=effects if where == JOINT else (),
        reservoir=reservoir,
        sensor=Sensor(noise=noise),
        seed=seed,
    )
    angle = _played(plant, t, commands)
    return PairTrial(kind, seed, nominal, effects, reservoir, where, noise, t, commands, angle)


def _reservoir(commands: np.ndarray, rng: np.random.Generator) -> Reservoir:
    """Return a reservoir that has less than the highest of the *commands* (n, 2) in Pa."""
    return Reservoir(
        level=float(commands.max() * rng.uniform(0.85, 1.0)),
        share=float(0.03 * 10.0 ** rng.random()),
        recovery=float(0.3 * (5.0 / 0.3) ** rng.random()),
    )


def _commands(t: np.ndarray, rate: float, duration: float, rng: np.random.Generator) -> np.ndarray:
    """Return commands (n, 2) in Pa: a level that both have, and a difference between them."""
    common = steps(rate, duration, 200e3, 350e3, rng)[: t.size]
    smooth = np.ones(max(3, int(0.2 * rate))) / max(3, int(0.2 * rate))
    common = np.convolve(np.pad(common, smooth.size, mode='edge'), smooth, mode='same')
    common = common[smooth.size : -smooth.size]
    more = mixture(rate, duration, -130e3, 130e3, rng)[: t.size]
    return np.clip(np.stack([common + more, common - more], axis=1), 20e3, 580e3)


def _drawn(
    name: str,
    place: str,
    radius: float,
    duration: float,
    commands: np.ndarray,
    rng: np.random.Generator,
) -> tuple[tuple[Effect, ...], str]:
    """Return the effects that are there, and where."""
    if not place:
        return (), ''
    found = draw_effect(
        name,
        rng,
        stroke=(0.02, 0.06),
        pressures=(float(commands.min()), float(commands.max())),
        duration=duration,
    )
    while found.form not in _FORMS.get(name, (found.form,)):
        found = draw_effect(
            name, rng, stroke=(0.02, 0.06), pressures=(2e5, 4e5), duration=duration
        )
    if place == JOINT:
        found = Effect(found.kind, found.form, _at_pivot(found.values, radius))
    where = str(rng.choice(NAMES)) if place == 'one' else place
    return (found,), where


def _at_pivot(values: dict[str, float], radius: float) -> dict[str, float]:
    """Return the friction of a guide as that of a pivot with a pulley of this radius in m."""
    power = {
        'coulomb_n': 1,
        'static_n': 1,
        'stribeck_m_s': -1,
        'bristle_n_m': 2,
        'viscous_ns_m': 2,
    }
    return {name: value * radius ** power[name] for name, value in values.items()}


def _played(plant: TruthPair, t: np.ndarray, commands: np.ndarray) -> np.ndarray:
    """Return the measured angle (n,) in rad: each sample before the command of its stamp."""
    plant.reset(0.0, tuple(commands[0]))
    plant.step(tuple(commands[0]), 3.0)
    angle = np.empty(t.size)
    angle[0] = plant.measure()
    for k in range(1, t.size):
        angle[k] = plant.step(tuple(commands[k - 1]), float(t[k] - t[k - 1]))
    return angle

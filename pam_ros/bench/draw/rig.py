# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Rigs that are drawn: a muscle of this package, a joint, a load, and the real specimen."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from pam_ros.bench.draw.dice import Dice, digits
from pam_ros.errors import ParameterError
from pam_ros.muscle.muscle import Muscle
from pam_ros.rig.arrangements import ANTAGONISTIC, CRANK, LEVER, LOAD, PARALLEL, Arrangement
from pam_ros.rig.loads import GRAVITY
from pam_ros.settings.nominal import package_muscles
from pam_ros.settings.sim import SimSettings

JOINTS: Mapping[Arrangement, float] = {ANTAGONISTIC: 2.0, LEVER: 1.0, CRANK: 1.0, PARALLEL: 1.0}
CONSTANTS = ('a1', 'a2', 'a3', 'a4', 'a5', 'a6')
SPREAD = 0.01, 0.08  # largest relative difference of a constant of the specimen
FARTHEST = 0.12  # largest difference of the force, as a share of the highest force
DAMPING = 0.7, 1.5  # damping ratio of the specimen, relative to the declared one
LOADS = 0.03, 0.35  # weight of a mass, as a share of the highest force
TORQUES = 0.03, 0.2  # greatest torque of the weight of an arm, as a share of the highest torque
ARMS = 0.08, 0.12  # radius or crank, as a share of the length of the muscle


@dataclass(frozen=True)
class Rig:
    """A rig as declared, and the parameters of its *specimens*, by the names of the muscles.

    ``declared`` are parameters of ``pam_sim``. ``mismatch`` is the largest difference of the force
    of a specimen within its working range, as a share of the highest force.
    """

    kind: Arrangement
    muscle: str
    declared: Mapping[str, Any]
    specimens: tuple[Mapping[str, float], ...]
    mismatch: float

    @property
    def muscles(self) -> tuple[str, ...]:
        """The names of its muscles, as ``pam_sim`` has them."""
        stem, count = SimSettings.joint_name, self.kind.muscles
        return (stem,) if count == 1 else tuple(f'{stem}_{i + 1}' for i in range(count))

    @property
    def is_revolute(self) -> bool:
        """Whether it turns."""
        return self.kind.transmission.equations.revolute

    def of_muscles(self, *each: Mapping[str, Any]) -> dict[str, Any]:
        """Return parameters of *each* muscle as those of a scenario."""
        if len(self.muscles) == 1:
            return dict(each[0])
        return {name: dict(own) for name, own in zip(self.muscles, each, strict=True)}


@cache
def muscles() -> dict[str, Muscle]:
    """Return the muscles of this package that can be drawn, by name."""
    return package_muscles()


def draw_rig(dice: Dice, kind: Arrangement, name: str) -> Rig:
    """Return a rig with muscles *name*. Raises ParameterError if a specimen cannot be one."""
    muscle = muscles()[name]
    declared: dict[str, Any] = {} if kind is LOAD else {'joint': kind.name}
    declared['muscle'] = name
    if kind in (LOAD, PARALLEL):
        highest = kind.muscles * float(muscle.force(muscle.p_max, 0.0))
        declared['mass'] = digits(dice.decade(*LOADS) * highest / GRAVITY)
    else:
        declared |= _turned(dice, kind, muscle)
    specimens = [_specimen(dice, muscle) for _ in range(kind.muscles)]
    mismatch = max(_mismatch(muscle, one) for one in specimens)
    if mismatch > FARTHEST:
        raise ParameterError(f'a specimen differs by {100.0 * mismatch:.3g} %')
    return Rig(kind, name, declared, tuple(specimens), mismatch)


def _turned(dice: Dice, kind: Arrangement, muscle: Muscle) -> dict[str, Any]:
    """Return the parameters of a pulley or a lever with an arm."""
    arm = digits(dice.between(*ARMS) * muscle.l0)
    found: dict[str, Any] = {'radius': arm}
    if kind is not ANTAGONISTIC:
        anchor = digits(dice.between(1.0, 1.25) * muscle.l0)
        found = {'crank': arm, 'anchor': anchor, 'angle': dice.between(1.3, 1.8)}
    highest = arm * float(muscle.force(muscle.p_max, kind.contraction))
    length = digits(dice.between(0.4, 0.9) * muscle.l0)
    mass = digits(dice.decade(*TORQUES) * highest / (GRAVITY * length))
    found |= {'mass': mass, 'arm': length}
    found['inertia'] = digits(dice.between(0.1, 0.6) * mass * length**2)
    if kind is CRANK:  # gravity is what returns the load of a single muscle
        return {**found, 'hanging_at': dice.between(-1.5, -0.6)}
    found |= {f'contraction_{i + 1}': dice.between(0.08, 0.12) for i in range(kind.muscles)}
    if dice.chance(0.3):
        return {**found, 'plane': 'horizontal'}
    return {**found, 'hanging_at': dice.between(-0.5, 0.5)}


def _specimen(dice: Dice, muscle: Muscle) -> dict[str, float]:
    """Return the constants and the damping ratio of one specimen of *muscle*."""
    spread = dice.between(*SPREAD)
    found = {
        name: digits(getattr(muscle, name) * (1.0 + dice.between(-spread, spread)))
        for name in CONSTANTS
    }
    return {**found, 'zeta': digits(muscle.zeta * dice.between(*DAMPING))}


def _mismatch(muscle: Muscle, specimen: Mapping[str, float]) -> float:
    """Return the largest difference of the force; ParameterError if it is not a muscle.

    A muscle is one whose force rises with the pressure and falls with the contraction.
    """
    other = replace(muscle, **specimen)  # type: ignore[arg-type]
    p, kappa = np.meshgrid(
        np.linspace(muscle.p_min, muscle.p_max, 9),
        np.linspace(muscle.kappa_min, muscle.kappa_max, 9),
    )
    differs = np.abs(other.force(p, kappa) - muscle.force(p, kappa))
    return float(np.max(differs) / muscle.force(muscle.p_max, 0.0))

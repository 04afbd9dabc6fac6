# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that are drawn, with strengths in proportion to the rig."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import cos, pi, sin, sqrt

import numpy as np

from pam_ros.bench.draw.dice import Dice, digits
from pam_ros.effects import EFFECTS
from pam_ros.effects.base import Compensation
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint

Given = dict[str, float]
COUNTS: Mapping[int, float] = {0: 1.0, 1: 2.0, 2: 2.0, 3: 2.0}
DECLARED = 0.3  # probability that one of the effects is declared
SUPPLY = 1e5, 2.5e5  # Pa, of the supply of a valve above the highest pressure of the muscle


@dataclass(frozen=True)
class Sizes:
    """The sizes of a rig that the strengths follow, SI.

    ``force`` is the highest force of a muscle, ``effort`` that of all muscles on the joint, N or
    N m, ``pressure`` the highest pressure. ``arm`` is that of a muscle, 1 on a prismatic joint,
    and ``length`` the coordinate that corresponds to a contraction of 1 in the effects of the
    joint. ``stiffness`` and ``inertia`` are those of the joint in the middle of its *reach*.
    """

    force: float
    effort: float
    pressure: float
    arm: float
    length: float
    mass: float
    stiffness: float
    inertia: float
    reach: tuple[float, float]
    is_revolute: bool

    @property
    def critical_damping(self) -> float:
        """The critical damping of the joint, N s/m or N m s/rad."""
        return 2.0 * sqrt(self.stiffness * self.inertia)


def sizes_of(joint: Joint, reach: tuple[float, float]) -> Sizes:
    """Return the sizes of a nominal *joint* whose load can be held within *reach*."""
    muscle, middle = joint.muscles[0], 0.5 * sum(reach)
    arm = float(np.mean(np.abs(statics.middle_arms(joint))))
    force = float(muscle.force(muscle.p_max, 0.0))
    stiffness = statics.stiffness(joint, 0.4 * muscle.p_max, middle)
    return Sizes(
        force,
        len(joint.muscles) * force * arm,
        muscle.p_max,
        arm,
        1.0 if joint.is_revolute else muscle.l0,
        joint.load.mass,
        float(stiffness + statics.weight_stiffness(joint, middle)),
        joint.inertia,
        reach,
        joint.is_revolute,
    )


# Each function draws the parameters of the effect of its name --------------------------------


def dead_time(dice: Dice, rig: Sizes) -> Given:
    """Draw a tube and a computer: 2 to 30 ms."""
    return {'delay': dice.decade(2e-3, 30e-3)}


def supply(dice: Dice, rig: Sizes) -> Given:
    """Draw a reservoir of 4 to 20 times the volume of the muscle."""
    return {
        'share': dice.decade(0.05, 0.25),
        'level': digits(rig.pressure * dice.between(1.05, 1.3)),
        'recovery': dice.decade(0.3, 3.0),
    }


def pressure_offset(dice: Dice, rig: Sizes) -> Given:
    """Draw the errors of a regulator: up to 2 % of the range, and 4 % of the value."""
    return {
        'offset': digits(rig.pressure * dice.signed(0.002, 0.02)),
        'gain': dice.signed(0.005, 0.04),
    }


def dead_band(dice: Dice, rig: Sizes) -> Given:
    """Draw a threshold of 1 to 4 % of the range."""
    band = digits(rig.pressure * dice.between(0.01, 0.04))
    return {'band': band, 'width': digits(0.1 * band)}


def pressure_lag(dice: Dice, rig: Sizes) -> Given:
    """Draw a valve of 10 to 80 ms, which may have a dead zone, or flows as of an orifice."""
    fill = dice.decade(10e-3, 80e-3)
    found = {'fill': fill, 'vent': digits(fill * dice.between(0.8, 1.6))}
    if dice.chance(0.3):  # 0.2 to 1 % of the range: docs/effects/pressure_lag.md
        found['dead_zone'] = digits(rig.pressure * dice.between(0.002, 0.01))
    if dice.chance(0.3):
        found['choking'] = dice.between(0.2, 1.0)
        found['supply'] = digits(rig.pressure + dice.between(*SUPPLY))
    return found


def leak(dice: Dice, rig: Sizes) -> Given:
    """Draw a leak that the open valve refills."""
    refill = dice.decade(20e-3, 0.1)
    return {'rate': dice.decade(0.01, 0.3), 'refill': refill, 'vent': digits(0.8 * refill)}


def length_offset(dice: Dice, rig: Sizes) -> Given:
    """Draw an error of the mounting: up to 1 % of the length of the muscle."""
    return {'offset': dice.signed(0.002, 0.01)}


def softening(dice: Dice, rig: Sizes) -> Given:
    """Draw a loss of 2 to 8 % of the force, by the motion or by warming."""
    found = {'limit': dice.between(0.02, 0.08)}
    if dice.chance(0.5):
        return {**found, 'per_contraction': dice.decade(0.3, 3.0)}
    return {**found, 'per_second': dice.decade(0.02, 0.3)}


def creep(dice: Dice, rig: Sizes) -> Given:
    """Draw a share of 2 to 6 % of force or of pressure that is late, or a viscoelastic part."""
    found = {'time': dice.decade(0.8, 8.0), 'spread': dice.decade(1.0, 3.0)}
    kind = dice.count(0, 2)
    if kind == 0:
        return {**found, 'force': dice.between(0.02, 0.06)}
    if kind == 1:
        return {**found, 'pressure': dice.between(0.02, 0.06)}
    return {**found, 'stiffness': digits(rig.force * dice.between(0.1, 0.35))}


def hysteresis(dice: Dice, rig: Sizes) -> Given:
    """Draw a loop of a half height of 0.4 to 2.5 % of the force of a muscle."""
    height = digits(rig.force * dice.decade(0.004, 0.025))
    if dice.chance(0.5):
        return {'amplitude': height, 'width': dice.decade(0.003, 0.03)}
    return {'slip': height, 'slip_width': dice.decade(0.008, 0.05)}


def pressure_hysteresis(dice: Dice, rig: Sizes) -> Given:
    """Draw a loop of a half width of 0.3 to 1.5 % of the range of pressure."""
    return {
        'slip': digits(rig.pressure * dice.decade(0.003, 0.015)),
        'slip_width': digits(rig.pressure * dice.between(0.03, 0.1)),
    }


def slack(dice: Dice, rig: Sizes) -> Given:
    """Draw a muscle that cannot push."""
    return {'share': 1.0, 'toe': digits(rig.force * dice.between(0.002, 0.01))}


def pressure_dependent_damping(dice: Dice, rig: Sizes) -> Given:
    """Draw a damping of 2 to 20 % of the critical one at 40 % of the range of pressure."""
    unit = rig.critical_damping * rig.force / rig.effort / rig.arm / (0.4 * rig.pressure)
    return {
        'inflating': digits(unit * dice.between(0.02, 0.2)),
        'deflating': digits(unit * dice.between(0.02, 0.2)),
    }


def periodic_disturbance(dice: Dice, rig: Sizes) -> Given:
    """Draw a force of 0.2 to 1 % of that of a muscle, or a ripple of 0.2 to 1 % of the range."""
    phase = dice.between(0.0, 2.0 * pi)
    is_force = dice.chance(0.5)
    what, unit = ('force', rig.force) if is_force else ('pressure', rig.pressure)
    amplitude = unit * dice.between(0.002, 0.01)
    return {
        f'{what}_sin': digits(amplitude * sin(phase)),
        f'{what}_cos': digits(amplitude * cos(phase)),
        'frequency': dice.decade(0.3, 6.0),
    }


def payload(dice: Dice, rig: Sizes) -> Given:
    """Draw a load that is up to 15 % lighter or 25 % heavier than declared."""
    share = dice.between(0.05, 0.25) if dice.chance(0.7) else -dice.between(0.05, 0.15)
    return {'mass': digits(rig.mass * share)}


def viscous_friction(dice: Dice, rig: Sizes) -> Given:
    """Draw a guide with 2 to 20 % of the critical damping."""
    return {'coefficient': digits(rig.critical_damping * dice.between(0.02, 0.2))}


def coulomb_friction(dice: Dice, rig: Sizes) -> Given:
    """Draw a guide with 0.1 to 1.2 % of the effort of the muscles, more to break away."""
    level = digits(rig.effort * dice.decade(0.001, 0.012))
    return {
        'level': level,
        'breakaway': digits(level * dice.between(1.0, 1.7)),
        'stribeck_speed': digits(dice.decade(5e-3, 20e-3) / rig.arm),
    }


def end_stop(dice: Dice, rig: Sizes) -> Given:
    """Draw a pad at the upper end of the reach, or at both ends, beyond the reference."""
    low, high = rig.reach
    found = {
        'upper': digits((high - dice.between(0.02, 0.1) * (high - low)) / rig.length),
        'stiffness': digits(rig.stiffness * dice.decade(10.0, 100.0)),
    }
    if dice.chance(0.5):
        found['lower'] = digits((low + dice.between(0.02, 0.1) * (high - low)) / rig.length)
        found['lower_stiffness'] = found['stiffness']
    return found


# What is common in rigs is drawn more often.
WEIGHTS: Mapping[Callable[[Dice, Sizes], Given], float] = {
    coulomb_friction: 3.0,
    hysteresis: 3.0,
    pressure_lag: 3.0,
    payload: 3.0,
    creep: 2.0,
    dead_time: 2.0,
    viscous_friction: 1.0,
    pressure_hysteresis: 1.0,
    pressure_offset: 1.0,
    pressure_dependent_damping: 1.0,
    periodic_disturbance: 1.0,
    length_offset: 1.0,
    dead_band: 1.0,
    softening: 1.0,
    supply: 1.0,
    leak: 1.0,
    slack: 1.0,
    end_stop: 1.0,
}
# Descriptions of the same thing, which would be added to each other.
ALIKE = (
    {'leak', 'pressure_lag'},  # a leak has a lag of its own
    {'dead_band', 'pressure_offset'},
    {'hysteresis', 'pressure_hysteresis'},
    {'viscous_friction', 'pressure_dependent_damping'},
)
FED_BACK = {effect.name for effect in EFFECTS if effect.compensation is Compensation.FEEDBACK}


def draw_effects(dice: Dice, rig: Sizes, without: set[str]) -> dict[str, Given]:
    """Return up to three effects that can be together, by name, without those named."""
    found: dict[str, Given] = {}
    count = dice.one_of(COUNTS)
    for draw in dice.some_of(WEIGHTS, len(WEIGHTS)):
        name = draw.__name__
        is_alike = any(name in pair and pair & found.keys() for pair in ALIKE)
        is_idle = name == 'slack' and not rig.is_revolute  # gravity keeps these muscles taut
        if len(found) < count and name not in without and not (is_alike or is_idle):
            found[name] = draw(dice, rig)
    return found


def draw_declared(dice: Dice, effects: Mapping[str, Given]) -> str:
    """Return the name of the effect that is declared, '' if none is.

    Effects that no controller of this package can use are never declared.
    """
    known = [name for name in effects if name not in FED_BACK]
    is_declared = dice.chance(DECLARED)
    return dice.one_of(dict.fromkeys(known, 1.0)) if known and is_declared else ''

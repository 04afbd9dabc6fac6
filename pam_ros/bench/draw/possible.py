# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Initial pressures and references with which all that a drawn scenario demands is possible."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from pam_ros.bench.draw import reference as references
from pam_ros.bench.draw.capability import Capability
from pam_ros.bench.draw.dice import Dice, digits
from pam_ros.bench.draw.reference import Motion, Room
from pam_ros.bench.references import Reference, reference_of
from pam_ros.bench.scenario import Change, Scenario
from pam_ros.errors import PamError
from pam_ros.rig import statics
from pam_ros.rig.equilibrium import rest_position
from pam_ros.rig.joint import Joint
from pam_ros.settings.files import flattened

AT_REST, MOVING = 0.1, 0.05  # share of the range of pressure left at both ends
LEAST_REACH = 0.08  # contraction that corresponds to the reach
EDGE = 0.04  # share of the reach that references leave at both ends
START = 0.2  # least share of the reach on both sides of the start
MEAN, DIFFERENCE = (0.12, 0.6), (-0.24, 0.24)  # initial pressures, as shares of the highest
TRIES = 8
PERIOD = 0.004  # s between tested points of a motion
HOLD = reference_of({'kind': 'hold'}, 'reference')


class ImpossibleError(PamError):
    """What was drawn cannot be done: it is drawn again."""


def joints_of(
    declared: Mapping[str, Any],
    undeclared: Mapping[str, Any] | None = None,
    changes: Sequence[Mapping[str, Any]] = (),
) -> list[Joint]:
    """Return the joint of a scenario with these keys, from the start on and after each change.

    Raises PamError if it is not valid.
    """
    events = tuple(
        Change(one['time'], {name: one[name] for name in one if name != 'time'}) for one in changes
    )
    known, hidden = (dict(flattened(given)) for given in (declared, undeclared or {}))
    scenario = Scenario('', '', known, hidden, HOLD, 1.0, events)
    return [setup.joints[0] for _, setup in scenario.setups(0, 'lockstep')]


def common_reach(*joints: Joint) -> tuple[float, float]:
    """Return the range in which each of *joints* can hold its load.

    Raises ImpossibleError if it is small.
    """
    found = [Capability(joint, AT_REST).reach() for joint in joints]
    low = max(np.inf if one is None else one[0] for one in found)
    high = min(-np.inf if one is None else one[1] for one in found)
    arm = float(np.mean(np.abs(statics.middle_arms(joints[0]))))
    if high - low < LEAST_REACH * joints[0].muscles[0].l0 / arm:
        raise ImpossibleError('the reach is too small')
    return float(low), float(high)


def draw_start(
    dice: Dice, joint: Joint, reach: tuple[float, float]
) -> tuple[tuple[float, ...], float]:
    """Return initial pressures in Pa, one a muscle, and the position at which they rest.

    It is in the middle part of the *reach*, and all muscles pull there: with low pressures the
    force law could hold a pair in place by pushing. Raises ImpossibleError if none is found.
    """
    low, high = reach
    spare = START * (high - low)
    highest = joint.muscles[0].p_max
    for _ in range(TRIES):
        mean, half = dice.between(*MEAN), 0.5 * dice.between(*DIFFERENCE)
        halves = (half, -half) if joint.is_revolute else (0.0, 0.0)
        pressures = tuple(
            digits(highest * max(mean + one, 0.0)) for one in halves[: len(joint.muscles)]
        )
        start = rest_position(joint.at_start, pressures)
        if low + spare <= start <= high - spare and _all_pull(joint, pressures, start):
            return pressures, start
    raise ImpossibleError('no initial pressure was found')


def _all_pull(joint: Joint, pressures: Sequence[float], s: float) -> bool:
    return all(
        float(muscle.force(p, statics.contraction(joint, i, s))) > 0.0
        for i, (muscle, p) in enumerate(zip(joint.muscles, pressures, strict=True))
    )


def draw_motion(
    dice: Dice,
    kind: str,
    joints: Sequence[Joint],
    reach: tuple[float, float],
    start: tuple[Sequence[float], float],
) -> Motion:
    """Return a motion of a *kind* within *reach*, which all *joints* can follow.

    *start* are the pressures and the position at the start. Raises ImpossibleError if none is
    found.
    """
    draw = next(one for one in references.KINDS if one.__name__ == kind)
    pressures, position = start
    edge = EDGE * (reach[1] - reach[0])
    room = Room(reach[0] + edge - position, reach[1] - edge - position)
    for _ in range(TRIES):
        motion = draw(dice, room)
        wanted = reference_of({'kind': kind, **motion.content}, 'reference')
        if kind in references.JUMPS or all(
            _is_followed(wanted, motion.end, joint, pressures, position) for joint in joints
        ):
            return motion
    raise ImpossibleError('no motion was found')


def _is_followed(
    wanted: Reference, end: float, joint: Joint, pressures: Sequence[float], position: float
) -> bool:
    """Return whether the muscles can follow the reference *wanted* from its *position* on."""
    s = position + wanted.at(np.arange(0.0, end, PERIOD))
    return Capability(joint, MOVING).follows(s, PERIOD, pressures)

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a rig that are drawn, and the meaning of the numbers in their messages.

Messages may come from ROS or from a library that reads bags: their fields have the same names.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

from pam_ros.recording.bag.topics import (
    FLOAT64,
    FLOAT64_ARRAY,
    FLUID_PRESSURE,
    JOINT_STATE,
)
from pam_ros.recording.quantities import ATMOSPHERE

MOST_COLUMNS = 32  # of one message that are drawn: more cannot be distinguished
REFERENCE = 'reference'  # the term of the controller's state that is drawn


class Use(NamedTuple):
    """How a topic is drawn.

    ``panel`` is the plot of its numbers. They are set-points (``is_set_point``) or measured.
    ``offset`` is added to a number: pressures are drawn as gauge pressures.
    """

    kind: str
    panel: str
    is_set_point: bool = False
    offset: float = 0.0


TOPICS = {
    'position_reference': Use(FLOAT64, 'position', is_set_point=True),
    'pam_control/state': Use(JOINT_STATE, 'position', is_set_point=True),
    'joint_states': Use(JOINT_STATE, 'position'),
    'pressure_command': Use(FLOAT64, 'pressure', is_set_point=True),
    'pressure_commands': Use(FLOAT64_ARRAY, 'pressure', is_set_point=True),
    'pressure': Use(FLUID_PRESSURE, 'pressure', offset=-ATMOSPHERE),
    'pressures': Use(FLOAT64_ARRAY, 'pressure', offset=-ATMOSPHERE),
    'force': Use(FLOAT64, 'force'),
    'forces': Use(FLOAT64_ARRAY, 'force'),
    'stiffness': Use(FLOAT64, 'stiffness'),
    'stiffnesses': Use(FLOAT64_ARRAY, 'stiffness'),
    'damping': Use(FLOAT64, 'damping'),
    'dampings': Use(FLOAT64_ARRAY, 'damping'),
}


class Key(NamedTuple):
    """One curve: its plot, its topic, and its joint or muscle.

    ``column`` is the name of the joint, or the index of a muscle in an array (``0``, ``1`` ...),
    or empty if a message has one number.
    """

    panel: str
    topic: str
    column: str = ''


def numbers(topic: str, message: Any) -> list[tuple[Key, float]]:
    """Return the numbers of a *message* of a topic of the rig, by the curve that they belong to.

    SI units; pressures are gauge. A JointState without efforts gives only positions.
    """
    use = TOPICS[topic]
    if use.kind == FLOAT64:
        return [(Key(use.panel, topic), float(message.data) + use.offset)]
    if use.kind == FLUID_PRESSURE:
        return [(Key(use.panel, topic), float(message.fluid_pressure) + use.offset)]
    if use.kind == FLOAT64_ARRAY:
        columns = [float(value) + use.offset for value in message.data[:MOST_COLUMNS]]
        return [(Key(use.panel, topic, str(i)), value) for i, value in enumerate(columns)]
    if use.is_set_point:
        return [
            (Key(use.panel, topic), float(value))
            for name, value in zip(message.name, message.position, strict=False)
            if name == REFERENCE
        ]
    names = message.name[:MOST_COLUMNS]
    found = []
    for panel, values in (('position', message.position), ('effort', message.effort)):
        for name, value in zip(names, values, strict=False):
            found.append((Key(panel, topic, str(name)), float(value)))
    return found


def muscles_of(topic: str, message: Any) -> tuple[str, ...]:
    """Return the names of the muscles in the label of an array; empty if it has none."""
    if TOPICS[topic].kind != FLOAT64_ARRAY:
        return ()
    labels: Sequence[str] = [dimension.label for dimension in message.layout.dim]
    names = tuple(name.strip() for name in labels[0].split(',')) if labels else ()
    return names if len(names) == len(message.data) and all(names) else ()

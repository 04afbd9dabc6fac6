# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The names of the columns of a CSV file in which lines of a plot are saved."""

import re

from pam_ros.plot.topics import Key

# Topics of several muscles by the quantity of one of them; others have the name of their topic.
_OF_MUSCLES = {
    'pressure_commands': 'pressure_command',
    'pressures': 'pressure',
    'forces': 'force',
    'stiffnesses': 'stiffness',
    'dampings': 'damping',
}


def column_name(key: Key, muscles: tuple[str, ...], joints: int = 1) -> str:
    """Return the name of the column of a curve, without its unit.

    With a unit, such as ``position_mm`` and ``flexor.pressure_kPa``, it is what
    :func:`pam_ros.recording.quantities.target_of` reads, for the quantities that it knows. If
    there are several *joints*, it is preceded by that of the joint, for example ``knee.position``.
    """
    if key.topic == 'pam_control/state':
        return 'reference'
    if key.topic == 'joint_states':
        return f'{word(key.column)}.{key.panel}' if joints > 1 else key.panel
    if not key.column:
        return key.topic
    number = int(key.column)
    muscle = muscles[number] if number < len(muscles) else f'muscle_{number + 1}'
    return f'{word(muscle)}.{_OF_MUSCLES[key.topic]}'


def word(name: str) -> str:
    """Return a name of letters, digits and underscores that begins with a letter."""
    word = re.sub(r'\W+', '_', name, flags=re.ASCII).strip('_')
    return word if word[:1].isalpha() else f'n{word}'

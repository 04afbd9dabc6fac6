# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Names that parameters had in former versions: files that have them still load.

Version 0.1.0 described the thresholds of Maxwell slip by how they crowd near 0.
"""

from collections.abc import Mapping
from typing import Any

from pam_ros.arguments import refuse

# By the ends of their names: a muscle's own have its name in front.
CROWDING = {
    f'effects.hysteresis.{part}_crowding': f'effects.hysteresis.{part}_ratio'
    for part in ('slip', 'pressure')
}
MOST_CROWDING = 0.98


def renamed(values: Mapping[str, Any]) -> tuple[dict[str, Any], str]:
    """Return flat *values* under the names of today, and a sentence; '' where all are today's.

    A name of today is taken before a former one. Names of one muscle, with its name before a dot,
    are treated as common ones are. Raises ParameterError for a former value out of range.
    """
    found: dict[str, Any] = {}
    changes = []
    for name, value in values.items():
        new = _of_today(name)
        if new == name:
            found[name] = value
            continue
        ratio = _ratio(name, value)
        changes.append(f'{name} is {new} = {ratio:g}')
        if new not in values:
            found[new] = ratio
    return found, f'former names of parameters: {", ".join(changes)}' if changes else ''


def _of_today(name: str) -> str:
    for former, now in CROWDING.items():
        if name == former or name.endswith(f'.{former}'):
            return name.removesuffix(former) + now
    return name


def _ratio(name: str, crowding: Any) -> float:
    """Return the ratio whose thresholds are nearest to (1 - c) s / (1 - c s), with c *crowding*.

    The gaps at both ends have the same ratio, and the threshold in the middle is the same.
    """
    try:
        c = float(crowding)
    except (TypeError, ValueError):
        c = -1.0
    if not 0.0 <= c <= MOST_CROWDING:
        refuse(name, crowding, f'0 to {MOST_CROWDING}')
    return 1.0 / (1.0 - c) ** 2

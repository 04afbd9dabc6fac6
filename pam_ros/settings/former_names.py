# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Names that parameters had in former versions: files that have them still load.

Version 0.1.0 had the hysteresis over pressure in the effect ``hysteresis``, and described the
thresholds of Maxwell slip by how they crowd near 0. Some of its parameters are constants now.
"""

from collections.abc import Mapping
from typing import Any

from pam_ros.arguments import refuse
from pam_ros.effects.leak import REOPENING
from pam_ros.effects.names import GROUP, EffectName, parsed

FORMER, NOW = 'hysteresis', 'pressure_hysteresis'
MOVED = {
    'pressure': 'slip',
    'pressure_width': 'slip_width',
    'pressure_onset': 'slip_onset',
    'pressure_crowding': 'slip_ratio',
    'pressure_ratio': 'slip_ratio',
}
SHARED = ('initial', 'onset')  # parameters that both parts have
CROWDING = {'slip_crowding': 'slip_ratio', 'pressure_crowding': 'slip_ratio'}
MOST_CROWDING = 0.98
# Parameters that no recording of a real rig asks for, and what they always are now.
CONSTANT = {
    EffectName('leak', 'lost'): 0.0,
    EffectName('leak', 'reopening'): REOPENING,
    EffectName('hysteresis', 'unloading'): 1.0,
    EffectName('hysteresis', 'pressure_growth'): 0.0,
}


def renamed(values: Mapping[str, Any]) -> tuple[dict[str, Any], str]:
    """Return flat *values* with their present names, and a sentence on former ones, '' if none.

    The value of a present name is used before that of a former one. Names of one muscle, with its
    name before a dot, are treated as common ones are. A parameter that is a constant now is left
    out, and the sentence names a value that differs from it. Raises ParameterError for a former
    value out of range.
    """
    found: dict[str, Any] = {}
    changes = []
    is_split = False
    for name, value in values.items():
        constant = _constant(name)
        if constant is not None:
            if value != constant:
                changes.append(f'{name} = {value} is ignored: it is always {constant:g}')
            continue
        new, now = _at_present(name, value)
        if new == name:
            found[name] = value
            continue
        is_split |= f'{GROUP}.{NOW}.' in new
        if new in values:
            changes.append(f'{name} is ignored, since {new} is given')
            continue
        found[new] = now
        changes.append(f'{name} is {new}' + ('' if now == value else f' = {now:g}'))
    for name, value in values.items() if is_split else ():
        of = _split(name)
        if of is not None and of[1].effect == FORMER and of[1].parameter in SHARED:
            found.setdefault(of[0] + EffectName(NOW, of[1].parameter).flat, value)
    return found, f'former names of parameters: {", ".join(changes)}' if changes else ''


def _split(name: str) -> tuple[str, EffectName] | None:
    """Return the muscle of a flat name with its dot, '' without one, and the effect's own name."""
    head, dot, rest = ('', '', name) if name.startswith(f'{GROUP}.') else name.partition('.')
    own = parsed(rest)
    return None if own is None else (head + dot, own)


def _constant(name: str) -> float | None:
    """Return what a former parameter always is now, None if it is no such parameter."""
    of = _split(name)
    return None if of is None else CONSTANT.get(of[1])


def _at_present(name: str, value: Any) -> tuple[str, Any]:
    """Return the present name and value of a parameter of any version."""
    of = _split(name)
    if of is None or of[1].effect != FORMER:
        return name, value
    muscle, (_, parameter) = of
    if parameter in CROWDING:
        value = _ratio(name, value)
    if parameter in MOVED:
        return muscle + EffectName(NOW, MOVED[parameter]).flat, value
    return muscle + EffectName(FORMER, CROWDING.get(parameter, parameter)).flat, value


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

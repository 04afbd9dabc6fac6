# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A report on what a controller has learned from the motion, and how much it uses this."""

from typing import Any

from pam_ros.control.learned import Learned
from pam_ros.health.health import Health, Level

# Multiple of its noise; with a smaller RMS of the missing force nothing has to be learned.
LITTLE = 2.0
USED = 0.5  # weight above which what was learned counts as used


def learning(learned: Learned | None, unit: str) -> Health:
    """Return what was *learned*, None if the law does not learn.

    *unit* is that of the coordinate, m or rad. It is never a warning: control continues without
    what was learned.
    """
    if learned is None:
        return Health(Level.OK, 'the law does not learn', {})
    effort, stiffness = ('N', 'N/m') if unit == 'm' else ('N m', 'N m/rad')
    values: dict[str, Any] = {
        'weight': learned.weight,
        'time of motion (s)': learned.motion,
        f'missing force, RMS ({effort})': learned.missing,
        'explained share of it': learned.explained,
        f'friction and hysteresis ({effort})': learned.friction,
        f'additional friction at rest ({effort})': learned.breakaway,
        f'additional stiffness ({stiffness})': learned.stiffness,
        'lag while filling (s)': None if learned.lag is None else learned.lag[0],
        'lag while venting (s)': None if learned.lag is None else learned.lag[1],
        'restarts': learned.restarts,
    }
    return Health(Level.OK, '; '.join(_sentences(learned)), values)


def _sentences(learned: Learned) -> list[str]:
    found = []
    if learned.restarts:
        times = 'once' if learned.restarts == 1 else f'{learned.restarts} times'
        found.append(f'everything learned was forgotten {times}: the loop oscillated')
    if learned.motion == 0.0:
        since = 'since then' if learned.restarts else 'yet'
        found.append(f'has learned nothing: the load has not moved {since}')
    elif learned.weight > USED:
        found.append('compensates what was learned')
    elif learned.missing < LITTLE * learned.noise:
        found.append('the nominal model lacks no force that changes with the motion')
    else:
        found.append(
            f'what was learned explains {100.0 * learned.explained:.0f} % of the missing force: '
            f'it is used with a weight of {learned.weight:.2f}'
        )
    if learned.dropped_lag is not None:
        fill, vent = learned.dropped_lag
        found.append(
            f'a learned lag of {1e3 * fill:.3g} ms (filling) and {1e3 * vent:.3g} ms (venting) is '
            'not used any more: the motion is predicted better without it'
        )
    return found

# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The health that ``pam_sim`` publishes on ``/diagnostics``."""

import math
from collections.abc import Sequence
from itertools import compress
from typing import NamedTuple

from pam_ros.health.health import Health, Level
from pam_ros.settings.scene import SimulationSetup
from pam_ros.settings.sim import SimSettings
from pam_ros.simulator.contractions import Excess
from pam_ros.simulator.plant import Plant
from pam_ros.timing.ticker import Punctuality

NO_CLOCK = 'waits for /clock (use_sim_time is set)'


def commands(plant: Plant, last: int) -> Health:
    """Return the health of the commands; *last* is the muscle with the latest invalid one."""
    inputs = plant.inputs
    commanded = [last for last in plant.commanded_at if not math.isnan(last)]
    age = plant.time - min(commanded) if commanded else None
    values = {
        'command age (s)': age,
        'last command (Pa)': inputs[0].last if len(inputs) == 1 else None,
        'accepted': sum(given.accepted for given in inputs),
        'clamped': sum(given.clamped for given in inputs),
        'refused': sum(given.refused for given in inputs),
        'last reason': inputs[last].reason,
    }
    if len(inputs) > 1:
        del values['last command (Pa)']
        values['muscles commanded'] = len(commanded)
    if age is None:
        return Health(Level.OK, 'no command yet', values)
    if any(plant.has_timed_out):
        did = {'vent': 'vented', 'hold': 'held'}[plant.setup.settings.on_timeout]
        whose = ''
        if len(inputs) > 1:
            late = list(compress(plant.setup.muscle_names, plant.has_timed_out))
            whose = f' for {", ".join(late[:5])}' + (' and others' if len(late) > 5 else '')
        return Health(Level.WARN, f'no command{whose} for {age:.3g} s: {did}', values)
    if low := plant.low_commands:
        return Health(Level.WARN, low, values)
    return Health(Level.OK, 'commanded', values)


def contraction(plant: Plant, found: Sequence[Excess]) -> Health:
    """Return the health of the contractions; *found* are those beyond ``kappa_max``."""
    setup = plant.setup
    worst = max(found, key=lambda one: one.largest - setup.rated[one.muscle], default=None)
    values = {
        'times beyond kappa_max': plant.contractions.count,
        'muscles beyond kappa_max': len(found),
        'largest contraction beyond kappa_max': worst.largest if worst else None,
    }
    if worst is None:
        return Health(Level.OK, 'within kappa_max', values)
    others = f' (and {len(found) - 1} more muscles beyond theirs)' if len(found) > 1 else ''
    return Health(Level.WARN, sentence_of(setup, worst) + others, values)


def sentence_of(setup: SimulationSetup, excess: Excess) -> str:
    """Return the warning on a muscle that contracts beyond ``kappa_max``."""
    name, limit = setup.muscle_names[excess.muscle], setup.rated[excess.muscle]
    return (
        f'muscle {name} contracts by {100.0 * excess.largest:.1f} % of its length, more than the '
        f'{100.0 * limit:.1f} % that it permits (kappa_max): a real muscle must not be used '
        'there, and the model is extrapolated'
    )


class RunProgress(NamedTuple):
    """The progress of a simulation since the last report, and what delays it."""

    published: int  # samples
    speed: float  # desired simulated seconds per second; 0: as many as possible
    time: float  # simulated s since the start or the last reset
    lost: float  # simulated s of delay that are not caught up
    jumps: int  # of the clock that it follows
    is_paused: bool
    follows_clock: bool
    has_clock: bool  # False if it follows a clock that has not been received
    waits: str  # sentence on a long wait in lockstep
    fault: str


def timing(settings: SimSettings, kept: Punctuality, done: RunProgress, scheduling: str) -> Health:
    """Return the health of the rate; *scheduling* is how the loop is scheduled."""
    rate = done.published / kept.span
    wanted = settings.publish_rate * done.speed
    values = {
        'publish rate (Hz)': rate,
        'wanted publish rate (Hz)': wanted,
        'overruns': kept.overruns,
        'worst lateness (s)': kept.worst,
        'simulated time (s)': done.time,
        'simulated time lost (s)': done.lost,
        'clock jumps': done.jumps,
        'paused': done.is_paused,
        'time mode': settings.time_mode,
        'scheduling': scheduling,
    }
    if settings.has_own_time:
        values['speed (simulated s / s)'] = rate / settings.publish_rate
    if done.fault:
        return Health(Level.ERROR, done.fault, values)
    if not done.has_clock:
        return Health(Level.WARN, NO_CLOCK, values)
    if done.is_paused:
        return Health(Level.OK, 'paused', values)
    if settings.time_mode == 'lockstep':
        return Health(Level.WARN if done.waits else Level.OK, done.waits or 'in lockstep', values)
    if rate < 0.95 * wanted and not done.follows_clock:
        return Health(Level.WARN, f'publishes at {rate:.1f} Hz instead of {wanted:g}', values)
    return Health(Level.OK, 'keeps its rate' if wanted else 'as fast as possible', values)

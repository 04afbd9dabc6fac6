# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The health that ``pam_control`` publishes on ``/diagnostics``."""

from typing import Any, NamedTuple

from pam_ros.control.compensation import left_to_feedback
from pam_ros.control.loop import BLIND, DISABLED, HOLD, RUNNING, VENT, WAITING, Loop
from pam_ros.control.signals import Pressures
from pam_ros.health.health import Health, Level
from pam_ros.settings.control import ControlSetup
from pam_ros.timing.pace import SECOND
from pam_ros.timing.ticker import Punctuality

MOSTLY = 0.6  # share of the feedback gains below which a loop is clearly slower
OSCILLATED = (
    'the loop oscillated: {:.0%} of the feedback gains are in use. Usual causes are a dead time '
    'or a lag that is not configured, or a vibration from outside'
)


class Received(NamedTuple):
    """The messages that a controller has received, and their faults."""

    age: float | None = None  # s of the newest joint states
    blindness: str = ''  # reason why the last of them was not usable
    refused: int = 0  # references and trajectories
    refusal: str = ''  # reason why the last of them was refused
    is_refusal_new: bool = False  # since the last report
    implausibility: str = ''  # sentence on the last measurement that cannot be true
    is_implausibility_new: bool = False  # since the last report
    pauses: int = 0  # of the commands, longer than longest_interruption of the settings
    pause: str = ''  # sentence on the last of them
    is_pause_new: bool = False  # since the last report
    late: int = 0  # joint states that were not used because they arrived late
    delay: str = ''  # sentence on those since the last report, if they are many
    tracking: str = ''  # sentence on an error or saturation that lasts


def values_of(loop: Loop, setup: ControlSetup, age: float | None) -> dict[str, Any]:
    """Return the state of the loop in numbers; *age* is that of the joint states in s."""
    terms, law, unit = loop.law.terms, loop.law, setup.law.unit
    is_running = loop.state == RUNNING
    values = {
        'state': loop.state,
        'controller': setup.settings.controller,
        f'reference ({unit})': terms.reference if is_running else None,
        f'error ({unit})': terms.error if is_running else None,
        'command (Pa)': shown(loop.pressures),
        'saturated': terms.saturated if is_running else None,
        'on a trajectory': loop.source.is_on_trajectory if is_running else None,
        f'lowest reference ({unit})': setup.law.reach[0],
        f'highest reference ({unit})': setup.law.reach[1],
        'age of joint_states (s)': age,
        'implausible joint_states': loop.implausible,
    }
    if setup.settings.controller == 'sliding_mode':
        gains, inertia = setup.law.gains, setup.law.joint.inertia
        values[f'half width of the boundary layer ({unit}/s)'] = gains.boundary_width(inertia)
        # The surface never has a lower natural frequency than surface_bandwidth.
        values[f'largest error within the disturbance bound ({unit})'] = gains.error_bound(
            gains.disturbance_bound, inertia, gains.surface_bandwidth
        )
        values['rejection level'] = terms.rejection if is_running else None
        values['highest rejection level'] = terms.highest_rejection if is_running else None
        values['share of the feedback gains'] = terms.feedback if is_running else None
    feedback = left_to_feedback(setup.law.joint)
    if feedback:
        values['configured, without feedforward'] = ', '.join(feedback)
    if law.allocation.can_stiffen:
        low, high = law.allocation.stiffness_range(law.terms.reference)
        values |= {
            'co-contraction (N m/rad)': law.terms.co_contraction if is_running else None,
            'lowest co-contraction (N m/rad)': low,
            'highest co-contraction (N m/rad)': high,
        }
    return values


def shown(pressures: Pressures | None) -> float | Pressures | None:
    """Return commands as a number if there is one, as a tuple if there are several."""
    return pressures[0] if pressures is not None and len(pressures) == 1 else pressures


def repeated(stamp: int) -> str:
    """Return a sentence on joint states that all have the same *stamp* in ns."""
    return f'joint_states repeats the stamp {stamp / SECOND:.3f} s: not used'


def late(seconds: float) -> str:
    """Return a sentence on joint states that arrive so many *seconds* late."""
    return f'joint_states arrives {seconds:.2f} s late according to its stamps: not used'


def trouble(loop: Loop, on_timeout: str, blindness: str, fault: str) -> str:
    """Return why *loop* does not control, '' if it does."""
    did = {VENT: 'vents', HOLD: 'holds the pressure'}[on_timeout]
    why = f': {blindness}' if blindness else ''
    missing = 'a measured pressure' if loop.awaits_chamber else 'joint_states'
    return {
        RUNNING: '',
        WAITING: f'waits for {missing}' + why,
        BLIND: f'joint_states has stopped: {did}' + why,
        DISABLED: fault or 'disabled: sends no commands',
    }[loop.state]


def control(loop: Loop, setup: ControlSetup, received: Received, fault: str) -> Health:
    """Return the health of the control; *fault* is the reason why the law was stopped."""
    state = loop.state
    why = trouble(loop, setup.settings.on_timeout, received.blindness, fault)
    values = values_of(loop, setup, received.age)
    values['late joint_states'] = received.late
    values |= {'refused': received.refused, 'last reason': received.refusal}
    values |= {'starts after a silence': received.pauses, 'last silence': received.pause}
    is_blind = state == BLIND or (state == WAITING and bool(received.blindness))
    if is_blind or fault:
        return Health(Level.ERROR, why, values)
    for is_new, what in (
        (received.is_pause_new, received.pause),
        (received.is_refusal_new, received.refusal),
        (received.is_implausibility_new, received.implausibility),
    ):
        if is_new:
            return Health(Level.WARN, what, values)
    if state == WAITING:
        return Health(Level.WARN, why, values)
    if state == RUNNING:
        share = loop.law.terms.feedback
        oscillated = OSCILLATED.format(share) if share < MOSTLY else ''
        lasts = received.blindness or received.tracking or oscillated or received.delay
        if lasts:
            return Health(Level.WARN, lasts, values)
    return Health(Level.OK, why or 'controlling', values)


def timing(kept: Punctuality, commanded: int, wanted: float | None) -> Health:
    """Return the health of the rate; *wanted* in Hz is None if joint states set the pace."""
    values = {
        'command rate (Hz)': commanded / kept.span,
        'wanted rate (Hz)': wanted,
        'overruns': kept.overruns,
        'worst lateness (s)': kept.worst,
    }
    if wanted is None:
        return Health(Level.OK, 'answers each joint state (use_sim_time is set)', values)
    if kept.rate < 0.95 * wanted:
        return Health(Level.WARN, f'runs at {kept.rate:.1f} Hz instead of {wanted:g}', values)
    return Health(Level.OK, 'keeps its rate', values)

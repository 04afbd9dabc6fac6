# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the parameters of a node say about its muscles, and whether pressures suit them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pam_ros.command.amounts import Amount
from pam_ros.errors import PamError
from pam_ros.recording.quantities import QUANTITIES
from pam_ros.settings.rig import KINDS, RigParameters

NEEDED = ('p_min', 'p_max', 'command_timeout', 'joint')  # parameters of a rig as pam_sim has them
NAMES = ('joint', 'joint_name', 'joint_names', 'muscles')  # parameters that name the muscles
VACUUM = -101325.0  # Pa, the lowest gauge pressure
USUAL_HIGHEST = 500e3  # Pa: of most muscles, if the rig does not tell its own limits
# Share of the highest pressure below which a number without a unit is assumed to be in another
# unit: those of kPa, bar and psi are below it for all muscles up to 5 MPa.
LEAST_SHARE = 1.0 / 500.0
SLOWEST, FASTEST = 0.1, 1e-3  # s between repeated commands
COMMANDS = 5  # in the time-out of a rig, so that a late one does not let it vent


@dataclass(frozen=True)
class Rig:
    """The node that receives the pressures: its name, and what is known from its parameters.

    ``limits`` (Pa) has the lowest and highest pressure of each of the ``muscles``. Without a
    command it vents after ``timeout`` s; 0: never. Its time runs ``speed`` times as fast as wall
    time, 0 if that is not known. In lockstep each command simulates ``period`` s.
    """

    node: str
    muscles: tuple[str, ...]
    limits: tuple[tuple[float, float], ...]
    timeout: float
    speed: float
    period: float | None

    @property
    def repeat(self) -> float | None:
        """Time in s between commands that keep a pressure; None if one command is sufficient."""
        if self.period is not None:
            return max(self.period, FASTEST)
        if not self.timeout:
            return None
        wall = self.timeout / self.speed if self.speed else 0.0
        return min(max(wall / COMMANDS, FASTEST), SLOWEST)


def rig_of(node: str, values: Mapping[str, Any]) -> Rig | None:
    """Return the rig that the parameters *values* of *node* describe, None if it is none."""
    if not all(name in values for name in NEEDED):
        return None
    muscles = RigParameters({name: values[name] for name in NAMES if name in values}).muscles
    limits = tuple(
        (_own(values, muscle, 'p_min'), _own(values, muscle, 'p_max')) for muscle in muscles
    )
    mode = values.get('time_mode', 'real_time')
    speed = float(values.get('speed_factor', 1.0)) if mode == 'scaled' else 1.0
    period = 1.0 / float(values['publish_rate']) if mode == 'lockstep' else None
    return Rig(node, muscles, limits, float(values['command_timeout']), speed, period)


def _own(values: Mapping[str, Any], muscle: str, name: str) -> float:
    return float(values.get(f'{muscle}.{name}', values[name]))


def unit_of(values: Mapping[str, Any]) -> str:
    """Return the unit of the positions of a controller with these parameters, '' if unknown."""
    kind = KINDS.get(str(values.get('joint')))
    return '' if kind is None else kind.transmission.equations.unit


def ordered(pressures: Sequence[tuple[str, Amount]], rig: Rig | None) -> list[float]:
    """Return *pressures* in Pa in the order of the muscles of an array, checked.

    Without a *rig*, the muscles must not be named. Raises PamError if the muscles are not those
    of the rig, or if a value does not suit its muscle.
    """
    named = dict(pressures)
    if rig is None:
        if '' not in named:
            raise PamError(
                'the order of the muscles is not known, because no node with the parameters of '
                'pam_sim receives the pressures: give the values in order, without names'
            )
        return [checked_pressure('', amount, None) for _, amount in pressures]
    if '' not in named:
        if set(named) != set(rig.muscles):
            raise PamError(
                f'pressures of {", ".join(named)} are given, and one message has those of all '
                f'muscles of {rig.node}: give {", ".join(rig.muscles)}, or start it with '
                'muscle_topics'
            )
        pressures = [(muscle, named[muscle]) for muscle in rig.muscles]
    if len(pressures) != len(rig.muscles):
        raise PamError(
            f'{count(len(pressures), "pressure")} for {count(len(rig.muscles), "muscle")} of '
            f'{rig.node}: give one for each of {", ".join(rig.muscles)}'
        )
    return [
        checked_pressure(muscle, amount, rig)
        for muscle, (_, amount) in zip(rig.muscles, pressures, strict=True)
    ]


def checked_pressure(muscle: str, amount: Amount, rig: Rig | None) -> float:
    """Return *amount* in Pa; raises PamError if it is out of range or plainly in another unit.

    A number with a unit is only held to the limits of the *muscle*. Without a rig these are the
    largest plausible pressures.
    """
    value, highest = amount.value, QUANTITIES['pressure_command'].limit
    low, high, whose, usual = VACUUM, highest, 'a pressure command', USUAL_HIGHEST
    if rig is not None:
        low, high = rig.limits[rig.muscles.index(muscle)]
        whose, usual = f'{rig.node} ({muscle})' if len(rig.muscles) > 1 else rig.node, high
    if not low <= value <= high:
        raise PamError(
            f'{_spelled(amount, "Pa")} is out of range: {whose} permits {low:g} to {high:g} Pa'
        )
    if not amount.unit and 0.0 < abs(value) < usual * LEAST_SHARE:
        raise PamError(
            f'{amount.text} without a unit is {value:g} Pa, which is less than '
            f'{LEAST_SHARE:.1%} of the highest pressure ({usual:g} Pa): give the unit, as in '
            f'{amount.text}kPa, {amount.text}bar or {amount.text}Pa'
        )
    return value


def checked_position(amount: Amount, unit: str, node: str) -> float:
    """Return *amount* in m or rad, for a controller *node* whose positions are in *unit*.

    If *unit* is '' it is not known. Raises PamError for a value in the other unit, and, if the
    unit is not known, for one beyond the largest plausible position. A controller with a unit
    refuses what is out of its reach itself.
    """
    if unit and amount.unit not in ('', unit):
        kind = 'a length' if unit == 'm' else 'an angle'
        raise PamError(f'{amount.text} is in {amount.unit}, but the position of {node} is {kind}')
    limit = QUANTITIES['angle' if amount.unit == 'rad' else 'position'].limit
    if not unit and abs(amount.value) > limit:
        raise PamError(
            f'{_spelled(amount, "m or rad")} is not a plausible position: give at most '
            f'{limit:.4g} {amount.unit or "m or rad"}'
        )
    return amount.value


def _spelled(amount: Amount, unit: str) -> str:
    if amount.unit:
        return f'{amount.text} ({amount.value:g} {amount.unit})'
    return f'{amount.text} (without a unit: {unit})'


def count(number: int, what: str) -> str:
    """Return a number with its noun: 1 muscle, 2 muscles."""
    return f'{number} {what}{"" if number == 1 else "s"}'

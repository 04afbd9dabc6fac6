# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Another unit or sign of a signal, mass or muscle with which the nominal model is right.

If a pressure in psi is read as one in kPa, a fit still follows the motion: with constants that no
muscle has, and with effects that the rig does not have. But the nominal model does not follow it
at all, and with the right unit it does. So the nominal model, which is simulated without any fit,
is compared for all usual mistakes, whose factors are so large (at least 2.5) that no effect of the
library is mistaken for one of them.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np

from pam_ros.errors import PamError
from pam_ros.identification.data.checked import checked
from pam_ros.identification.search.doubt import Doubt
from pam_ros.identification.search.setting import Setting, rms
from pam_ros.muscle.constants import CONSTANTS
from pam_ros.muscle.muscle import Muscle
from pam_ros.recording.recording import Recording
from pam_ros.rig import statics
from pam_ros.rig.joint import Joint

# Error of the nominal model, in standard deviations of the signal, above which the data are
# doubted: a constant has 1. With psi read as kPa, rigs of two muscles had 0.52 to 0.8.
DOUBTED = 0.4
# Share of that error, and error, that another reading may leave. In 190 rigs with a missing
# effect that were read as they are, every other reading left more than 0.6 of it. If the nominal
# constants were those of another muscle, or one of them was off by 20 to 80 %, it left more than
# 0.37 of it, or an error of at least 0.65. The right reading left 0.001 to 0.33 of it, with few
# exceptions.
LEFT, FOLLOWS = 1.0 / 3.0, 0.5
REMEDY = (
    "Correct it, with --column 'NAME=TARGET*SCALE+OFFSET' for a signal, and identify again. If "
    'the recording is right, the nominal model is of another rig: state how uncertain its '
    'constants are, --uncertain a5=50%, and so on for a1 to a6.'
)
ALIKE = 1.5  # times the least error that the readings that are named with it have at most

# Factors by which a signal is too small, and how this can happen: as <unit> that is read as <unit>
PRESSURE = {
    6.894757: ('psi', 'kPa'),
    14.50377: ('bar', 'psi'),
    7.500617: ('kPa', 'mmHg'),
    10.0: ('MPa', 'bar'),
    100.0: ('bar', 'kPa'),
}
LENGTH = {
    2.54: ('inch', 'cm'),
    25.4: ('inch', 'mm'),
    10.0: ('cm', 'mm'),
    100.0: ('m', 'cm'),
    1000.0: ('m', 'mm'),
}
ANGLE = {
    180.0 / pi: ('rad', 'deg'),
    2.0 * pi: ('turns', 'rad'),
    360.0: ('turns', 'deg'),
}
FORCE = {
    4.448222: ('lbf', 'N'),
    9.80665: ('kgf', 'N'),
    10.0: ('daN', 'N'),
    1000.0: ('kN', 'N'),
    101.9716: ('N', 'gf'),
}
MASS = {9.80665: ('kg', 'N'), 1000.0: ('kg', 'g')}


@dataclass(frozen=True)
class Reading:
    """Another meaning of the numbers of recordings, or of the nominal mass.

    ``text`` is a clause that says what would be different.
    """

    text: str
    of_recording: Callable[[Recording], Recording] = lambda recording: recording
    of_joint: Callable[[Joint], Joint] = lambda joint: joint


def likely_mistake(
    setting: Setting,
    recordings: Sequence[Recording],
    setting_of: Callable[[Joint, Sequence[Recording]], Setting],
    muscles: Mapping[str, Muscle],
) -> Doubt | None:
    """Return the doubt if *recordings* show a mistake in a unit or a sign, None if not.

    *setting* is the setting of their identification, and setting_of(joint, recordings) makes one
    of others. The nominal muscle may also have been confused with one of *muscles*, by name. If
    constants were stated as uncertain, the error of the nominal model shows nothing.
    """
    if any(name.rpartition('.')[2] in CONSTANTS for name in setting.uncertain):
        return None
    before = _nominal_error(setting)
    if before < DOUBTED:
        return None
    found: list[tuple[float, str]] = []
    joint, first = setting.joint, recordings[0]
    for reading in (*_readings(joint, first), *_with_muscles(joint, muscles)):
        try:
            rig = reading.of_joint(joint)
            other = [checked(reading.of_recording(one), rig) for one in recordings]
            found.append((_nominal_error(setting_of(rig, other)), reading.text))
        except PamError:
            continue  # with this reading the recordings are not those of this joint at all
    least = min(found, default=(np.inf, ''))[0]
    if least > min(LEFT * before, FOLLOWS):
        return None
    texts = ', or '.join(text for error, text in sorted(found) if error <= ALIKE * least)
    return Doubt(
        f'the nominal model does not follow the recording (its error is {before:.2g} standard '
        f'deviations of the {setting.parts[0].segment.quantity}), but it does (then '
        f'{least:.2g}) if {texts}',
        REMEDY,
    )


def _nominal_error(setting: Setting) -> float:
    """Return the RMSE of the nominal model in standard deviations of the target."""
    problem = setting.problem
    error = rms(problem.residuals(np.zeros(len(problem.unknowns))))
    target = np.concatenate([s.target[s.fit] for s in problem.segments])
    return error / float(np.std(target))


def _readings(joint: Joint, recording: Recording) -> Iterator[Reading]:
    """Return the other readings of recordings like *recording* of *joint*."""
    is_angle = recording.unit == 'rad'
    units = [('pressure', PRESSURE), ('position', ANGLE if is_angle else LENGTH)]
    if recording.kind == 'held':
        units.append(('force', FORCE))
    for quantity, table in units:
        for factor, right, wrong in _both_ways(table):
            text = (
                f'the {quantity} is {factor:.4g} times as large, as a {quantity} in {right} that '
                f'was read as one in {wrong}'
            )
            yield Reading(text, _scaled(quantity, factor))
    if recording.kind == 'free' and joint.load.mass > 0.0:
        for factor, wrong, right in _both_ways(MASS):
            text = (
                f'the mass is {factor * joint.load.mass:.4g} kg instead of '
                f'{joint.load.mass:.4g} kg, as a number in {right} that was given as {wrong}'
            )
            yield Reading(text, of_joint=_with_mass(factor))
    if recording.kind == 'free':
        text = 'the position has the opposite sign, and increases with the pull of the muscle'
        if is_angle:
            yield Reading('the angle has the opposite sign', _scaled('position', -1.0))
            text = 'the angle has the opposite sign and another zero'
        yield Reading(text, _turned(joint))
    if len(recording.muscles) == 2:
        yield Reading('the two muscles are exchanged', _exchanged)


def _both_ways(table: dict[float, tuple[str, str]]) -> Iterator[tuple[float, str, str]]:
    """Return the factors of *table* with their units, and the inverse ones."""
    for factor, (one, other) in table.items():
        yield factor, one, other
        yield 1.0 / factor, other, one


def _changed(
    recording: Recording, names: Sequence[str], change: Callable[[Any], Any]
) -> Recording:
    """Return *recording* with the signals called *names* changed, and without its warnings."""
    values = {name: getattr(recording, name) for name in names}
    return replace(
        recording,
        warnings=(),
        **{name: change(value) for name, value in values.items() if value is not None},
    )


def _scaled(quantity: str, factor: float) -> Callable[[Recording], Recording]:
    """Return a map to recordings in which a *quantity* is *factor* times as large."""
    names = {'pressure': ('command', 'pressure'), 'position': ('position', 'velocity')}
    return lambda one: _changed(one, names.get(quantity, (quantity,)), lambda x: factor * x)


def _turned(joint: Joint) -> Callable[[Recording], Recording]:
    """Return a map to recordings with the opposite sign of the position, which may have any zero.

    The zero is the one with which the median position is that at rest with the median pressures.
    """

    def turned(recording: Recording) -> Recording:
        drive = recording.drive(1e-3)[1]
        at_rest = statics.equilibrium(joint, np.median(drive, axis=0))
        assert recording.position is not None
        zero = at_rest + float(np.median(recording.position))
        other = _changed(recording, ('position',), lambda y: zero - y)
        return _changed(other, ('velocity',), np.negative)

    return turned


def _exchanged(recording: Recording) -> Recording:
    return _changed(recording, ('command', 'pressure'), lambda values: values[:, ::-1])


def _with_muscles(joint: Joint, muscles: Mapping[str, Muscle]) -> Iterator[Reading]:
    """Return the readings with another muscle, of its own length or of the nominal one."""
    for name, muscle in muscles.items():
        for l0 in dict.fromkeys((muscle.l0, joint.muscles[0].l0)):
            other = replace(muscle, l0=l0)
            yield Reading(f'the muscle is {name} with l0 = {l0:g} m', of_joint=_with_muscle(other))


def _with_muscle(muscle: Muscle) -> Callable[[Joint], Joint]:
    return lambda joint: replace(
        joint, actuators=tuple(replace(one, muscle=muscle) for one in joint.actuators)
    )


def _with_mass(factor: float) -> Callable[[Joint], Joint]:
    return lambda joint: joint.with_load(mass=factor * joint.load.mass)
